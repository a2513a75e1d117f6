// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// What is proved of a design, or of all designs of a box: enclosures that hold, by ball arithmetic, of the
/// model without slip up to its first jump. The equations are those of the solvers, and so is what counts as
/// one lift-off or as rest; how zeros are found, times and heights are not.
#pragma once

#include <limits>
#include <string>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// All numbers from one to another; NaN: not known.
struct Enclosure {
  double low = std::numeric_limits<double>::quiet_NaN();   ///< no number is below
  double high = std::numeric_limits<double>::quiet_NaN();  ///< no number is above

  /// Whether a number is one of them.
  bool holds(double number) const { return low <= number && number <= high; }
};

/// Each parameter from one value to another.
struct DesignBox {
  Design from;  ///< the lower bound of each parameter
  Design to;    ///< the upper bound of each parameter
};

/// What holds of every design of a box.
struct Proof {
  bool proved = false;    ///< all designs have the one outcome below
  std::string open{};     ///< if not: what is too near, in words
  bool all_jump = false;  ///< all designs jump, between the heights below, whether of one outcome or not
  Status status = Status::not_computed;                     ///< of all designs
  std::uint8_t spurious_first_jump = Outcome::no_lift_off;  ///< of all designs, as of Outcome
  long lift_offs = 0;        ///< up to the jump, which is included; -1: the number differs between designs
  Enclosure height{};        ///< of the jump [hoop diameters]
  Enclosure time{};          ///< from release to its lift-off [s]; NaN if not asked for, or not known
  Enclosure first_height{};  ///< of the first lift-off [hoop diameters]; NaN if not known
  Enclosure first_time{};    ///< from release to the first lift-off [s]; NaN if not asked for, or not known
};

/// Whether this library was built with Arb, without which prove throws InputError.
bool can_prove();

/// Proves what becomes of a design.
/// @throws InputError for a design that cannot be, with friction, and for a library that was built without
///         Arb; Stopped
Proof prove(const Design& design, const Scene& scene = {});

/// Proves what becomes of all designs of a box, of which up to seven parameters may vary.
/// @param times  whether to enclose times, at half the cost on top, of hoops that do not turn round before
/// @throws InputError as for one design, and for bounds that are not in order or differ in size; Stopped
Proof prove(const DesignBox& box, const Scene& scene = {}, bool times = false);

}  // namespace leapmap
