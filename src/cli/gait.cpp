// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap gait: the periodic jumps of one hoop.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/audit_lines.hpp"
#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/output.hpp"
#include "cli/shown_units.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/gait.hpp"
#include "model/model.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"

namespace leapmap::cli {
namespace {

struct GaitArguments {
  std::string spec, units;
  std::vector<std::string> overrides, flags;
  int most_period = 0;  // 0: not given
  bool json = false;
};

constexpr int usual_most_period = 2;

double degrees_within_a_turn(double radians) {
  const double turned = std::fmod(radians * 180.0 / std::numbers::pi, 360.0);
  return turned < 0.0 ? turned + 360.0 : turned;
}

/// "height [mm]", and what its numbers are multiplied by.
struct GaitColumn {
  std::string header;
  double factor;
};

GaitColumn column_of(std::string_view name, std::string_view field, ShownUnits& units) {
  const ShownUnit shown = units.of(*find_field(field));
  return {fmt::format("{} [{}]", name, shown.unit), shown.factor};
}

void print_gaits(const Gaits& found, int most_period, ShownUnits& units) {
  if (found.gaits.empty()) {
    say("No gait of up to {} jumps found: the return map, sampled at {} points, has no periodic orbit.\n",
        most_period, found.returns.size());
    return;
  }
  const GaitColumn height = column_of("height", "gait_height", units),
                   speed = column_of("speed", "gait_speed", units),
                   lost = column_of("lost", "gait_energy_lost", units);
  say("Gaits of up to {} jumps, from {} points of the return map and a grid of starting points:\n\n"
      "{:>6} {:>9} {:>12} {:>23} {:>16} {:>19}  {}\n",
      most_period, found.returns.size(), "period", "", "multiplier", height.header, speed.header, lost.header,
      "lift-offs [deg]: heights");
  for (const Gait& gait : found.gaits) {
    std::vector<std::string> jumps;
    for (const Jump& jump : gait.jumps)
      jumps.push_back(
          fmt::format("{:.4f}: {:.6f}", degrees_within_a_turn(jump.angle), jump.height * height.factor));
    say("{:>6} {:>9} {:>12.6f} {:>23} {:>16.4f} {:>19.6f}  {}\n", gait.jumps.size(),
        gait.is_stable() ? "stable" : "unstable", gait.multiplier,
        fmt::format("{:.6f}{}", gait.height * height.factor,
                    units.beside(gait.height, *find_field("gait_height"))),
        gait.speed * speed.factor, gait.energy_lost * lost.factor, fmt::join(jumps, ", "));
  }
  say("\n");
  if (!found.is_whole)
    say("The return map has more folds than were sampled: gaits may be missing; try a smaller "
        "--most-period.\n\n");
}

Json json_of(const Gait& gait) {
  Json jumps = Json::array();
  for (const Jump& jump : gait.jumps)
    jumps.push_back({{"angle", jump.angle},
                     {"spin", jump.spin},
                     {"height", jump.height},
                     {"time", jump.time},
                     {"distance", jump.distance}});
  return {{"period", gait.jumps.size()},
          {"multiplier", gait.multiplier},
          {"height", gait.height},
          {"speed", gait.speed},
          {"jump_time", gait.jump_time},
          {"energy_lost", gait.energy_lost},
          {"jumps", jumps}};
}

/// found: nullptr if there was no search.
Json json_of(const Spec& spec, const Gaits* found, const Outcome& outcome) {
  Json json{{"design", design_json(spec, spec.design)},
            {"gait_period", outcome.gait_period},
            {"gait_multiplier", outcome.gait_multiplier},
            {"gait_height", outcome.gait_height},
            {"gait_speed", outcome.gait_speed},
            {"gait_jump_time", outcome.gait_jump_time},
            {"gait_energy_lost", outcome.gait_energy_lost},
            {"gaits", nullptr},
            {"return_map", nullptr}};
  if (!found) return json;
  json["gaits"] = json["return_map"] = Json::array();
  for (const Gait& gait : found->gaits) json["gaits"].push_back(json_of(gait));
  for (const ReturnPoint& point : found->returns)
    json["return_map"].push_back(
        Json::array({point.angle, point.next, point.slope, point.height, point.uphill}));
  return json;
}

void refuse_more_designs(const Spec& spec) {
  if (!spec.axes.empty() || !spec.points.empty())
    throw InputError(fmt::format(
        "{}: has several designs; allowed: one design, or leapmap sweep with [gait] for a map of gaits",
        origin_of(spec)));
}

int run(const GaitArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  overrides.insert(overrides.end(), arguments.flags.begin(), arguments.flags.end());
  refuse_scatter(overrides, "allowed: one nominal design");
  Spec spec = read_given_spec(arguments.spec, overrides, refuse_more_designs);
  const bool slips = model_of(spec.scene).slips;
  if (slips && arguments.most_period != 0)
    throw InputError(
        "--most-period: has no effect with friction, which reports only the gait that follows the release; "
        "allowed: gait.most_period");
  const auto names = [&](const std::string& section, const std::string& key) {
    return std::ranges::any_of(overrides, [&](const std::string& text) {
      return text.starts_with(section + "." + key + "=") || text.starts_with(key + "=");
    });
  };
  if (names("scene", "jumps"))
    throw InputError("scene.jumps: has no effect here, because gaits never end; allowed: gait.settle");
  if (names("gait", "settle") && spec.scene.settle == 0)
    throw InputError("gait.settle = 0: switches the search off; allowed: a number of jumps, 500 by default");
  if (spec.scene.settle == 0) spec.scene.settle = 500;
  spec.scene.jumps = 1;
  spec.output = {};
  check_spec(spec);
  ShownUnits units(arguments.units, scales_of(spec.scene));
  for (const std::string_view field : {"gait_height", "gait_speed", "gait_jump_time", "gait_energy_lost"})
    units.of(*find_field(field));
  units.refuse_unused();
  Outcome outcome;
  make_solver(request_of(spec))({&spec.design, 1}, {&outcome, 1});
  Gaits found;
  const int most_period = arguments.most_period != 0 ? arguments.most_period : usual_most_period;
  if (!slips)
    found = find_gaits(spec.design, spec.scene,
                       {.most_period = most_period, .tolerance = spec.numerics.tolerance});
  if (arguments.json) {
    say_json(json_of(spec, slips ? nullptr : &found, outcome));
    return 0;
  }
  if (!slips) print_gaits(found, most_period, units);
  say("{}\n", settled_line(outcome, spec.scene.settle, units));
  return 0;
}

}  // namespace

void add_gait(CommandLine& line, int& status) {
  Command command =
      line.command("gait", "find the periodic sequences of jumps of one hoop, and their stability");
  command.examples(
      {{"leapmap gait --slope 12deg --mass-ratio 3 --offset-ratio 0.5", "all gaits of one hoop"},
       {"leapmap gait --slope 12deg --friction coulomb --json", "with friction, for a program"}});
  auto arguments = std::make_shared<GaitArguments>();
  command.value("SPEC", arguments->spec, "a spec without axes (TOML); default: the paper's hoop")
      .check(named_file());
  add_flags_of_a_hoop(command, arguments->flags, "jumps");
  command.group("Options");
  add_set(command, arguments->overrides, ", for example gait.settle=2000");
  command.value("--most-period", arguments->most_period, "longest period to search for, in jumps; default: 2")
      .check(whole_number(1, 16));
  command.flag("--json", arguments->json, "print JSON, with the return map");
  command
      .value("--units", arguments->units,
             "units of the report, with blanks between them, for example \"mm ms J\"; default: leapmap's "
             "own, and beside them those of a drawing")
      .excludes("--json");
  command.footer(
      "A gait is stable if its Floquet multiplier, the growth of a small deviation over one period, is below "
      "1 in size.\n"
      "Without slip the normal force N = 0 determines the spin at a lift-off, so that the map from one "
      "lift-off to the next is a curve. All its periodic orbits are searched for, unstable ones too. With "
      "friction only the gait that follows the release is reported.\n"
      "The rolling limit counts from each landing.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
