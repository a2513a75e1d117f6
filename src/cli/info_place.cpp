// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/info_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "boundaries/cliff.hpp"
#include "cli/hop_gradient.hpp"
#include "cli/output.hpp"
#include "cli/shown_units.hpp"
#include "leapmap/errors.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"
#include "spec/scatter_check.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap::cli {
namespace {

/// The values along the axes as given.
std::vector<double> values_at(const Spec& spec, const std::string& at) {
  std::vector<double> values(spec.axes.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t begin = 0; begin <= at.size();) {
    const std::size_t end = std::min(at.find(',', begin), at.size());
    const std::string part = at.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    const auto axis = std::ranges::find(spec.axes, name, &Axis::key);
    const auto k = static_cast<std::size_t>(axis - spec.axes.begin());
    if (equals == std::string::npos || axis == spec.axes.end() || !std::isnan(values[k])) {
      std::vector<std::string> names;
      for (const Axis& each : spec.axes) names.push_back(fmt::format("{}=VALUE", each.key));
      throw InputError(fmt::format("--at {}: '{}' is not an axis with its value; allowed: {}", at, part,
                                   fmt::join(names, ",")));
    }
    try {
      const Scales scales = is_held(spec, name) ? nominal_scales(spec) : common_scales(spec);
      values[k] = parse_number(*find_option("", name), part.substr(equals + 1), scales);
    } catch (const InputError& error) {
      throw InputError(fmt::format("--at {}: {}: {}", at, name, error.what()));
    }
  }
  for (std::size_t k = 0; k < values.size(); ++k)
    if (std::isnan(values[k]))
      throw InputError(
          fmt::format("--at {}: lacks {}; allowed: a value of every axis", at, spec.axes[k].key));
  return values;
}

void print_number(const Field& field, double value, ShownUnits& units) {
  const ShownUnit shown = units.of(field);
  if (std::isnan(value)) return say("  {:<24} none\n", field.name);
  const std::string text = fmt::format("  {:<24} {:<14.8g} {}{}", field.name, value * shown.factor,
                                       shown.unit, units.beside(value, field));
  say("{}\n", text.substr(0, text.find_last_not_of(' ') + 1));
}

void print_outcome(const Outcome& outcome, const Scene& scene, ShownUnits& units) {
  say("{}\n", outcome_text(discrete(outcome, false)));
  for (const Field* field : fields_of(scene)) {
    const std::optional<OutcomeNumber> number = number_of(*field);
    if (number && !std::isnan(number->of(outcome))) print_number(*field, number->of(outcome), units);
  }
  if (outcome.phase_sequence != 0) say("  {:<24} {}\n", "phases", phase_letters(outcome.phase_sequence));
}

/// As the map has it at its designs, with every hoop solved. scales: of the design.
void print_made(const Spec& spec, const Scales& scales, ShownUnits& units) {
  const Request request = request_of(spec);
  MadeColumns columns(statistics_of(request));
  scatter_solver_of(request, points_of(spec.scatter)).solve({&spec.design, 1}, columns);
  say("manufactured, {} hoops\n", spec.scatter.samples);
  units.scale(scales_of_manufactured(spec, scales));
  for (const Field* field : columns.fields()) print_number(*field, columns.column(*field)[0], units);
}

/// The jump's height on this side of a cliff and beyond it: not every cliff costs any.
std::string heights_beside(const Spec& spec, const std::vector<double>& here, const NearCliff& cliff,
                           std::size_t axis, ShownUnits& units) {
  constexpr double beside = 1e-9;
  const double way = cliff.at[axis] < here[axis] ? -1.0 : 1.0,
               step = way * beside * std::max(1.0, std::abs(cliff.at[axis]));
  const VariedDesigns designs_by(spec, spec.axes);
  std::vector<double> before = here, beyond = here;
  before[axis] = cliff.at[axis] - step, beyond[axis] = cliff.at[axis] + step;
  const std::array<Design, 2> designs{designs_by.at(before), designs_by.at(beyond)};
  std::array<Outcome, 2> outcomes;
  make_solver(request_of(spec, {find_field("jump_height")}))(designs, outcomes);
  const ShownUnit shown = units.of(*find_field("jump_height"));
  const auto height = [&](const Outcome& o) {
    return std::isnan(o.jump_height) ? "none" : fmt::format("{:.4g}", o.jump_height * shown.factor);
  };
  const std::string unit = shown.unit.empty() ? "" : " " + shown.unit;
  return height(outcomes[0]) + " to " + height(outcomes[1]) + unit;
}

}  // namespace

