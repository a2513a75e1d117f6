// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/map_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "map/hdf5_trust.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap {
namespace {

bool is_in_metres(const Spec& spec, const SceneSlot& slot) {
  return slot.member == &Scene::clear_height && spec.scene.clear_height_in_metres;
}

/// The values of an option: a number's alone, an axis's all.
std::vector<double> numbers_of(Spec& spec, const Option& option) {
  if (std::holds_alternative<SpreadSlot>(option.slot) || std::holds_alternative<GoalSlot>(option.slot))
    return {};
  const auto axis = std::ranges::find(spec.axes, option.key, &Axis::key);
  if (axis != spec.axes.end()) return axis->values;
  if (const auto* slot = std::get_if<ParameterSlot>(&option.slot)) {
    if (spec.axes.empty()) return list_values(spec, option);
    const double value = spec.design.*slot->member;
    return std::isnan(value) ? std::vector<double>{} : std::vector{value};  // NaN: follows another
  }
  if (const auto* slot = std::get_if<SceneSlot>(&option.slot))
    return is_in_metres(spec, *slot) ? std::vector<double>{} : std::vector{spec.scene.*slot->member};
  if (const auto* slot = std::get_if<NumberSlot>(&option.slot)) return {(*slot)(spec)};
  if (const auto* slot = std::get_if<IntegerSlot>(&option.slot)) return {static_cast<double>((*slot)(spec))};
  return {};
}

std::vector<std::string> texts_of(Spec& spec, const Option& option) {
  if (const auto* slot = std::get_if<SceneSlot>(&option.slot); slot && is_in_metres(spec, *slot))
    return {fmt::format("{} m", spec.scene.clear_height)};
  if (std::holds_alternative<SpreadSlot>(option.slot)) {
    const auto spread = std::ranges::find(spec.scatter.spreads, option.key, &Spread::parameter);
    return spread == spec.scatter.spreads.end() ? std::vector<std::string>{} : std::vector{text_of(*spread)};
  }
  if (std::holds_alternative<GoalSlot>(option.slot)) {
    const auto goal = std::ranges::find(spec.goals, option.key, &Goal::field);
    return goal == spec.goals.end() ? std::vector<std::string>{} : std::vector{text_of(*goal)};
  }
  if (const auto* word = std::get_if<WordSlot>(&option.slot)) return {std::string(word->word(spec.scene))};
  if (const auto* slot = std::get_if<SwitchSlot>(&option.slot)) return {(*slot)(spec) ? "true" : "false"};
  if (const auto* slot = std::get_if<TextSlot>(&option.slot)) return {(*slot)(spec)};
  if (const auto* slot = std::get_if<TextsSlot>(&option.slot)) return (*slot)(spec);
  return {};
}

std::string told(const std::vector<double>& numbers, const std::vector<std::string>& texts) {
  if (!texts.empty() || numbers.empty())
    return texts.empty() ? "not set" : fmt::format("{}", fmt::join(texts, ", "));
  if (numbers.size() == 1) return fmt::format("{}", numbers[0]);
  return fmt::format("{} values from {} to {}", numbers.size(), numbers.front(), numbers.back());
}

/// A number of [hoop]: all values of an axis or a list's column.
std::vector<double> body_values(const Spec& spec, const std::string& key) {
  if (const Axis* axis = find_varying(spec, key)) return axis->values;
  if (const auto variable = find_variable(key, &*spec.hoop)) return {variable->of(spec.design, *spec.hoop)};
  return {spec.hoop->diameter};
}

/// The first number of [hoop] that differs.
std::optional<std::string> body_difference(const Spec& there, const Spec& here) {
  const std::vector<std::string> keys = body_keys(there);
  if (keys != body_keys(here)) return "[hoop] has other weights there than here";
  for (const std::string& key : keys) {
    const auto a = body_values(there, key), b = body_values(here, key);
    const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    if (!std::ranges::equal(a, b, same))
      return fmt::format("{} is {} there and {} here", key, told(a, {}), told(b, {}));
  }
  return {};
}

/// What maps of that minor version of the format hold by default, as if it were named.
void name_defaults(std::int64_t minor, Spec& spec) {
  if (minor >= 14) return;
  if (spec.output.fields.empty() && spec.scene.settle > 0)
    for (const Field* field : fields_of(spec.scene))
      if (field->by_default == ByDefault::stored && field->since <= minor)
        spec.output.fields.emplace_back(field->name);
  if (spec.hoop && !spec.output.gradients.empty() && spec.output.gradients_by.empty())
    for (const Option* parameter : design_parameters(spec))
      spec.output.gradients_by.emplace_back(parameter->key);
}

}  // namespace

