// SPDX-License-Identifier: GPL-3.0-or-later
/// What a model is, and the list of them. A new one is a folder beside rolling and coulomb, and a row of the
/// list; nothing else asks which model a scene names.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "leapmap/motion.hpp"
#include "leapmap/scene.hpp"
#include "trajectory/gradient.hpp"
#include "trajectory/motion_at.hpp"
#include "trajectory/sequence_gradient.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// What it takes to solve a design, in units of its model's own: counted, so that every machine finds the
/// same.
using DesignEffort = std::function<double(const Design&)>;

/// How designs of a scene are solved: each of these takes the scene it was chosen for. What a model cannot do
/// is null; who needs it asks by `need`.
struct Model {
  Friction friction;
  std::string_view name;     ///< in specs: the value of scene.friction
  std::string_view meaning;  ///< in a few words
  bool slips;  ///< goes through phases of contact, each with roundings of its own, and loses energy
  /// Without an integrator, to a relative tolerance of times.
  Solver (*exact)(const Scene&, double tolerance, const Wanted&);
  /// The same from any state to the landing of the next jump.
  JumpSolver<double> (*jumps)(const Scene&, double tolerance, const Wanted&);
  /// The same with derivatives.
  GradientSolver (*gradients)(const Scene&, double tolerance, const Wanted&, const GradientWanted&);
  /// One jump after the other, by parameters; and by the state that it begins at.
  DualJumpSolver<DesignDual> (*dual_jumps)(const Scene&, double tolerance);
  DualJumpSolver<StateDual> (*state_jumps)(const Scene&, double tolerance);
  /// By integration in time.
  Solver (*integration)(const Scene&, const IntegrationOptions&);
  /// The same from any state to the landing of the next jump.
  JumpSolver<double> (*integrated_jumps)(const Scene&, const IntegrationOptions&);
  /// By the exact solver in long double.
  Outcome (*refined)(const Design&, const Scene&);
  /// One design's motion, sampled every `interval` [s]; 0: not sampled.
  Motion (*tell_exactly)(const Design&, const Scene&, double tolerance, double interval);
  /// The same at given times.
  MotionsAtTimes at_times;
  Motion (*tell_by_integration)(const Design&, const Scene&, const IntegrationOptions&, double interval);
  /// By a method at a setting, for studies.
  Solving (*solving)(const Contestant&, const Scene&, long max_steps);
  /// By the exact solver; with derivatives of what it finds, or without.
  DesignEffort (*effort)(const Scene&, bool derivatives);
  /// As `jumps`, and tells what the way to each jump asks of hoop and motor.
  JumpSolver<double> (*ways)(const Scene&, double tolerance);
  /// As `jumps`, from landing to landing; null: in rounds.
  LongJumpSolver<double> (*long_jumps)(const Scene&, double tolerance, const Wanted&) = nullptr;
  Mechanism mechanism = Mechanism::hoop;  ///< in specs: the value of scene.model
  std::string_view stepper{};             ///< with which method = "auto" integrates; empty: it is "exact"
};

/// The names of mechanisms and of laws in specs, in the order of their enumerations.
inline constexpr std::array<std::string_view, 2> mechanism_names{"hoop", "pendulum"};
inline constexpr std::array<std::string_view, 5> motor_law_names{"constant", "until_angle", "until_speed",
                                                                 "speed", "angle"};
constexpr std::string_view name_of(Mechanism model) {
  return mechanism_names[static_cast<std::size_t>(model)];
}
constexpr std::string_view name_of(MotorLaw law) { return motor_law_names[static_cast<std::size_t>(law)]; }

/// The built-in models.
std::span<const Model> models();

/// Adds a model for the rest of the program; its friction and its name must be its own. Not while designs are
/// solved. `name` and `meaning` must live as long as the program.
void add_model(const Model& model);

/// Any model, built in or added; nullptr: none has that name.
const Model* find_model(std::string_view name);
std::vector<std::string_view> model_names();

const Model& model_of(const Scene& scene);
/// Of a hoop.
inline const Model& model_of(Friction friction) { return model_of(Scene{.friction = friction}); }

/// Throws InputError: the model has no such thing, for example "derivatives".
[[noreturn]] void refuse_lack(const Model& model, std::string_view what);

/// What a caller cannot do without. Throws InputError if the model lacks it.
template <class Capability>
Capability need(const Model& model, Capability Model::*capability, std::string_view what) {
  if (!(model.*capability)) refuse_lack(model, what);
  return model.*capability;
}

/// More steps than any integration needs that gets anywhere: a long run takes a million; a slide near
/// Painleve's edge would take any number.
inline long most_steps(const Scene& scene) { return model_of(scene).slips ? 100'000 : 1'000'000; }

}  // namespace leapmap