std::string outcome_text(const Discrete& outcome) {
  std::string text(name_of(outcome.status));
  if (outcome.jumps_on > 0) text += fmt::format(" at lift-off {}", outcome.jumps_on);
  if (outcome.status != Status::jumped && outcome.spurious_first_jump == 1)
    text += ", after a sub-threshold lift-off";
  if (outcome.phase_sequence != 0) text += fmt::format(" {}", phase_letters(outcome.phase_sequence));
  return text;
}

void print_place(const Spec& original, const std::string& at, const std::string& unit_words) {
  if (original.axes.empty())
    throw InputError(origin_of(original) + ": is a list of designs; allowed: --at with a map over axes");
  Spec one = original;
  const std::vector<double> here = values_at(original, at);
  Body body;
  one.design = VariedDesigns(original, original.axes).at(here, &body);
  if (one.hoop) one.hoop = body;
  const NearCliffs cliffs = near_cliffs(original, here);
  one.axes.clear();
  one.output = {};
  check_scatter(one);  // a percentage may be one of nothing just here
  Outcome outcome;
  Request request = request_of_outcomes(one);
  for (const std::string& name : original.output.fields)
    if (const Field* field = find_field(name); number_of(*field)) add_column(request.columns, field);
  make_solver(request)({&one.design, 1}, {&outcome, 1});
  const Scales scales = scales_of(original, one.design);
  ShownUnits units(unit_words, scales);
  std::vector<std::string> axes;
  for (const Axis& axis : original.axes) axes.push_back(axis.key);
  units.refuse_unusable(one.scene, axes);
  print_outcome(outcome, one.scene, units);
  if (!original.scatter.spreads.empty()) print_made(one, scales, units);
  if (resolved_method(one) == "exact") print_gradient(one);

  say("\nNearest discontinuities within the map (a band narrower than a thousandth of an axis may be "
      "missed)\n");
  const auto place = [&](std::size_t k, double value) {
    const Option& option = *find_option("", original.axes[k].key);
    const std::string& key = original.axes[k].key;
    const double from_here = value - here[k];
    if (const ShownUnit shown = units.of(key); !shown.unit.empty() && shown.unit != option.unit)
      return fmt::format("{0} {1:.8g} {3} ({2:+.3g} {3})", key, value * shown.factor,
                         from_here * shown.factor, shown.unit);
    if (option.unit != "rad") return fmt::format("{} {:.8g} ({:+.3g})", key, value, from_here);
    constexpr double degree = std::numbers::pi / 180.0;
    return fmt::format("{} {:.8g} ({:.6g} deg, {:+.3g} deg)", key, value, value / degree, from_here / degree);
  };
  bool none = true;
  for (std::size_t k = 0; k < original.axes.size(); ++k)
    for (const NearCliff& cliff : cliffs.along[k]) {
      none = false;
      say("  {:<46} {:<10} height {}, beyond: {}\n", place(k, cliff.at[k]), name_of(cliff.kind),
          heights_beside(original, here, cliff, k, units), outcome_text(cliff.beyond));
    }
  if (none) say("  none along any axis\n");
  if (cliffs.nearest.empty()) return;
  std::vector<std::string> places;
  for (std::size_t k = 0; k < original.axes.size(); ++k) places.push_back(place(k, cliffs.nearest[0].at[k]));
  say("Nearest over all directions: {:.3g} of the map's ranges away, at {}: {}\n", cliffs.nearest[0].distance,
      fmt::join(places, ", "), name_of(cliffs.nearest[0].kind));
}

}  // namespace leapmap::cli
