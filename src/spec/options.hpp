// SPDX-License-Identifier: GPL-3.0-or-later
/// Every key of a spec, declared once: name, meaning, unit, range, and where its value goes.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/own_units.hpp"
#include "model/parameters.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// A number that every design has of its own, so that it takes an axis or a column of a list.
struct ParameterSlot {
  double Design::*member;
};
/// A number of [hoop]; the entry's key says which.
struct HoopSlot {};
/// A number of the scene.
struct SceneSlot {
  double Scene::*member;
};
/// A word of the scene's, one of the option's choices.
struct WordSlot {
  std::string_view (*word)(const Scene&);
  void (*set)(Scene&, std::string_view word);
  bool picks_model;  ///< other keys have effects or not by it
};
/// How much a parameter differs in hoops as made: { normal = ... } or { uniform = ... }.
struct SpreadSlot {};
/// What a field of a hoop must be: { at_least = ... }, { at_most = ... }, { is = ... }.
struct GoalSlot {};
/// true or false.
using SwitchSlot = bool& (*)(Spec&);
using NumberSlot = double& (*)(Spec&);
using IntegerSlot = long& (*)(Spec&);
using TextSlot = std::string& (*)(Spec&);
using TextsSlot = std::vector<std::string>& (*)(Spec&);

struct Option {
  std::string_view section;
  std::string_view key;
  std::variant<ParameterSlot, HoopSlot, SceneSlot, WordSlot, SwitchSlot, NumberSlot, IntegerSlot, TextSlot,
               TextsSlot, SpreadSlot, GoalSlot>
      slot;
  std::string_view unit;  ///< of model/own_units.hpp; "1": a pure number
  std::string_view meaning;
  Range range{};                                    ///< numbers and integers
  std::vector<std::string_view> (*choices)() = {};  ///< texts: what is allowed; unset: anything
  OnlyOf only_of{};                                 ///< the scenes that have it
  bool (*also)(std::string_view) = {};              ///< texts that are allowed besides
  std::string_view also_told{};                     ///< those in words
};

/// The sections of a spec, in the order of the documentation.
inline constexpr std::array<std::string_view, 8> spec_sections{"scene", "hoop",   "design",  "numerics",
                                                               "gait",  "output", "scatter", "goal"};

/// All keys, in the order of the documentation.
std::span<const Option> spec_options();

/// The parameters of a design, those of spec_options that take an axis: of the hoop and its release, and of
/// its contact.
std::vector<const Option*> design_parameters();

/// The keys of a scene and of one design, each of which has a flag on leapmap hop.
std::vector<const Option*> hop_options();

/// Those parameters that matter to a spec, or that its list names.
std::vector<const Option*> design_parameters(const Spec& spec);

/// Where a design keeps what an option sets, which is a parameter of it.
inline double Design::*member_of(const Option& parameter) {
  return std::get<ParameterSlot>(parameter.slot).member;
}
/// Whether a parameter has no effect with the scene's motor_law.
inline bool is_unused_by_law(const Option& option, const Scene& scene) {
  const auto* slot = std::get_if<ParameterSlot>(&option.slot);
  return slot && is_unused_by_law(slot->member, scene);
}
/// The same of the parameter of that name.
double Design::*member_of(std::string_view parameter);

/// A design's value of one of these parameters.
inline double value_of(const Option& parameter, const Design& design) { return design.*member_of(parameter); }
/// The same where another parameter's value is used, as mu_static's for a mu_kinetic that is not given.
inline double effective_value(const Option& parameter, const Design& design) {
  const double value = value_of(parameter, design);
  return std::isnan(value) ? design.mu_static : value;
}

/// The command line's name for a key, for example "--mass-ratio".
std::string flag_of(const Option& option);

/// The option of that section and key, or nullptr; an empty section means any. What takes an axis may also
/// stand in [design], where the axes of a resolved spec do, in their order. Of "hoop.slug.mass" it is the one
/// of the mass of any weight.
const Option* find_option(std::string_view section, std::string_view key);

/// "slope must be in [0, 90 deg)" and the like: what values the option takes.
std::string allowed_values(const Option& option);

/// "'X' is unknown", with a suggestion if X resembles one of the option's choices.
std::string unknown_choice(const Option& option, std::string_view text);

/// Whether a text is one of the option's choices.
bool is_choice(const Option& option, std::string_view text);

/// True if a number is finite and inside the option's range.
bool in_range(const Option& option, double value);

/// "0.5", "30 deg", "60 mm" as a number in the option's own unit; throws InputError saying what is wrong.
double parse_number(const Option& option, std::string_view text, const Scales& scales);

/// An option's default as a spec writes it, or what it follows: "180 deg", "all", "mu_static".
std::string default_value(const Option& option);

/// The table of keys for --help: name, default, meaning, what is allowed.
std::string options_help();

}  // namespace leapmap
