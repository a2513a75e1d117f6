// SPDX-License-Identifier: GPL-3.0-or-later
/// The keys of a spec, as --help lists them.
#include <fmt/format.h>

#include <cmath>

#include "model/model.hpp"
#include "spec/options.hpp"
#include "spec/spec_hoop.hpp"
#include "support/wrapped.hpp"

namespace leapmap {

std::string default_value(const Option& option) {
  Spec spec;
  return std::visit(
      [&](const auto& slot) -> std::string {
        using Slot = std::decay_t<decltype(slot)>;
        if constexpr (std::is_same_v<Slot, WordSlot>) {
          return fmt::format("\"{}\"", slot.word(spec.scene));
        } else if constexpr (std::is_same_v<Slot, SceneSlot>) {
          return fmt::format("{}", spec.scene.*slot.member);
        } else if constexpr (std::is_same_v<Slot, ParameterSlot>) {
          const double value = spec.design.*slot.member;
          if (std::isnan(value)) return "mu_static";
          return option.key == "release_angle" ? "180 deg" : fmt::format("{:.6g}", value);
        } else if constexpr (std::is_same_v<Slot, TextSlot>) {
          return fmt::format("\"{}\"", slot(spec));
        } else if constexpr (std::is_same_v<Slot, TextsSlot>) {
          return option.key == "order"          ? "as given"
                 : option.key == "gradients_by" ? "all"
                 : option.key == "fields"       ? "all but measures of landings and of the way, and "
                                                  "sequence_condition"
                                                : "none";
        } else if constexpr (std::is_same_v<Slot, SwitchSlot>) {
          return slot(spec) ? "true" : "false";
        } else if constexpr (std::is_same_v<Slot, HoopSlot> || std::is_same_v<Slot, SpreadSlot> ||
                             std::is_same_v<Slot, GoalSlot>) {
          return "none";
        } else {
          return fmt::format("{}", slot(spec));
        }
      },
      option.slot);
}

std::string options_help() {
  constexpr std::size_t column = 24;
  std::string help =
      "Keys of a spec (TOML, or --set KEY=VALUE). A key marked * also takes an axis:\n"
      "  slope = { from = \"2 deg\", to = \"50 deg\", count = 241 }\n"
      "  mass_ratio = { from = 0.1, to = 20, count = 256, scale = \"log\" }\n"
      "  offset_ratio = { values = [0.6, 0.8, 1.0] }\n"
      "leapmap design takes bounds instead:\n"
      "  slope = { from = \"2 deg\", to = \"50 deg\" }\n";
  std::string_view section;
  for (const Option& option : spec_options()) {
    const bool spread = std::holds_alternative<SpreadSlot>(option.slot),
               goal = std::holds_alternative<GoalSlot>(option.slot);
    const bool begins = option.section != section;
    if (begins && section == "scene") help += hoop_help();
    if (begins) help += fmt::format("\n[{}]\n", section = option.section);
    if (begins && spread)
      help +=
          "  slope = { normal = \"1 deg\" } or { uniform = \"2 %\" }\n"
          "Tolerances of manufactured hoops, for any key marked *: standard deviation or half width, in the "
          "parameter's unit or per cent of its value, truncated to the parameter's domain.\n";
    if (begins && goal)
      help +=
          "  jump_height = { at_least = 0.8 }, { at_most = 0.6 }, both, or { is = 0 }\n"
          "Goals, for any field of a nominal hoop, in its unit; angles also as \"700 deg\", codes by number "
          "or name, a phase_sequence as \"RSF\". leapmap design also takes yield, the fraction of "
          "manufactured hoops that reach all the other goals, and worst_case, the least jump height within "
          "uniform tolerances.\n";
    if (spread || goal) continue;
    const bool axis = std::holds_alternative<ParameterSlot>(option.slot);
    const std::string unit =
        option.unit.empty() || option.unit == "1" ? "" : fmt::format(" [{}]", option.unit);
    help += list_entry(fmt::format("  {} {}", option.key, axis ? "*" : ""),
                       fmt::format("{}{}; {}. Default: {}.", option.meaning, unit, allowed_values(option),
                                   default_value(option)),
                       column);
  }
  return help;
}

}  // namespace leapmap
