// SPDX-License-Identifier: GPL-3.0-or-later
/// What a spec comes to once its defaults and "auto" are settled.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "leapmap/outcome.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/variable.hpp"
#include "spec/options.hpp"
#include "spec/spacing.hpp"
#include "spec/spec.hpp"
#include "spec/spec_hoop.hpp"
#include "support/number.hpp"

namespace leapmap {
namespace {

std::string quoted_text(const std::string& value) {
  std::ostringstream quoted;
  quoted << toml::value<std::string>(value);
  return quoted.str();
}

/// spaced: by its bounds where those give the same bits.
std::string text_of(const Axis& axis, bool spaced) {
  const auto scale = [](bool log) { return log ? ", scale = \"log\"" : ""; };
  if (axis.free)
    return fmt::format("{{ from = {}, to = {}{} }}", toml_number(axis.values.front()),
                       toml_number(axis.values.back()), scale(axis.log));
  if (const auto spacing = spaced ? spacing_of(axis.values) : std::nullopt)
    return fmt::format("{{ from = {}, to = {}, count = {}{} }}", toml_number(spacing->from),
                       toml_number(spacing->to), spacing->count, scale(spacing->log));
  std::vector<std::string> values;
  for (const double value : axis.values) values.push_back(toml_number(value));
  return fmt::format("{{ values = [{}] }}", fmt::join(values, ", "));
}

/// The value of an option; unset: its line is left out.
std::optional<std::string> value_of(const Option& option, Spec& spec) {
  if (option.section == "scatter" && spec.scatter.spreads.empty()) return std::nullopt;
  if (option.key == "interpolate" && !model_of(spec.scene).slips) return std::nullopt;
  return std::visit(
      [&](const auto& slot) -> std::optional<std::string> {
        using Slot = std::decay_t<decltype(slot)>;
        if constexpr (std::is_same_v<Slot, ParameterSlot>) {
          const double value = spec.design.*slot.member;
          if (std::isnan(value)) return std::nullopt;  // it follows another parameter
          return toml_number(value);
        } else if constexpr (std::is_same_v<Slot, SwitchSlot>) {
          return slot(spec) ? "true" : "false";
        } else if constexpr (std::is_same_v<Slot, HoopSlot>) {
          return std::nullopt;  // hoop_text's
        } else if constexpr (std::is_same_v<Slot, SceneSlot>) {
          const double value = spec.scene.*slot.member;
          const bool in_metres = slot.member == &Scene::clear_height && spec.scene.clear_height_in_metres;
          return in_metres ? fmt::format("\"{} m\"", value) : toml_number(value);
        } else if constexpr (std::is_same_v<Slot, WordSlot>) {
          return quoted_text(std::string(slot.word(spec.scene)));
        } else if constexpr (std::is_same_v<Slot, NumberSlot>) {
          return toml_number(slot(spec));
        } else if constexpr (std::is_same_v<Slot, SpreadSlot>) {
          const auto spread = std::ranges::find(spec.scatter.spreads, option.key, &Spread::parameter);
          if (spread == spec.scatter.spreads.end()) return std::nullopt;
          return leapmap::text_of(*spread);
        } else if constexpr (std::is_same_v<Slot, GoalSlot>) {
          const auto goal = std::ranges::find(spec.goals, option.key, &Goal::field);
          if (goal == spec.goals.end()) return std::nullopt;
          return leapmap::text_of(*goal);
        } else if constexpr (std::is_same_v<Slot, IntegerSlot>) {
          return fmt::format("{}", slot(spec));
        } else if constexpr (std::is_same_v<Slot, TextSlot>) {
          if (slot(spec).empty()) return std::nullopt;
          return quoted_text(slot(spec));
        } else {
          if (slot(spec).empty()) return std::nullopt;
          std::vector<std::string> names;
          for (const std::string& name : slot(spec)) names.push_back(quoted_text(name));
          return fmt::format("[{}]", fmt::join(names, ", "));
        }
      },
      option.slot);
}

/// Whether [hoop] gives what an option does.
bool is_of_body(const Spec& spec, const Option& option) {
  if (!spec.hoop || std::holds_alternative<SpreadSlot>(option.slot)) return false;
  const auto* of_design = std::get_if<ParameterSlot>(&option.slot);
  const auto* of_scene = std::get_if<SceneSlot>(&option.slot);
  return of_design ? follows_from_body(of_design->member)
                   : of_scene && (of_scene->member == &Scene::radius || of_scene->member == &Scene::mass);
}

/// What only another mechanism than the scene's has; of a hoop also that it is one, so that programs which
/// know nothing else can read its maps.
bool is_of_other_mechanism(const Option& option, const Scene& scene) {
  if (option.key == "model" && option.section == "scene") return scene.model == Mechanism::hoop;
  return option.only_of.model && *option.only_of.model != scene.model;
}

std::string text_of(const Spec& original, bool spaced) {
  Spec spec = original;
  spec.numerics.method = resolved_method(spec);
  // The axes of [hoop] stand in a section of their own.
  const bool has_order =
      std::ranges::any_of(spec.axes, [](const Axis& axis) { return find_body_number(axis.key) != nullptr; });
  spec.output.order.clear();
  for (const Axis& axis : spec.axes)
    if (has_order && spec.axes.size() > 1) spec.output.order.push_back(axis.key);
  std::string text;
  std::string_view section;
  const auto line = [&](std::string_view header, std::string_view key, const std::string& value) {
    if (header != section) text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", section = header);
    text += fmt::format("{} = {}\n", key, value);
  };
  for (const Option& option : spec_options()) {
    if (option.section == "gait" && spec.scene.settle == 0) continue;
    if (is_of_other_mechanism(option, spec.scene)) continue;
    // Axes come after all numbers of the section, in the order of the map's dimensions.
    if (option.key == "points")
      for (const Axis& axis : spec.axes)
        if (!find_body_number(axis.key)) line("design", axis.key, text_of(axis, spaced));
    if (is_of_body(spec, option)) continue;
    const bool parameter = std::holds_alternative<ParameterSlot>(option.slot);
    if (parameter && std::ranges::find(spec.axes, option.key, &Axis::key) != spec.axes.end()) continue;
    if (const auto value = value_of(option, spec)) line(option.section, option.key, *value);
    if (option.section == "scatter" && option.key == "samples")
      for (const Spread& spread : spec.scatter.spreads)
        if (find_body_number(spread.parameter)) line("scatter", spread.parameter, leapmap::text_of(spread));
  }
  return text + hoop_text(spec, [&](const Axis& axis) { return text_of(axis, spaced); });
}

}  // namespace

std::string text_of(const Spread& spread) {
  return fmt::format("{{ {} = {} }}", spread.law == Spread::Law::normal ? "normal" : "uniform",
                     spread.percent ? fmt::format("\"{} %\"", spread.width) : toml_number(spread.width));
}

std::string text_of(const Goal& goal) {
  const Field& field = *find_field(goal.field);
  if (std::holds_alternative<Word>(field.source))
    return fmt::format("{{ is = \"{}\" }}", phase_letters(static_cast<std::uint64_t>(goal.at_least)));
  const auto* code = std::get_if<Code>(&field.source);
  if (code && !code->names.empty())
    return fmt::format("{{ is = \"{}\" }}", code->names[static_cast<std::size_t>(goal.at_least)]);
  const auto limit = [&](double value) {
    return goal.unit_of_nominal > 0.0 ? fmt::format("\"{} {}\"", value, find_own_unit(own_unit(field))->si)
                                      : toml_number(value);
  };
  if (goal.at_least == goal.at_most) return fmt::format("{{ is = {} }}", limit(goal.at_least));
  std::vector<std::string> parts;
  if (std::isfinite(goal.at_least)) parts.push_back("at_least = " + limit(goal.at_least));
  if (std::isfinite(goal.at_most)) parts.push_back("at_most = " + limit(goal.at_most));
  return fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

std::string resolved_text(const Spec& spec) { return text_of(spec, false); }

std::string readable_text(const Spec& spec) { return text_of(spec, true); }

bool stores(const Output& output, const Field& field) {
  return output.fields.empty() ? field.by_default == ByDefault::stored
                               : std::ranges::find(output.fields, field.name) != output.fields.end();
}

std::string resolved_method(const Numerics& numerics, const Scene& scene) {
  if (numerics.method != "auto") return numerics.method;
  const std::string_view stepper = model_of(scene).stepper;
  return std::string(stepper.empty() ? "exact" : stepper);
}

}  // namespace leapmap
