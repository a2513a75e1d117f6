// SPDX-License-Identifier: GPL-3.0-or-later
/// The table of keys as --help tells it.
#include <fmt/format.h>

#include <cmath>

#include "model/model.hpp"
#include "sweep/options.hpp"

namespace leapmap {
namespace {

std::string default_of(const Option& option) {
  Spec spec;
  return std::visit(
      [&](const auto& slot) -> std::string {
        using Slot = std::decay_t<decltype(slot)>;
        if constexpr (std::is_same_v<Slot, FrictionSlot>) {
          return fmt::format("\"{}\"", model_of(spec.scene).name);
        } else if constexpr (std::is_same_v<Slot, SceneSlot>) {
          return fmt::format("{}", spec.scene.*slot.member);
        } else if constexpr (std::is_same_v<Slot, ParameterSlot>) {
          const double value = spec.design.*slot.member;
          if (std::isnan(value)) return "that of mu_static";
          return option.key == "release_angle" ? "180 deg" : fmt::format("{:.6g}", value);
        } else if constexpr (std::is_same_v<Slot, TextSlot>) {
          return fmt::format("\"{}\"", slot(spec));
        } else if constexpr (std::is_same_v<Slot, TextsSlot>) {
          return option.key == "fields" || option.key == "gradients_by" ? "[all]" : "[none]";
        } else if constexpr (std::is_same_v<Slot, SpreadSlot> || std::is_same_v<Slot, GoalSlot>) {
          return "none";
        } else {
          return fmt::format("{}", slot(spec));
        }
      },
      option.slot);
}

}  // namespace

std::string options_help() {
  std::string help =
      "Spec keys (TOML, or --set KEY=VALUE). A key marked * also takes an axis:\n"
      "  slope = { from = \"2 deg\", to = \"50 deg\", count = 241 }     mass_ratio = { from = 0.1, to = 20, "
      "count = 256, "
      "scale = \"log\" }\n"
      "  offset_ratio = { values = [0.6, 0.8, 1.0] }\n"
      "For leapmap design it is free between two bounds: slope = { from = \"2 deg\", to = \"50 deg\" }.\n";
  std::string_view section;
  for (const Option& option : spec_options()) {
    const bool spread = std::holds_alternative<SpreadSlot>(option.slot),
               goal = std::holds_alternative<GoalSlot>(option.slot);
    const bool begins = option.section != section;
    if (begins) help += fmt::format("[{}]\n", section = option.section);
    if (begins && spread)
      help +=
          "  PARAMETER = { normal = \"1 deg\" } or { uniform = \"2 %\" }: how hoops as made differ from the "
          "drawing, by a standard\n  deviation or half width in the parameter's unit or per cent of its "
          "value; "
          "cut off where it may not be. A parameter is any key marked *.\n";
    if (begins && goal)
      help +=
          "  FIELD = { at_least = 0.8 }, { at_most = 0.6 }, both, or { is = ... }: what a hoop must do. A "
          "field is any that a\n  map has of a hoop as drawn, in its unit, an angle also as \"700 deg\"; a "
          "code by "
          "its number or name, a phase_sequence as\n  \"RSF\". For leapmap design also yield, the share of "
          "the "
          "hoops made that reach all the others.\n";
    if (spread || goal) continue;
    const bool axis = std::holds_alternative<ParameterSlot>(option.slot);
    const std::string unit =
        option.unit.empty() || option.unit == "1" ? "" : fmt::format(" [{}]", option.unit);
    help += fmt::format("  {:<19}{} {}{}; {}. Default {}.\n", option.key, axis ? '*' : ' ', option.meaning,
                        unit, allowed_values(option), default_of(option));
  }
  return help;
}

}  // namespace leapmap
