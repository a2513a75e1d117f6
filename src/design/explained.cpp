// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/explained.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "film/film_angles.hpp"
#include "film/place_film.hpp"
#include "hoop/units.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "numerics/median.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"

namespace leapmap {
namespace {

/// The error that residuals are over where none is given: 1 mrad, 1 mm.
constexpr double usual_error = 1e-3;
constexpr double pi = std::numbers::pi;

FreeParameter free_parameter(std::string_view name, double low, double high) {
  return {std::string(name), *find_variable(name, nullptr), {low, high}};
}

/// The spec with the model's friction; what that model has not is as it is by default.
Spec spec_of_model(Spec spec, Friction friction) {
  constexpr Design usual;
  spec.scene.friction = friction;
  spec.axes.clear(), spec.output = {};
  for (const Parameter& parameter : parameters()) {
    if (has(spec.scene, parameter.only_of)) continue;
    if (const auto* of_design = std::get_if<double Design::*>(&parameter.member))
      spec.design.** of_design = usual.**of_design;
    else
      spec.scene.*std::get<double Scene::*>(parameter.member) =
          Scene{}.*std::get<double Scene::*>(parameter.member);
  }
  return spec;
}

/// Bounds of a parameter that is free without any: about its value, and within its range.
Side usual_bounds(const Variable& variable, double value) {
  struct Reach {
    std::string_view name;
    double low, high;
  };
  constexpr std::array reaches{Reach{"mu_static", 0.05, 1.5}, Reach{"mu_kinetic", 0.05, 1.5},
                               Reach{"restitution", 0.0, 0.9}, Reach{"resisting_torque", 0.0, 0.3}};
  for (const Reach& reach : reaches)
    if (reach.name == variable.key) return {reach.low, reach.high};
  constexpr double angle = 0.3, torque = 0.3;
  const double about = variable.unit == "rad" ? angle
                       : variable.unit == "1" ? 0.5 * std::abs(value)
                                              : torque + 0.5 * std::abs(value);
  return {std::max(value - about, variable.range.least),
          std::min(variable.unit == "1" ? 2.0 * value : value + about, variable.range.most)};
}

}  // namespace

Explained::Explained(const Measurements& measured, const Spec& spec, Friction friction,
                     std::span<const std::string> free)
    : measured_(measured), spec_(spec_of_model(spec, friction)), film_(measured.film, spec_.scene) {
  if (is_film() && spec.scene.model != Mechanism::hoop)
    throw InputError(
        fmt::format("{}: is a film, which is compared with the motion of hoops only; allowed: "
                    "events, or model = \"hoop\"",
                    measured.origin));
  for (const FreeParameter& parameter : free_parameters(spec))
    if (has(spec_.scene, parameter.variable.only_of)) free_.push_back(parameter);
  if (spec.axes.empty() && free.empty()) free_by_default();
  free_by_name(free);
  // An angle counted from a zero of its own is not known at the release either.
  if (spec.axes.empty() && is_free(measured.film, "angle_offset") &&
      std::ranges::find(free_, "release_angle", &FreeParameter::name) == free_.end())
    free_.insert(free_.begin(), release_angle_of_film());
  for (const FreeParameter& parameter : free_)
    if (parameter.variable.of_body())
      throw InputError(
          fmt::format("{}: {}: a fit frees no numbers of [hoop]; allowed: parameters of a design",
                      origin_of(spec), parameter.name));
  const bool frees_friction = std::ranges::find(free_, "mu_static", &FreeParameter::name) != free_.end();
  if (spec.axes.empty() && frees_friction && spec_.design.mu_kinetic == spec_.design.mu_static)
    spec_.design.mu_kinetic = Design{}.mu_kinetic;  // follows it
  if (is_film()) free_camera();
  if (free_.empty() && camera_.empty())
    throw InputError(fmt::format(
        "{}: no parameter of the model \"{}\" is free; allowed: for example release_angle = {{ from, to }}",
        origin_of(spec), model_of(friction).name));
  check_spec(spec_);

  for (const FreeParameter& parameter : free_) {
    problem_.bounds.push_back(parameter.side);
    by_design_.push_back(static_cast<std::size_t>(
        std::ranges::find(differentiable, parameter.variable.parameter()) - differentiable.begin()));
  }
  for (const FreeCamera& free_number : camera_) {
    problem_.bounds.push_back(free_number.side);
    by_camera_.push_back(free_number.number->member);
  }
  if (!is_film()) {
    searched_ = free_.size();
    problem_.residuals = measured.events.size();
    problem_.evaluate = [this](std::span<const double> at, std::span<double> residuals,
                               std::span<double> jacobian) {
      return event_residuals(at, residuals, jacobian);
    };
    return;
  }
  choose_numbers();
  const auto over = [this](const std::vector<std::size_t>& numbers) {
    return LeastSquares{.bounds = problem_.bounds,
                        .residuals = numbers.size(),
                        .evaluate = [this, &numbers](std::span<const double> at, std::span<double> residuals,
                                                     std::span<double> jacobian) {
                          return film_residuals(at, numbers, residuals, jacobian);
                        }};
  };
  problem_ = over(all_numbers_), small_problem_ = over(few_numbers_);
}

void Explained::free_by_default() {
  const bool slips = model_of(spec_.scene).slips;
  const Film& film = measured_.film;
  if (spec_.scene.model == Mechanism::pendulum) {
    free_ = {free_parameter("pendulum_angle", -pi, pi), free_parameter("pendulum_spin", -1.0, 1.0)};
  } else if (!is_film()) {
    free_ = {free_parameter("release_angle", 0.5 * pi, 1.95 * pi), free_parameter("release_spin", -1.0, 3.0)};
  } else if (is_free(film, "time_offset")) {
    free_ = {release_angle_of_film()};
  } else {
    const FilmAngles angles = angles_of(film, spec_.design.slope);
    const double second = time_unit(spec_.scene);
    constexpr double late = 0.3;  // sqrt(R/g): from farther off the release is not known
    const double first = observations().front().t - film.camera.time_offset;
    if (first > late * second)
      throw InputError(fmt::format(
          "{}: the film begins at t = {} s, too late to estimate the release; allowed: times counted "
          "from its first line, --free time_offset, or release_angle and release_spin with bounds, "
          "{{ from, to }}",
          measured_.origin, first));
    free_ = {release_angle_of_film()};
    if (angles.t.size() >= 3) {
      const double spin = release_of(angles, film.camera.time_offset, second).second * second;
      free_.push_back(free_parameter("release_spin", spin - 0.5, spin + 0.5));
    } else {
      free_.push_back(free_parameter("release_spin", -0.5, 1.0));
    }
  }
  if (slips) free_.push_back(free_parameter("mu_static", 0.05, 1.5));
}

FreeParameter Explained::release_angle_of_film() const {
  const Film& film = measured_.film;
  const FilmAngles angles = angles_of(film, spec_.design.slope);
  constexpr double about = 0.3;
  if (angles.t.size() < 3 || is_free(film, "angle_offset"))
    return free_parameter("release_angle", 0.5 * pi, 1.95 * pi);
  double at = release_of(angles, film.camera.time_offset, time_unit(spec_.scene)).first;
  if (is_free(film, "time_offset")) {
    std::vector<double> held;
    for (std::size_t i = 0; i < angles.t.size() && (i < 3 || angles.t[i] < film.camera.time_offset); ++i)
      held.push_back(angles.phi[i]);
    at = median(std::move(held));
  }
  return free_parameter("release_angle", at - about, at + about);
}

void Explained::free_by_name(std::span<const std::string> names) {
  const std::size_t first = free_.size();
  for (const std::string& name : names) {
    const std::optional<Variable> variable = find_variable(name, spec_.hoop ? &*spec_.hoop : nullptr);
    if (!variable) refuse_free_name(name);
    const bool there = std::ranges::find(free_, name, &FreeParameter::name) != free_.end();
    if (there || variable->of_body() || !has(spec_.scene, variable->only_of)) continue;
    if (name == "release_angle" && is_film())
      free_.push_back(release_angle_of_film());
    else if (name == "release_angle")
      free_.push_back(free_parameter(name, 0.5 * pi, 1.95 * pi));
    else if (name == "release_spin")
      free_.push_back(free_parameter(name, -1.0, 3.0));
    else {
      const Side side = usual_bounds(*variable, spec_.design.*variable->parameter());
      if (!(side.low < side.high))
        throw InputError(
            fmt::format("--free {}: has no usual bounds about {}; allowed: --set '{}={{from=...,to=...}}'",
                        name, spec_.design.*variable->parameter(), name));
      free_.push_back({name, *variable, side});
    }
  }
  std::ranges::sort(free_.begin() + static_cast<std::ptrdiff_t>(first), free_.end(), {},
                    [](const FreeParameter& one) { return one.variable.order; });
}

void Explained::free_camera() {
  const Film& film = measured_.film;
  const double second = time_unit(spec_.scene), R = spec_.scene.radius;
  const auto bounds_of = [&](const CameraNumber& number) -> Side {
    const double value = film.camera.*number.member;
    if (number.member == &Camera::time_offset) return {value - 5.0 * second, value + 0.3 * second};
    if (number.member == &Camera::scale) return {0.5 * value, 2.0 * value};
    if (number.member == &Camera::tilt) return {value - 0.7, value + 0.7};
    if (number.member == &Camera::angle_offset) {
      const double first = film.phi.empty() ? 0.0 : film.phi.front();
      return {-3.0 * pi - first, 5.0 * pi - first};
    }
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Observation& one : observations())
      if (is_position(one.kind)) low = std::min(low, one.value), high = std::max(high, one.value);
    const double reach = high - low + 20.0 * R / film.camera.scale;
    return {low - reach, high + reach};
  };
  for (const bool linear : {false, true}) {
    for (const CameraNumber& number : camera_numbers) {
      const bool is_origin = number.unit.empty();
      const bool free = is_origin ? !film.tracks.empty() : is_free(film, number.name);
      if (free && number.is_linear == linear) camera_.push_back({&number, bounds_of(number)});
    }
    if (!linear) searched_ = free_.size() + camera_.size();
  }
}

