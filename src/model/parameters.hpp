// SPDX-License-Identifier: GPL-3.0-or-later
/// Every number that a design or a scene has, declared once: name, meaning, unit, range, and whose it is.
/// Specs, flags, axes, entry checks, the page and Python read these rows.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// The values a number may take.
struct Range {
  double least, most;
  bool least_allowed = true, most_allowed = true;
  bool may_be_infinite = false;  ///< as its `most` is

  /// Whether a number is finite and inside.
  bool holds(double value) const;
};

/// What a scene must be to have something; what is unset may be anything.
struct OnlyOf {
  std::optional<Mechanism> model{};
  std::optional<Friction> friction{};

  constexpr OnlyOf() = default;
  constexpr OnlyOf(Friction only) : friction(only) {}
  constexpr OnlyOf(Mechanism only) : model(only) {}
  constexpr OnlyOf(Mechanism only, Friction with) : model(only), friction(with) {}
  bool holds_in(const Scene& scene) const {
    return model.value_or(scene.model) == scene.model && friction.value_or(scene.friction) == scene.friction;
  }
};

/// What both say of a scene, of which `first` holds where they differ.
constexpr OnlyOf both(OnlyOf first, const OnlyOf& second) {
  if (!first.model) first.model = second.model;
  if (!first.friction) first.friction = second.friction;
  return first;
}

/// Whether a scene has what only some have.
inline bool has(const Scene& scene, const OnlyOf& only_of) { return only_of.holds_in(scene); }

struct Parameter {
  std::string_view name;
  /// A design's own, so that it takes an axis or a column of a list; or of the scene, the same for all.
  std::variant<double Design::*, double Scene::*> member;
  std::string_view unit;  ///< of model/own_units.hpp; "1": a pure number
  std::string_view meaning;
  Range range;
  OnlyOf only_of{};         ///< the scenes that have it
  bool of_contact = false;  ///< of the contact with the plane: stands in a spec's [scene]
};

/// All of them, in the order of the documentation.
std::span<const Parameter> parameters();

/// "a number in [0, 1]" and the like.
std::string allowed_values(const Range& range, std::string_view unit, std::string_view what = "a number");

/// " (did you mean 30deg?)" if a value out of the range would be in it as degrees of an angle.
std::string meant_degrees(const Range& range, std::string_view unit, double value);

/// What is wrong with giving something that the scene's model has no effect for, and what is allowed instead.
std::string no_use(const Scene& scene, const OnlyOf& only_of);
std::string with_model(const OnlyOf& only_of);

/// Whether a value is what a parameter has unless it is given: `usual`. Of mu_kinetic that is NaN, which is
/// mu_static's.
bool is_usual(double value, double usual);

/// Throws InputError if a number of the scene is out of its range.
void check_scene(const Scene& scene);

/// Whether check_design lets the design pass.
bool is_allowed(const Design& design, const Scene& scene);

/// Throws InputError, with parameter, value and what is allowed, if a number of the design is out of its
/// range or has no effect in the scene: mu_static, say, where the contact never slips. place: in front of the
/// message.
void check_design(const Design& design, const Scene& scene, std::string_view place = {});

/// Whether a parameter of a pendulum's motor has no effect with the scene's motor_law; what is wrong then,
/// and which laws have it.
bool is_unused_by_law(double Design::*member, const Scene& scene);
std::string no_use_by_law(const Scene& scene);
std::string with_law(std::string_view parameter);

/// Throws InputError if the scene's motor_law is "angle" and the design's motor_gain is infinite.
void check_gain(const Design& design, const Scene& scene, std::string_view place = {});

}  // namespace leapmap
