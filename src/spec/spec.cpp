// SPDX-License-Identifier: GPL-3.0-or-later
#include "spec/spec.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>

#include "leapmap/errors.hpp"
#include "map/schema.hpp"
#include "model/model.hpp"
#include "model/variable.hpp"
#include "spec/point_list.hpp"
#include "spec/spec_entry.hpp"
#include "spec/spec_hoop.hpp"
#include "spec/spec_keys.hpp"
#include "support/csv.hpp"
#include "support/posix.hpp"

namespace leapmap {
namespace {

/// Puts one key's value where its option says.
struct Assign {
  const Entry& entry;
  Spec& spec;

  void operator()(const ParameterSlot& slot) const {
    if (const toml::table* table = entry.node->as_table()) {
      spec.axes.push_back(to_axis(entry, *table));
    } else {
      spec.design.*slot.member = to_number(entry, *entry.node);
    }
  }
  void operator()(HoopSlot) const { assign_to_hoop(entry, spec); }
  void operator()(SceneSlot slot) const {
    if (slot.member == &Scene::clear_height)
      if (const auto metres = to_si(entry, *entry.node)) {
        if (!in_range(*entry.option, *metres))
          refuse(entry, "is out of range", allowed_values(*entry.option));
        spec.scene.clear_height = *metres, spec.scene.clear_height_in_metres = true;
        return;
      }
    spec.scene.*slot.member = one_number();
  }
  void operator()(NumberSlot slot) const { slot(spec) = one_number(); }
  void operator()(WordSlot slot) const { slot.set(spec.scene, text(*entry.node)); }
  void operator()(SwitchSlot slot) const {
    const toml::value<bool>* value = entry.node->as_boolean();
    if (!value) refuse(entry, "is not true or false", allowed_values(*entry.option));
    slot(spec) = value->get();
  }
  void operator()(IntegerSlot slot) const {
    const auto value = to_whole(*entry.node);
    if (!value) refuse(entry, "is not a whole number", allowed_values(*entry.option));
    if (!in_range(*entry.option, static_cast<double>(*value)))
      refuse(entry, "is out of range", allowed_values(*entry.option));
    slot(spec) = *value;
  }
  void operator()(SpreadSlot) const { spec.scatter.spreads.push_back(to_spread(entry)); }
  void operator()(GoalSlot) const { spec.goals.push_back(to_goal(entry)); }
  void operator()(TextSlot slot) const { slot(spec) = text(*entry.node); }
  void operator()(TextsSlot slot) const {
    if (entry.node->is_string()) {  // a list of one
      slot(spec) = {text(*entry.node)};
      return;
    }
    const toml::array* array = entry.node->as_array();
    if (!array || array->empty())
      refuse(entry, "is not a list of names", "a list with " + allowed_values(*entry.option));
    slot(spec).clear();
    for (const toml::node& node : *array) {
      const std::string name = text(node);
      if (std::ranges::find(slot(spec), name) != slot(spec).end())
        refuse(entry, fmt::format("'{}' appears twice", name), "each once");
      slot(spec).push_back(name);
    }
  }
  double one_number() const {
    if (entry.node->is_table()) refuse(entry, "takes no axis", allowed_values(*entry.option));
    return to_number(entry, *entry.node);
  }
  std::string text(const toml::node& node) const {
    const toml::value<std::string>* value = node.as_string();
    if (!value) refuse(entry, "is not a string", allowed_values(*entry.option));
    if (entry.option->choices) {
      if (!is_choice(*entry.option, value->get()))
        refuse(entry, unknown_choice(*entry.option, value->get()), allowed_values(*entry.option));
    }
    return value->get();
  }
};

/// Whether a key says no more than its default.
bool is_default(const Option& option, const Entry& entry) {
  if (const auto* word = std::get_if<WordSlot>(&option.slot))
    return entry.node->value<std::string>() == std::string(word->word(Scene{}));
  const auto value = entry.node->value<double>();
  const auto* of_scene = std::get_if<SceneSlot>(&option.slot);
  const auto* of_design = std::get_if<ParameterSlot>(&option.slot);
  if (!value || (!of_scene && !of_design)) return false;
  return is_usual(*value, of_scene ? Scene{}.*of_scene->member : Design{}.*of_design->member);
}

/// Puts the default in place of a number or word of the file, so that models can be compared on one file.
/// False: it is no number of the file.
bool leave_out(const Entry& entry, Spec& spec) {
  const bool of_file = entry.place != command_line && !entry.node->is_table();
  if (const auto* of_design = std::get_if<ParameterSlot>(&entry.option->slot); of_design && of_file)
    spec.design.*of_design->member = Design{}.*of_design->member;
  else if (const auto* of_scene = std::get_if<SceneSlot>(&entry.option->slot); of_scene && of_file)
    spec.scene.*of_scene->member = Scene{}.*of_scene->member;
  else if (const auto* word = std::get_if<WordSlot>(&entry.option->slot); word && of_file)
    word->set(spec.scene, word->word(Scene{}));
  else
    return false;
  return true;
}

/// Nothing given is ignored without a word. A file may spell defaults out.
void refuse_what_has_no_use(const std::vector<Entry>& entries, Spec& spec) {
  const bool chosen = std::ranges::any_of(entries, [](const Entry& entry) {
    const auto* word = std::get_if<WordSlot>(&entry.option->slot);
    return entry.place == command_line && word && word->picks_model;
  });
  std::vector<std::string_view> left_out;
  std::string why;
  for (const Entry& entry : entries) {
    const Option& option = *entry.option;
    if (is_unused_by_law(option, spec.scene) && !entry.node->is_table() && !is_default(option, entry))
      refuse(entry, no_use_by_law(spec.scene), with_law(entry.key));
    if (has(spec.scene, option.only_of) || (entry.place != command_line && is_default(option, entry)))
      continue;
    if (!chosen || !leave_out(entry, spec))
      refuse(entry, no_use(spec.scene, option.only_of), with_model(option.only_of));
    why = no_use(spec.scene, option.only_of);
    left_out.push_back(entry.key);
  }
  constexpr std::string_view begins = "has no effect because ";
  if (!left_out.empty())
    spec.notes.push_back(fmt::format("{}: not used, because {}: {}", origin_of(spec),
                                     why.substr(begins.size()), fmt::join(left_out, ", ")));
}

/// What [hoop] determines is given once.
void refuse_beside_hoop(const std::vector<Entry>& entries) {
  for (const Entry& entry : entries)
    for (const std::string_view key : {"mass_ratio", "offset_ratio", "inertia_factor", "radius", "mass"})
      if (entry.key == key && !std::holds_alternative<SpreadSlot>(entry.option->slot))
        refuse(entry, "[hoop] determines it already", "one of the two: remove the other");
}

/// The design, the size and the mass of the nominal body. Where masses vary, the total is not known.
void apply_hoop(Spec& spec) {
  apply_body(reduce_body(*spec.hoop), *spec.hoop, spec.design, spec.scene);
  forget_mass_that_varies(spec);
}

/// As they were written, or as output.order says.
void put_axes_in_order(const std::vector<Entry>& entries, Spec& spec) {
  const std::vector<std::string>& order = spec.output.order;
  const auto place_of = [&](const Axis& axis) {
    if (!order.empty()) return std::ranges::find(order, axis.key) - order.begin();
    return std::ranges::find_if(entries,
                                [&](const Entry& entry) {
                                  return entry.key == axis.key &&
                                         !std::holds_alternative<SpreadSlot>(entry.option->slot);
                                }) -
           entries.begin();
  };
  std::ranges::stable_sort(spec.axes, {}, place_of);
}

/// A points file is looked for beside the spec first, then from the working folder.
std::string find_points(const Spec& spec) {
  namespace fs = std::filesystem;
  const fs::path beside = fs::path(spec.origin).parent_path() / spec.points;
  std::error_code ignored;
  return fs::exists(beside, ignored) ? beside.string() : spec.points;
}

}  // namespace

std::string origin_of(const Spec& spec) { return spec.origin.empty() ? "command line" : spec.origin; }

void read_points_of(Spec& spec) {
  if (spec.points.empty()) return;
  spec.points =
      std::filesystem::absolute(find_points(spec)).string();  // so that the resolved spec holds anywhere
  std::vector<std::string> in_si;
  spec.list = read_points(spec.points, origin_of(spec), common_scales(spec),
                          spec.hoop ? std::optional(nominal_scales(spec)) : std::nullopt, in_si);
  for (const std::string& name : in_si) hold(name, spec);
  for (const Axis& column : spec.list.columns) {
    if (find_body_number(column.key)) continue;  // check_hoop's
    const Option& option = *find_option("design", column.key);
    if (!has(spec.scene, option.only_of))
      throw InputError(fmt::format("{}: column '{}': {}; allowed: {}", spec.points, column.key,
                                   no_use(spec.scene, option.only_of), with_model(option.only_of)));
    if (spec.hoop && follows_from_body(member_of(option)))
      throw InputError(
          fmt::format("{}: column '{}': has no effect, because [hoop] in {} gives it; allowed: "
                      "without the column, or without [hoop]",
                      spec.points, column.key, origin_of(spec)));
    if (const double given = value_of(option, spec.design);
        !is_usual(given, value_of(option, Design{})) && !std::isnan(given))
      throw InputError(fmt::format(
          "{}: {} = {} has no effect beside the column of that name in {}; allowed: without that key, or "
          "without the column",
          origin_of(spec), column.key, given, spec.points));
  }
  check_hoop(spec);
  if (spec.hoop) apply_hoop(spec);
}

namespace {

/// A million values of an axis are some 25 MB.
std::string text_of_spec(const std::string& path) {
  constexpr std::string_view allowed = "a spec in TOML";
  TextFile file(path, allowed, std::size_t{1} << 26);
  refuse_other_form(path, file.peek(4096), allowed);
  return file.rest();
}

}  // namespace

Spec read_spec(const std::string& path, const std::vector<std::string>& overrides) {
  Spec spec = parse_spec(path.empty() ? "" : text_of_spec(path), path, overrides);
  read_points_of(spec);
  return spec;
}

namespace {

/// Whether units of other numbers depend on an entry: radius, gravity, mass, [hoop].
bool sets_scale(const Entry& entry) {
  const auto* slot = std::get_if<SceneSlot>(&entry.option->slot);
  return std::holds_alternative<HoopSlot>(entry.option->slot) ||
         (slot && (slot->member == &Scene::radius || slot->member == &Scene::gravity ||
                   slot->member == &Scene::mass));
}

constexpr std::string_view nominal_units = "nominal_units";

/// Fills in spec.nominal_units: what is named there, and what is given with a unit of the SI.
void fill_nominal_units(const std::vector<Entry>& entries, Spec& spec) {
  for (const Entry& entry : entries) {
    if (entry.key != nominal_units) continue;
    if (!spec.hoop) refuse(entry, "has no effect, because there is no [hoop]", "with [hoop] in the spec");
    std::visit(Assign{entry, spec}, entry.option->slot);
  }
  if (!spec.hoop) return;
  for (const Entry& entry : entries)
    if (const auto* slot = std::get_if<ParameterSlot>(&entry.option->slot))
      if (may_be_held(slot->member) && has_unit(entry)) hold(entry.key, spec);
  // A tolerance with a unit of what is not given: around 0, which is the same in every unit.
  for (const Entry& entry : entries) {
    if (!std::holds_alternative<SpreadSlot>(entry.option->slot) || find_body_number(entry.key)) continue;
    const bool given = std::ranges::any_of(entries, [&](const Entry& other) {
      return other.key == entry.key && std::holds_alternative<ParameterSlot>(other.option->slot);
    });
    if (!given && may_be_held(member_of(entry.key)) && has_unit(entry)) hold(entry.key, spec);
  }
}

/// Puts every entry's value where it belongs. of_map: a resolved spec has units only where hoops differ in
/// size or mass, as those of a list may whose numbers stand in the map alone.
void assign(std::vector<Entry>& entries, Spec& spec, bool of_map) {
  for (const Entry& entry : entries)
    if (sets_scale(entry)) std::visit(Assign{entry, spec}, entry.option->slot);
  if (spec.hoop) {
    refuse_beside_hoop(entries);
    check_hoop(spec);
    apply_hoop(spec);
    if (!of_map) std::ranges::move(doubts_of_hoop(spec), std::back_inserter(spec.notes));
  }
  fill_nominal_units(entries, spec);
  const auto any = [&](const auto& holds) { return std::ranges::any_of(entries, holds); };
  // Manufactured hoops differ in mass or size, and the designs of a list may: none is right for all of them.
  const bool made = any([](const Entry& entry) {
    return std::holds_alternative<SpreadSlot>(entry.option->slot) && is_body_mass(entry.key);
  });
  const bool sized = any([](const Entry& entry) {
    return std::holds_alternative<SpreadSlot>(entry.option->slot) && entry.key == "hoop.diameter";
  });
  const bool listed =
      spec.hoop && (of_map || any([](const Entry& entry) { return entry.option->key == "points"; }));
  for (Entry& entry : entries) {
    if (sets_scale(entry) || entry.key == nominal_units) continue;
    entry.scales = common_scales(spec);
    entry.nominal = nominal_scales(spec);
    const bool of_made = std::holds_alternative<GoalSlot>(entry.option->slot) ||
                         std::holds_alternative<SceneSlot>(entry.option->slot);
    if (listed || (made && of_made)) entry.scales.mass = 0.0;
    if (listed || (sized && of_made)) entry.scales.radius = std::numeric_limits<double>::quiet_NaN();
    if (is_held(spec, entry.key)) entry.scales = entry.nominal;
    std::visit(Assign{entry, spec}, entry.option->slot);
  }
  put_axes_in_order(entries, spec);
}

/// Defaults that hang on what is given.
void set_defaults(const std::vector<Entry>& entries, bool asks_for_gaits, Spec& spec) {
  const auto given = [&](std::string_view key, bool scattered = false) {
    return std::ranges::any_of(entries, [&](const Entry& e) {
      return e.key == key && std::holds_alternative<SpreadSlot>(e.option->slot) == scattered;
    });
  };
  if (asks_for_gaits && !given("settle")) spec.scene.settle = 500;
  // Where mu_static varies, mu_kinetic follows it from design to design.
  const bool varies = std::ranges::find(spec.axes, "mu_static", &Axis::key) != spec.axes.end() ||
                      !spec.points.empty() || given("mu_static", true);
  if (!given("mu_kinetic") && !varies) spec.design.mu_kinetic = spec.design.mu_static;
  // What an audit states hangs on how many designs it looks at, not on their share of the map.
  constexpr double enough = 400.0;
  double designs = 1.0;
  for (const Axis& axis : spec.axes) designs *= static_cast<double>(axis.values.size());
  if (!given("audit")) spec.numerics.audit = std::min(spec.numerics.audit, enough / designs);
}

/// Keys that contradict each other.
void refuse_contradictions(const std::vector<Entry>& entries, const Spec& spec) {
  for (const Entry& entry : entries) {
    const std::string_view key = entry.option->key;
    if (entry.option->section == "scatter" && spec.scatter.spreads.empty())
      refuse(entry, "has no effect without tolerances",
             "with a parameter in [scatter], for example slope = { normal = \"1 deg\" }");
    if (key == "interpolate" && !model_of(spec.scene).slips)
      refuse(entry, "has no effect without friction: every hoop is solved", "with friction = \"coulomb\"");
    const double set = key == "fixed_step"           ? spec.numerics.fixed_step
                       : key == "absolute_tolerance" ? spec.numerics.absolute_tolerance
                                                     : 0.0;
    if (set > 0.0 && resolved_method(spec) == "exact")
      refuse(entry, fmt::format("method \"{}\" takes no steps", spec.numerics.method),
             "with method = \"gsl-...\"");
  }
  if (spec.hoop && spec.scene.model != Mechanism::hoop) refuse_drawing(spec);
  if (std::ranges::find(spec.axes, "motor_gain", &Axis::key) == spec.axes.end() && spec.points.empty())
    check_gain(spec.design, spec.scene, origin_of(spec));
  if (!spec.points.empty() && !spec.axes.empty())
    throw InputError(
        fmt::format("{}: design.points and an axis ({}) exclude each other; allowed: one of them",
                    origin_of(spec), spec.axes.front().key));
  double designs = 1.0;
  for (const Axis& axis : spec.axes) designs *= static_cast<double>(axis.values.size());
  if (designs > most_designs)
    throw InputError(
        fmt::format("{}: {:.3g} designs; allowed: at most {:.0e}", origin_of(spec), designs, most_designs));
}

/// A line by its number, from 1.
std::string_view line_of(std::string_view text, std::size_t number) {
  for (std::size_t k = 1; k < number && !text.empty(); ++k)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text.substr(0, text.find('\n'));
}

/// lenient: what has no effect is let pass.
Spec parse(std::string_view text, const std::string& origin, const std::vector<std::string>& overrides,
           bool lenient) {
  Spec spec;
  spec.origin = origin;
  toml::table file;
  try {
    file = toml::parse(text);
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    throw InputError(fmt::format("{}:{}: not TOML: {}{}", origin, line, error.description(),
                                 hint_of_quotes(line_of(text, line))));
  }
  std::vector<Entry> entries = entries_of(file, origin, spec);
  std::vector<toml::table> values;
  add_overrides(overrides, spec, values, entries);
  assign(entries, spec, lenient);
  const bool asks_for_gaits = file.contains("gait") || std::ranges::any_of(entries, [](const Entry& e) {
                                return e.option->section == "gait";
                              });
  if (!lenient) refuse_what_has_no_use(entries, spec);
  set_defaults(entries, asks_for_gaits, spec);
  refuse_contradictions(entries, spec);
  // Before format 1.13 a resolved spec did not say so: motors idled.
  if (lenient && std::ranges::find(entries, "motor_in_flight", &Entry::key) == entries.end())
    spec.scene.motor_in_flight = false;
  // Before 1.19 every hoop was solved.
  if (lenient && !spec.scatter.spreads.empty() && model_of(spec.scene).slips &&
      std::ranges::find(entries, "interpolate", &Entry::key) == entries.end())
    spec.scatter.interpolate = false;
  return spec;
}

}  // namespace

Spec parse_spec(std::string_view text, const std::string& origin, const std::vector<std::string>& overrides) {
  return parse(text, origin, overrides, false);
}

Spec parse_map_spec(std::string_view text, const std::string& origin) {
  return parse(text, origin, {}, true);
}

}  // namespace leapmap