void Explained::choose_numbers() {
  constexpr std::size_t few = 40;
  const std::vector<Observation>& all = observations();
  all_numbers_.resize(all.size());
  std::iota(all_numbers_.begin(), all_numbers_.end(), std::size_t{0});
  std::size_t times = 0;
  for (std::size_t i = 0; i < all.size(); ++i) times += i == 0 || all[i].t > all[i - 1].t;
  const std::size_t every = (times + few - 1) / few;
  for (std::size_t i = 0, time = 0; i < all.size(); ++i) {
    time += i > 0 && all[i].t > all[i - 1].t;
    if (time % every == 0) few_numbers_.push_back(i);
  }
  const Film& film = measured_.film;
  const bool has_angles = !film.phi.empty(), has_spins = !film.spin.empty();
  constexpr double least = 1e-6;
  const double usual_angle = has_spins ? std::max(scatter_of(all, Measured::angle), least) : usual_error;
  errors_ = {errors_known() && has_angles ? film.error : usual_angle,
             std::max(scatter_of(all, Measured::spin), least),
             errors_known() ? film.error : usual_error / film.camera.scale};
  for (double& error : errors_)
    if (!(error > 0.0)) error = usual_error;  // too few numbers to know their scatter
}

Design Explained::design_at(std::span<const double> at) const {
  Design design = spec_.design;
  for (std::size_t k = 0; k < free_.size(); ++k) design.*free_[k].variable.parameter() = at[k];
  return design;
}

