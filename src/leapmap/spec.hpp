// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// The specification of a sweep: designs, scene, method and output file. It is read from TOML or filled in
/// member by member; sweep checks it either way.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "leapmap/body.hpp"
#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// How designs are solved and cross-checked.
struct Numerics {
  std::string method = "auto";    ///< "auto", "exact" or a stepper's name
  double tolerance = 1e-10;       ///< exact: relative error allowed in times; stepper: per step; in (0, 0.1]
  double absolute_tolerance = 0;  ///< stepper: absolute error allowed per step; 0: equal to tolerance
  double fixed_step = 0;          ///< stepper: > 0: constant steps [sqrt(R/g)] without error control
  long max_steps = 1'000'000;     ///< stepper: a design that needs more gets status failed
  double audit = 0.001;           ///< fraction of designs solved again by an independent method, in [0, 1]
  std::string audit_by = "method";  ///< "method": a second solver; "proof": enclosures, without slip
};

/// What a map stores.
struct Output {
  std::string file{};                       ///< the map's path; the option -o overrides it
  std::vector<std::string> fields{};        ///< names of the fields to store; empty: all
  std::vector<std::string> gradients{};     ///< quantities to store with derivatives; empty: none
  std::vector<std::string> gradients_by{};  ///< parameters of these derivatives; empty: all of the model
  std::vector<std::string> order{};         ///< of the axes, the first varies slowest; empty: as given
  std::string precision = "f8";             ///< type of stored numbers: "f8" or "f4"
  long compression = 1;                     ///< level of deflate, 0 to 9; 0: none
};

/// One parameter that varies over a grid of designs.
struct Axis {
  std::string key{};             ///< name of the parameter, or "hoop.slug.mass" and the like
  std::vector<double> values{};  ///< in the parameter's own unit (angles in rad), ascending or descending
  bool free = false;             ///< find_designs and fit: `values` holds two bounds
  bool log = false;              ///< equal ratios count as equal distances
  bool spaced = false;           ///< written as { from, to }: find_designs takes the ends as bounds
};

/// A list of designs: one column of values for each parameter named, all of equal length.
struct PointList {
  std::string path{};                 ///< the CSV file
  std::vector<Axis> columns{};        ///< empty: the list holds only Spec::design
  std::vector<std::string> labels{};  ///< name of each design, at most 200 bytes of UTF-8; empty: none
  std::size_t count = 1;              ///< number of designs
};

/// Tolerance of one parameter in manufactured hoops.
struct Spread {
  /// Distribution around the nominal value.
  enum class Law { normal, uniform };
  std::string parameter{};  ///< name of the parameter, or "hoop.slug.mass" and the like
  Law law = Law::normal;    ///< distribution
  double width = 0.0;       ///< standard deviation, or half width of the uniform distribution, >= 0
  bool percent = false;     ///< `width` is in per cent of the nominal value, not in the parameter's unit
};

/// Tolerances of manufactured hoops. Parameters vary independently, truncated to their domains.
struct Scatter {
  std::vector<Spread> spreads{};  ///< at most one for each parameter; empty: all hoops are nominal
  long samples = 1024;            ///< number of manufactured hoops per design, a multiple of 16
  long seed = 1;                  ///< equal seeds give equal hoops
  /// With friction: a map solves each sample for some of its neighbouring designs, and interpolates it for
  /// those between if no discontinuity is near. Else all are solved.
  bool interpolate = true;
};

/// A goal: the range in which a field of the outcome must lie, in the map's unit, in SI or by its code.
struct Goal {
  std::string field{};                                         ///< name of the field
  double at_least = -std::numeric_limits<double>::infinity();  ///< lower limit
  double at_most = std::numeric_limits<double>::infinity();    ///< upper limit
  /// 0: the limits are in the map's unit. Else they are in SI, the same for hoops of every size and mass, and
  /// this is the map's unit in SI for the nominal hoop.
  double unit_of_nominal = 0.0;
};

/// A whole specification.
struct Spec {
  std::string origin{};       ///< the file it was read from, for messages
  Scene scene{};              ///< contact model, definition of a jump, size
  Design design{};            ///< values of the parameters that neither axes nor list give
  Numerics numerics{};        ///< method and cross-check
  Output output{};            ///< what the map stores
  std::string points{};       ///< design.points, as an absolute path
  std::vector<Axis> axes{};   ///< in the spec's order, the first varies slowest; empty: `list` is used
  PointList list{};           ///< used if there are no axes
  Scatter scatter{};          ///< tolerances
  std::vector<Goal> goals{};  ///< all of them are to be reached; at most one for each field
  std::vector<std::string> maximize{};  ///< find_designs: fields or parameters to maximize
  std::vector<std::string> minimize{};  ///< and to minimize; one or two objectives in all
  std::vector<std::string> notes{};     ///< to be shown, a line each: keys that are not used
  /// Parameters in the units of the nominal hoop of [hoop], so that hoops of every size and mass have the
  /// same in the SI: torques, spins. read_spec adds those that are given with a unit.
  std::vector<std::string> nominal_units{};
  /// Of [hoop]; `design` and `scene` hold what it comes to. Numbers that vary have their first values.
  std::optional<Body> hoop{};
};

/// Reads a spec from a TOML file.
/// @param path       an empty path means an empty spec: every key has its default
/// @param overrides  KEY=VALUE each, applied in order; KEY may include its section
/// @throws InputError for anything that is not allowed; IoError if the file cannot be read
Spec read_spec(const std::string& path, const std::vector<std::string>& overrides = {});

/// Reads a spec from a TOML text. A list of designs is not read; its path is kept.
/// @param origin  name of the text in messages
/// @throws InputError for anything that is not allowed
Spec parse_spec(std::string_view text, const std::string& origin = "text",
                const std::vector<std::string>& overrides = {});

/// The resolved spec as TOML, with every key and value. read_spec turns it into the same Spec again.
std::string resolved_text(const Spec& spec);

/// Checks a spec that was filled in member by member.
/// @throws InputError, with key, value and what is allowed, for anything that read_spec would refuse
void check_spec(const Spec& spec);

}  // namespace leapmap
