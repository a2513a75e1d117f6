// SPDX-License-Identifier: GPL-3.0-or-later
/// How accurate this very sweep is: a random share of its outcomes, on their way to the map, solved again by
/// an independent method.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "map/tile.hpp"
#include "sweep/spec.hpp"
#include "trajectory/outcome.hpp"

namespace leapmap {

/// An outcome taken from a sweep on its way to the map.
struct AuditSample {
  std::size_t number;  ///< of the design, C order over the whole map
  Outcome outcome;
};

/// Draws samples tile by tile; which ones depends on the spec alone. Over all tiles, ceil(share * designs).
class AuditDraw {
 public:
  AuditDraw(const Spec& spec, const Tiling& tiling)
      : share_(spec.numerics.audit), single_(spec.output.precision == "f4"), tiling_(&tiling) {}
  /// Tiles come in order.
  void take(const Tile& tile, std::span<const Outcome> outcomes);
  const std::vector<AuditSample>& samples() const { return samples_; }

 private:
  double share_;
  bool single_;  // the map rounds to f4, and so do the samples
  const Tiling* tiling_;
  std::size_t seen_ = 0;
  std::vector<AuditSample> samples_;
};

/// What the two methods disagree on.
struct AuditReport {
  std::size_t designs = 0;
  std::string method;  ///< of the audit
  double max_abs_height_error =
      0.0;  ///< [hoop diameters], of jump, first lift-off and dip, where the flags agree
  double max_rel_time_error = 0.0;  ///< of the times to lift-off, apex and landing
  std::size_t flag_mismatches = 0;  ///< designs whose status, spurious flag or number of candidates differ
  /// Designs on which the audit's method gave up, or whose flags one unit in the last place of the inputs
  /// decides.
  std::size_t undecided = 0;
  double allowed_error = 0.0;                   ///< see audit; for heights, relative to 1 + height
  std::size_t beyond_tolerance = 0;             ///< designs whose error is larger
  std::optional<std::size_t> first_mismatch;    ///< the least design number whose flags differ
  std::optional<std::size_t> first_inaccurate;  ///< the least design number beyond the tolerance
};

/// The method that audits another: exact audits integration, integration by gsl-rk8pd at 1e-13 audits exact.
std::string audit_method(const Numerics& numerics);

/// Solves the samples again and compares. An error is beyond the tolerance if it is larger than
/// numerics.tolerance (a hundred times that for an adaptive stepper, whose tolerance is per step; no less
/// than 1e-11, the audit's own error), and larger than 10 times what one unit in the last place of the inputs
/// makes of it.
/// A map in f4 is allowed a rounding of f4 on top. stop_requested is asked after each design; once true, the
/// report covers what was done until then.
AuditReport audit(const Spec& spec, std::span<const AuditSample> samples, int threads,
                  const std::function<bool()>& stop_requested = {});

}  // namespace leapmap