Camera Explained::camera_at(std::span<const double> at) const {
  Camera camera = measured_.film.camera;
  for (std::size_t k = free_.size(); k < at.size(); ++k) camera.*by_camera_[k - free_.size()] = at[k];
  return camera;
}

bool Explained::errors_known() const { return !is_film() || !std::isnan(measured_.film.error); }

double Explained::error_of(std::size_t number) const {
  if (!is_film()) return measured_.events[number].error;
  const Measured kind = observations()[number].kind;
  return errors_[kind == Measured::angle ? 0 : kind == Measured::spin ? 1 : 2];
}

double Explained::measured_at(std::size_t number) const {
  return is_film() ? observations()[number].value : measured_.events[number].value;
}

std::vector<double> Explained::model_at(std::span<const double> residuals) const {
  std::vector<double> model;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    model.push_back(measured_at(i) + residuals[i] * error_of(i));
  return model;
}

bool Explained::film_residuals(std::span<const double> at, std::span<const std::size_t> numbers,
                               std::span<double> residuals, std::span<double> jacobian) const {
  if (!film_.residuals(design_at(at), camera_at(at), {numbers, by_design_, by_camera_}, residuals, jacobian))
    return false;
  const std::size_t columns = problem_.bounds.size();
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] /= error_of(numbers[i]);
  for (std::size_t i = 0; i < jacobian.size(); ++i) jacobian[i] /= error_of(numbers[i / columns]);
  return true;
}

template <class F>
auto Explained::with_event_solver(bool derivatives, const F& f) const {
  const auto make = [&] {
    Request request = request_of_outcomes(spec_);
    if (derivatives) {
      std::vector<OutcomeNumber> of;
      for (const MeasuredEvent& event : measured_.events)
        if (const OutcomeNumber each = *number_of(*find_field(event.field));
            std::ranges::find(of, each) == of.end())
          of.push_back(each);
      std::vector<std::string> by;
      for (const FreeParameter& parameter : free_) by.push_back(parameter.name);
      std::ranges::copy(derivative_columns(scene(), of, by), std::back_inserter(request.columns));
    }
    return EventSolver{make_gradient_solver(request), Gradients(derivatives_of(request))};
  };
  return event_solvers_[derivatives ? 1 : 0].with(make, f);
}

