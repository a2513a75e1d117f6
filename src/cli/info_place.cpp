// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/info_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "boundaries/cliff.hpp"
#include "cli/hop_gradient.hpp"
#include "cli/output.hpp"
#include "leapmap/errors.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"
#include "spec/scatter_check.hpp"

namespace leapmap::cli {
namespace {

/// The spec's design with the axes' parameters as given.
Design design_at(const Spec& spec, const std::string& at) {
  Design design = spec.design;
  std::vector<std::string> given;
  for (std::size_t begin = 0; begin <= at.size();) {
    const std::size_t end = std::min(at.find(',', begin), at.size());
    const std::string part = at.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    const auto axis = std::ranges::find(spec.axes, name, &Axis::key);
    if (equals == std::string::npos || axis == spec.axes.end() ||
        std::ranges::find(given, name) != given.end()) {
      std::vector<std::string> names;
      for (const Axis& each : spec.axes) names.push_back(fmt::format("{}=VALUE", each.key));
      throw InputError(fmt::format("--at {}: '{}' is not an axis with its value; allowed: {}", at, part,
                                   fmt::join(names, ",")));
    }
    given.push_back(name);
    const Option& option = *find_option("", name);
    try {
      design.*member_of(option) = parse_number(option, part.substr(equals + 1), scales_of(spec.scene));
    } catch (const InputError& error) {
      throw InputError(fmt::format("--at {}: {}: {}", at, name, error.what()));
    }
  }
  for (const Axis& axis : spec.axes)
    if (std::ranges::find(given, axis.key) == given.end())
      throw InputError(fmt::format("--at {}: lacks {}; allowed: a value of every axis", at, axis.key));
  return design;
}

void print_outcome(const Outcome& outcome, const Scene& scene) {
  say("{}\n", told(discrete(outcome, false)));
  for (const Field* field : fields_of(scene)) {
    const std::optional<OutcomeNumber> number = number_of(*field);
    if (!number || std::isnan(number->of(outcome))) continue;
    say("  {:<20} {:<14.8g} {}\n", field->name, number->of(outcome), field->unit == "1" ? "" : field->unit);
  }
  if (outcome.phase_sequence != 0) say("  {:<20} {}\n", "phases", phase_letters(outcome.phase_sequence));
}

/// As the map has it at its designs.
void print_made(const Spec& spec, const Design& design) {
  const Request request = request_of(spec);
  MadeColumns columns(statistics_of(request));
  scatter_solver_of(request, points_of(spec.scatter)).solve({&design, 1}, columns);
  say("manufactured, {} hoops\n", spec.scatter.samples);
  for (const Field* field : columns.fields())
    say("  {:<20} {:<14.8g} {}\n", field->name, columns.column(*field)[0],
        field->unit == "1" ? "" : field->unit);
}

/// The jump's height on this side of a cliff and beyond it: not every cliff costs any.
std::string heights_beside(const Spec& spec, const Design& design, const NearCliff& cliff, std::size_t axis) {
  constexpr double beside = 1e-9;
  const auto member = member_of(spec.axes[axis].key);
  const double way = cliff.at[axis] < design.*member ? -1.0 : 1.0,
               step = way * beside * std::max(1.0, std::abs(cliff.at[axis]));
  std::array<Design, 2> designs{design, design};
  std::array<Outcome, 2> outcomes;
  designs[0].*member = cliff.at[axis] - step, designs[1].*member = cliff.at[axis] + step;
  make_solver(request_of(spec, {find_field("jump_height")}))(designs, outcomes);
  const auto height = [](const Outcome& o) {
    return std::isnan(o.jump_height) ? "none" : fmt::format("{:.4g}", o.jump_height);
  };
  return height(outcomes[0]) + " to " + height(outcomes[1]);
}

}  // namespace

std::string told(const Discrete& outcome) {
  std::string text(name_of(outcome.status));
  if (outcome.jumps_on > 0) text += fmt::format(" at lift-off {}", outcome.jumps_on);
  if (outcome.status != Status::jumped && outcome.spurious_first_jump == 1)
    text += ", after a sub-threshold lift-off";
  if (outcome.phase_sequence != 0) text += fmt::format(" {}", phase_letters(outcome.phase_sequence));
  return text;
}

void print_place(const Spec& original, const std::string& at) {
  if (original.axes.empty())
    throw InputError(origin_of(original) + ": is a list of designs; allowed: --at with a map over axes");
  Spec one = original;
  one.design = design_at(original, at);
  const NearCliffs cliffs = near_cliffs(original, one.design);
  one.axes.clear();
  one.output = {};
  check_scatter(one);  // a percentage may be one of nothing just here
  Outcome outcome;
  make_solver(request_of_outcomes(one))({&one.design, 1}, {&outcome, 1});
  print_outcome(outcome, one.scene);
  if (!original.scatter.spreads.empty()) print_made(original, one.design);
  if (resolved_method(one.numerics) == "exact") print_gradient(one);

  say("\nNearest discontinuities within the map (a band narrower than a thousandth of an axis may be "
      "missed)\n");
  const auto place = [&](std::size_t k, double value) {
    const Option& option = *find_option("", original.axes[k].key);
    const double from_here = value - value_of(option, one.design);
    if (option.unit != "rad") return fmt::format("{} {:.8g} ({:+.3g})", option.key, value, from_here);
    constexpr double degree = std::numbers::pi / 180.0;
    return fmt::format("{} {:.8g} ({:.6g} deg, {:+.3g} deg)", option.key, value, value / degree,
                       from_here / degree);
  };
  bool none = true;
  for (std::size_t k = 0; k < original.axes.size(); ++k)
    for (const NearCliff& cliff : cliffs.along[k]) {
      none = false;
      say("  {:<46} {:<10} height {}, beyond: {}\n", place(k, cliff.at[k]), name_of(cliff.kind),
          heights_beside(original, one.design, cliff, k), told(cliff.beyond));
    }
  if (none) say("  none along any axis\n");
  if (cliffs.nearest.empty()) return;
  std::vector<std::string> places;
  for (std::size_t k = 0; k < original.axes.size(); ++k) places.push_back(place(k, cliffs.nearest[0].at[k]));
  say("Nearest over all directions: {:.3g} of the map's ranges away, at {}: {}\n", cliffs.nearest[0].distance,
      fmt::join(places, ", "), name_of(cliffs.nearest[0].kind));
}

}  // namespace leapmap::cli