Spec spec_of(const MapReader& map, const std::string& origin) {
  Spec spec = parse_map_spec(map.attribute("spec"), origin);
  name_defaults(hdf5::read_integers(map.file(), "version")[1], spec);
  if (!spec.axes.empty()) return spec;
  spec.list = {spec.points, {}, map.labels(), map.shape()[0]};
  const Tile all{{0}, {spec.list.count}, spec.list.count};
  std::vector<std::string> names = body_keys(spec);
  std::erase_if(names, [&](const std::string& name) { return !map.has(name); });
  const bool of_bodies = !names.empty();
  for (const Option* parameter : design_parameters()) {
    const bool follows = follows_from_body(member_of(*parameter));
    if (map.has(std::string(parameter->key)) && !(of_bodies && follows)) names.emplace_back(parameter->key);
  }
  for (const std::string& name : names) {
    hdf5::bytes_in_memory(map.open(name), fmt::format("{}: {}", origin, name));
    spec.list.columns.push_back({name, map.read(name, all)});
  }
  forget_mass_that_varies(spec);
  return spec;
}

std::optional<std::string> first_difference(const Spec& original_there, const Spec& original_here,
                                            bool only_designs) {
  Spec there = original_there, here = original_here;
  for (Spec* spec : {&there, &here}) {
    spec->numerics.method = resolved_method(*spec);
    spec->output.file.clear();
    const bool varies = !spec->points.empty() ||
                        std::ranges::find(spec->axes, "mu_static", &Axis::key) != spec->axes.end() ||
                        std::ranges::find(spec->scatter.spreads, "mu_static", &Spread::parameter) !=
                            spec->scatter.spreads.end();
    if (std::isnan(spec->design.mu_kinetic) && !varies) spec->design.mu_kinetic = spec->design.mu_static;
    spec->points.clear();  // where a list was read from does not count, only what it holds
  }
  const auto keys = [](const Spec& spec) {
    std::vector<std::string_view> names;
    for (const Axis& axis : spec.axes) names.push_back(axis.key);
    return fmt::format("{}", fmt::join(names, ", "));
  };
  if (keys(there) != keys(here))
    return fmt::format("its axes are [{}] there and [{}] here", keys(there), keys(here));
  if (const auto difference = body_difference(there, here)) return difference;
  for (const Option& option : spec_options()) {
    if (only_designs && option.section != "scene" && option.section != "design") continue;
    const auto a = numbers_of(there, option), b = numbers_of(here, option);
    const auto c = texts_of(there, option), d = texts_of(here, option);
    if (a == b && c == d) continue;
    const std::string key = fmt::format("{}.{}", option.section, option.key);
    if (a.size() != b.size() || a.size() <= 1)
      return fmt::format("{} is {} there and {} here", key, told(a, c), told(b, d));
    const auto at = std::ranges::mismatch(a, b);
    return fmt::format("value {} of {} is {} there and {} here", at.in1 - a.begin(), key, *at.in1, *at.in2);
  }
  const bool same = there.list.labels == here.list.labels;
  return same ? std::nullopt : std::optional<std::string>("the labels of its designs differ");
}

}  // namespace leapmap
