// SPDX-License-Identifier: GPL-3.0-or-later
/// A sweep's specification: which designs, in which scene, by which method, to which file.
///
/// Written in TOML (see README, "The spec"), or filled in member by member. sweep checks it either way.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

struct Numerics {
  std::string method = "auto";    ///< "auto", "exact" or a stepper's name
  double tolerance = 1e-10;       ///< exact: relative error allowed in times; a stepper: per step
  double absolute_tolerance = 0;  ///< absolute error allowed per step; 0: the same as tolerance
  double fixed_step = 0;          ///< > 0: constant steps [sqrt(R/g)], errors unchecked
  long max_steps = 1'000'000;     ///< a design that needs more has status failed
  double audit = 0.001;           ///< share of designs solved again by an independent method
};

struct Output {
  std::string file{};                       ///< the map; -o overrides it
  std::vector<std::string> fields{};        ///< datasets to store; empty: all
  std::vector<std::string> gradients{};     ///< quantities whose derivatives are stored; empty: none
  std::vector<std::string> gradients_by{};  ///< the parameters by which; empty: all that the model has
  std::string precision = "f8";             ///< of stored numbers: "f8" or "f4"
  long compression = 1;                     ///< deflate's level, 0 to 9; 0: none
};

/// One parameter that varies over a grid of designs: values in the parameter's own unit (angles in rad).
struct Axis {
  std::string key{};
  std::vector<double> values{};
  bool free = false;  ///< values are two bounds, and all between is meant: of find_designs only
  bool log = false;   ///< of a free or spaced one: equal ratios count as equal steps
  /// Written as { from, to } with a count or a step: find_designs takes the least and the largest value as
  /// bounds. A list of values is none, whatever they are.
  bool spaced = false;
};

/// Designs one by one: a column of values for each parameter named, all equally long.
struct PointList {
  std::string path{};                 ///< the CSV file
  std::vector<Axis> columns{};        ///< empty: the list is the one design of the spec itself
  std::vector<std::string> labels{};  ///< a name of each design, at most 200 bytes of UTF-8; empty: none
  std::size_t count = 1;
};

/// How much a parameter of hoops as made differs from the drawing.
struct Spread {
  enum class Law { normal, uniform };
  std::string parameter{};
  Law law = Law::normal;
  double width = 0.0;    ///< standard deviation, or half the width of a uniform law, >= 0
  bool percent = false;  ///< width is in per cent of the value drawn; else in the parameter's own unit
};

/// Hoops as made: independent of each other in every parameter named, cut off where a parameter may not be.
struct Scatter {
  std::vector<Spread> spreads{};  ///< at most one of a parameter; empty: hoops are as drawn
  long samples = 1024;            ///< hoops made after each drawing: 16 times a whole number
  long seed = 1;
};

/// What a hoop must do: a field of its outcome, in the map's unit or by its code, lies in this range.
struct Goal {
  std::string field{};
  double at_least = -std::numeric_limits<double>::infinity();
  double at_most = std::numeric_limits<double>::infinity();
};

struct Spec {
  std::string origin{};  ///< the file it was read from, for messages
  Scene scene{};
  Design design{};  ///< what axes and points leave out
  Numerics numerics{};
  Output output{};
  std::string points{};      ///< design.points, as an absolute path
  std::vector<Axis> axes{};  ///< in spec order, the first varying slowest; empty: `list` holds the designs
  PointList list{};
  Scatter scatter{};
  std::vector<Goal> goals{};  ///< all are to be reached; at most one of a field
  // What find_designs looks for: one or two fields or parameters in all.
  std::vector<std::string> maximize{}, minimize{};
};

/// Reads a spec from a TOML file; overrides are KEY=VALUE, applied in order, KEY with or without its section.
/// An empty path means an empty spec: every key at its default. Throws InputError (leapmap/errors.hpp) for
/// anything that is not allowed, IoError if the file cannot be read.
Spec read_spec(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from a TOML text; origin is for messages. A list of designs is left as its path.
Spec parse_spec(std::string_view text, const std::string& origin = "text",
                const std::vector<std::string>& overrides = {});

/// The spec as resolved: TOML that read_spec turns into the same Spec again, every key and value written out.
std::string resolved_text(const Spec& spec);

/// Throws InputError, naming key, value and what is allowed, if a spec filled in by hand is one that
/// read_spec would refuse.
void check_spec(const Spec& spec);

}  // namespace leapmap