/// Of a model without derivatives: by central differences, good to some 1e-6. That is enough for steps
/// towards the least sum of squares; where it lies does not depend on them.
bool Explained::event_differences(std::span<const double> at, std::span<double> residuals,
                                  std::span<double> jacobian) const {
  if (!event_residuals(at, residuals, {})) return false;
  std::vector<double> moved(at.begin(), at.end()), below(residuals.size()), above(residuals.size());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const double h = 1e-4 * std::max(1.0, std::abs(at[k]));
    const double low = std::max(at[k] - h, problem_.bounds[k].low),
                 high = std::min(at[k] + h, problem_.bounds[k].high);
    moved[k] = low;
    const bool has_low = event_residuals(moved, below, {});
    moved[k] = high;
    if (!has_low || !event_residuals(moved, above, {})) return false;
    moved[k] = at[k];
    for (std::size_t i = 0; i < residuals.size(); ++i)
      jacobian[i * free_.size() + k] = (above[i] - below[i]) / (high - low);
  }
  return true;
}

bool Explained::event_residuals(std::span<const double> at, std::span<double> asked,
                                std::span<double> jacobian) const {
  std::vector<double> unasked(asked.empty() ? measured_.events.size() : 0);
  const std::span<double> residuals = asked.empty() ? std::span(unasked) : asked;
  if (!jacobian.empty() && !model_of(spec_.scene).gradients)
    return event_differences(at, residuals, jacobian);
  const Design design = design_at(at);
  return with_event_solver(!jacobian.empty(), [&](EventSolver& solver) {
    Outcome outcome;
    solver.solve({&design, 1}, {&outcome, 1}, solver.gradients);
    for (std::size_t i = 0; i < measured_.events.size(); ++i) {
      const MeasuredEvent& event = measured_.events[i];
      const auto member = std::get<Quantity>(find_field(event.field)->source).member;
      residuals[i] = (outcome.*member - event.value) / event.error;
      if (!std::isfinite(residuals[i])) return false;
      for (std::size_t k = 0; k < free_.size() && !jacobian.empty(); ++k) {
        const double by = solver.gradients.column(member, free_[k].variable.parameter())[0];
        if (!std::isfinite(by)) return false;
        jacobian[i * free_.size() + k] = by / event.error;
      }
    }
    return true;
  });
}

std::vector<double> Explained::with_camera(std::span<const double> at) const {
  std::vector<double> whole(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(searched_));
  if (!is_film()) return whole;
  Camera camera = camera_at(whole);
  std::vector<double> residuals(few_numbers_.size());
  film_.residuals_with_camera(design_at(whole), camera, by_camera_, few_numbers_, residuals);
  for (std::size_t k = searched_; k < problem_.bounds.size(); ++k) {
    const Side& side = problem_.bounds[k];
    whole.push_back(std::clamp(camera.*by_camera_[k - free_.size()], side.low, side.high));
  }
  return whole;
}

void Explained::coarse_sums(std::span<const std::vector<double>> places, std::span<double> sums) const {
  std::ranges::fill(sums, HUGE_VAL);
  if (is_film()) {
    std::vector<double> residuals(few_numbers_.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      Camera camera = camera_at(places[i]);
      if (!film_.residuals_with_camera(design_at(places[i]), camera, by_camera_, few_numbers_, residuals))
        continue;
      sums[i] = 0.0;
      for (std::size_t k = 0; k < residuals.size(); ++k) {
        const double over_error = residuals[k] / error_of(few_numbers_[k]);
        sums[i] += over_error * over_error;
      }
    }
    return;
  }
  std::vector<Design> designs;
  for (const std::vector<double>& place : places) designs.push_back(design_at(place));
  std::vector<Outcome> outcomes(designs.size());
  with_event_solver(false, [&](EventSolver& solver) { solver.solve(designs, outcomes, solver.gradients); });
  for (std::size_t i = 0; i < places.size(); ++i) {
    double sum = 0.0;
    for (const MeasuredEvent& event : measured_.events) {
      const auto member = std::get<Quantity>(find_field(event.field)->source).member;
      const double residual = (outcomes[i].*member - event.value) / event.error;
      sum += residual * residual;
    }
    if (std::isfinite(sum)) sums[i] = sum;
  }
}

}  // namespace leapmap
