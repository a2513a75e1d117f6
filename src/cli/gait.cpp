// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap gait: how one hoop goes on jumping for ever.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/told_sequences.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/gait.hpp"
#include "model/model.hpp"
#include "sweep/options.hpp"
#include "sweep/solver.hpp"

namespace leapmap::cli {
namespace {

struct GaitArguments {
  std::string spec;
  std::vector<std::string> overrides, flags;
  int most_period = 0;  // 0: not given
  bool json = false;
};

constexpr int usual_most_period = 2;

double degrees_within_a_turn(double radians) {
  const double turned = std::fmod(radians * 180.0 / std::numbers::pi, 360.0);
  return turned < 0.0 ? turned + 360.0 : turned;
}

void print_gaits(const Gaits& found, int most_period) {
  if (found.gaits.empty()) {
    say("No gait of up to {} jumps found: its return map, looked at in {} places, has no periodic orbit "
        "there.\n",
        most_period, found.returns.size());
    return;
  }
  say("Gaits found of up to {} jumps, by the return map in {} places and, of those that jump again at each "
      "landing, from a grid of starts:\n\n{:>6} {:>9} {:>12} {:>12} "
      "{:>11} "
      "{:>12}  "
      "{}\n",
      most_period, found.returns.size(), "period", "", "multiplier", "height [2R]", "speed [m/s]",
      "energy lost", "lift-offs [deg]: heights [2R]");
  for (const Gait& gait : found.gaits) {
    std::vector<std::string> jumps;
    for (const Jump& jump : gait.jumps)
      jumps.push_back(fmt::format("{:.4f}: {:.6f}", degrees_within_a_turn(jump.angle), jump.height));
    say("{:>6} {:>9} {:>12.6f} {:>12.6f} {:>11.4f} {:>12.6f}  {}\n", gait.jumps.size(),
        gait.is_stable() ? "stable" : "unstable", gait.multiplier, gait.height, gait.speed, gait.energy_lost,
        fmt::join(jumps, ", "));
  }
  say("\n");
  if (!found.is_whole)
    say("Its return map has more folds than were looked at: longer gaits may be missing; try a smaller "
        "--most-period.\n\n");
}

/// found: none were looked for.
std::string json_text(const Spec& spec, const Gaits* found, const Outcome& outcome) {
  std::vector<std::string> gaits, returns;
  for (const Gait& gait : found ? found->gaits : std::vector<Gait>{}) {
    std::vector<std::string> jumps;
    for (const Jump& jump : gait.jumps)
      jumps.push_back(fmt::format(R"({{"angle": {}, "spin": {}, "height": {}, "time": {}, "distance": {}}})",
                                  json_number(jump.angle), json_number(jump.spin), json_number(jump.height),
                                  json_number(jump.time), json_number(jump.distance)));
    gaits.push_back(fmt::format(
        R"({{"period": {}, "multiplier": {}, "height": {}, "speed": {}, "energy_lost": {}, "jumps": [{}]}})",
        gait.jumps.size(), json_number(gait.multiplier), json_number(gait.height), json_number(gait.speed),
        json_number(gait.energy_lost), fmt::join(jumps, ", ")));
  }
  for (const ReturnPoint& point : found ? found->returns : std::vector<ReturnPoint>{})
    returns.push_back(fmt::format("[{}, {}, {}, {}, {}]", json_number(point.angle), json_number(point.next),
                                  json_number(point.slope), json_number(point.height), point.uphill));
  std::vector<std::string> design;
  for (const Option* parameter : design_parameters(spec))
    design.push_back(
        fmt::format("\"{}\": {}", parameter->key, json_number(value_of(*parameter, spec.design))));
  return fmt::format(
      "{{\n  \"design\": {{{}}},\n  \"gait_period\": {},\n  \"gait_multiplier\": {},\n  \"gait_height\": "
      "{},\n  "
      "\"gait_speed\": {},\n  \"gait_energy_lost\": {},\n  \"gaits\": {},\n  \"return_map\": {}\n}}\n",
      fmt::join(design, ", "), outcome.gait_period, json_number(outcome.gait_multiplier),
      json_number(outcome.gait_height), json_number(outcome.gait_speed),
      json_number(outcome.gait_energy_lost),
      found ? fmt::format("[{}]", fmt::join(gaits, ",\n    ")) : "null",
      found ? fmt::format("[{}]", fmt::join(returns, ",\n    ")) : "null");
}

int run(const GaitArguments& arguments) {
  std::vector<std::string> overrides = arguments.overrides;
  overrides.insert(overrides.end(), arguments.flags.begin(), arguments.flags.end());
  refuse_scatter(overrides, "allowed: one design as drawn");
  Spec spec = read_given_spec(arguments.spec, overrides);
  if (!spec.axes.empty() || !spec.points.empty())
    throw InputError(
        fmt::format("{}: has many designs; allowed: one for leapmap gait, and leapmap sweep with [gait] "
                    "for a map of gaits",
                    origin_of(spec)));
  const bool slips = model_of(spec.scene).slips;
  if (slips && arguments.most_period != 0)
    throw InputError(
        "--most-period: has no use with friction, where only what the release settles on is told; allowed: "
        "gait.most_period");
  const auto names = [&](const std::string& section, const std::string& key) {
    return std::ranges::any_of(overrides, [&](const std::string& text) {
      return text.starts_with(section + "." + key + "=") || text.starts_with(key + "=");
    });
  };
  if (names("scene", "jumps"))
    throw InputError("scene.jumps: has no use here, where jumps go on for ever; allowed: gait.settle");
  if (names("gait", "settle") && spec.scene.settle == 0)
    throw InputError("gait.settle = 0: leaves nothing to tell; allowed: a number of jumps, 500 by default");
  if (spec.scene.settle == 0) spec.scene.settle = 500;
  spec.scene.jumps = 1;
  spec.output = {};
  check_spec(spec);
  Outcome outcome;
  make_solver(spec)({&spec.design, 1}, {&outcome, 1});
  Gaits found;
  const int most_period = arguments.most_period != 0 ? arguments.most_period : usual_most_period;
  if (!slips)
    found = find_gaits(spec.design, spec.scene,
                       {.most_period = most_period, .tolerance = spec.numerics.tolerance});
  if (arguments.json) {
    say("{}", json_text(spec, slips ? nullptr : &found, outcome));
    return 0;
  }
  if (!slips) print_gaits(found, most_period);
  say("{}\n", settled_line(outcome, spec.scene.settle));
  return 0;
}

}  // namespace

void add_gait(CommandLine& line, int& status) {
  Command command =
      line.command("gait", "how one hoop goes on jumping for ever: its periodic jumps, stable or not");
  auto arguments = std::make_shared<GaitArguments>();
  command.value("SPEC", arguments->spec, "a spec without axes; default: the paper's hoop")
      .check(named_file());
  for (const Option* option : hop_options())
    if (option->key != "jumps") add_flag_of(command, *option, arguments->flags);
  add_set(command, arguments->overrides, ", for example gait.settle=2000");
  command.value("--most-period", arguments->most_period, "longest gait looked for, in jumps; default 2")
      .check(whole_number(1, 16));
  command.flag("--json", arguments->json, "print JSON, with the return map where it was looked at");
  command.footer(
      "A gait is stable where its multiplier, by which small errors grow from one round to the next, is "
      "below 1 in\n"
      "size. Without slip N = 0 ties spin to angle at a lift-off, so that the map from one lift-off to the "
      "next is a\n"
      "curve: its periodic orbits are looked for, unstable ones too. With friction the gait is told that "
      "the\n"
      "release settles on. The runway counts from one landing to the next.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
