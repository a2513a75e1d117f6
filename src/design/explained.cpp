// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/explained.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "design/motion_at.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "physics/rolling.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"

namespace leapmap {
namespace {

/// The error that residuals are over where nobody told one: 1 mrad, 1 mm.
constexpr double usual_error = 1e-3;

FreeParameter free_parameter(std::string_view name, double low, double high) {
  return {std::string(name), *find_variable(name, nullptr), {low, high}};
}

/// Angles of a film, going on over turns.
std::vector<double> angles_of(const Film& film) {
  if (!film.phi.empty()) return film.phi;
  const auto& [x_P, y_P, x_O, y_O] = film.markers;
  std::vector<double> angles;
  for (std::size_t i = 0; i < x_P.size(); ++i) {
    const double angle = std::atan2(x_O[i] - x_P[i], y_O[i] - y_P[i]), turn = 2.0 * std::numbers::pi;
    angles.push_back(i == 0 ? angle - turn * std::floor(angle / turn)
                            : angle + turn * std::round((angles.back() - angle) / turn));
  }
  return angles;
}

/// Angle and spin [rad/s] at the release, by the cubic that fits a film's beginning best: so long that noise
/// of a frame counts little, so short that it holds.
std::pair<double, double> begin_of(const Film& film, double second) {
  constexpr double long_enough = 1.5;  // in sqrt(R/g)
  const std::vector<double> angles = angles_of(film);
  std::size_t some = 0;
  while (some < film.t.size() && film.t[some] <= film.t[0] + long_enough * second) ++some;
  some = std::clamp<std::size_t>(some, 3, film.t.size());
  const auto rows = static_cast<Eigen::Index>(some);
  const Eigen::Index columns = std::min<Eigen::Index>(4, rows);
  Eigen::MatrixXd powers(rows, columns);
  Eigen::VectorXd measured(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double t = film.t[static_cast<std::size_t>(i)] / second;
    for (Eigen::Index k = 0; k < columns; ++k) powers(i, k) = std::pow(t, static_cast<double>(k));
    measured[i] = angles[static_cast<std::size_t>(i)];
  }
  const Eigen::VectorXd cubic = powers.colPivHouseholderQr().solve(measured);
  return {cubic[0], cubic[1] / second};
}

}  // namespace

Explained::Explained(const Measurements& measured, const Spec& spec, Friction friction)
    : measured_(measured), spec_(spec) {
  spec_.scene.friction = friction;
  spec_.axes.clear(), spec_.output = {};
  std::vector<FreeParameter> asked = free_parameters(spec);
  constexpr Design usual;
  for (const Parameter& parameter : parameters()) {  // what the model has not is as it is by default
    if (has(friction, parameter.only_of)) continue;
    if (const auto* of_design = std::get_if<double Design::*>(&parameter.member))
      spec_.design.** of_design = usual.**of_design;
    else
      spec_.scene.*std::get<double Scene::*>(parameter.member) =
          Scene{}.*std::get<double Scene::*>(parameter.member);
    std::erase_if(asked, [&](const FreeParameter& one) { return one.name == parameter.name; });
  }
  free_ = std::move(asked);
  for (const FreeParameter& parameter : free_)
    if (parameter.variable.of_body())
      throw InputError(
          fmt::format("{}: {}: a fit frees no numbers of [hoop]; allowed: parameters of a design",
                      origin_of(spec), parameter.name));
  if (spec.axes.empty()) {
    free_by_default();
    const bool frees_friction = std::ranges::find(free_, "mu_static", &FreeParameter::name) != free_.end();
    if (frees_friction && spec_.design.mu_kinetic == spec_.design.mu_static)
      spec_.design.mu_kinetic = usual.mu_kinetic;  // follows it
  }
  if (free_.empty())
    throw InputError(fmt::format(
        "{}: no parameter of the model \"{}\" is free; allowed: for example release_angle = {{ from, to }}",
        origin_of(spec), model_of(friction).name));
  check_spec(spec_);

  problem_.residuals = measured.events.size() + measured.film.t.size() * a_line();
  for (const FreeParameter& parameter : free_) problem_.bounds.push_back(parameter.side);
  if (!measured.events.empty()) {
    problem_.evaluate = [this](std::span<const double> at, std::span<double> residuals,
                               std::span<double> jacobian) {
      return event_residuals(at, residuals, jacobian);
    };
    return;
  }
  constexpr std::size_t few = 40;
  all_lines_.resize(measured.film.t.size());
  std::iota(all_lines_.begin(), all_lines_.end(), std::size_t{0});
  const std::size_t every = (all_lines_.size() + few - 1) / few;
  for (std::size_t i = 0; i < all_lines_.size(); i += every) few_lines_.push_back(i);
  if (has_markers())
    for (const std::size_t k : {std::size_t{2}, std::size_t{3}}) {
      const auto [low, high] = std::ranges::minmax(measured.film.markers[k]);
      const double reach = high - low + 20.0 * spec_.scene.radius;
      problem_.bounds.push_back({low - reach, high + reach});
    }
  problem_.evaluate = [this](std::span<const double> at, std::span<double> residuals,
                             std::span<double> jacobian) {
    return jacobian.empty() ? film_residuals<double>(at, all_lines_, residuals, jacobian)
                            : film_residuals<DesignDual>(at, all_lines_, residuals, jacobian);
  };
}

void Explained::free_by_default() {
  const double pi = std::numbers::pi;
  if (measured_.film.t.empty()) {
    free_ = {free_parameter("release_angle", 0.5 * pi, 1.95 * pi), free_parameter("release_spin", -1.0, 3.0)};
  } else {
    const double second = time_unit(spec_.scene);
    constexpr double late = 0.3;  // sqrt(R/g): from farther off nobody can tell where it was at the release
    if (measured_.film.t.front() > late * second)
      throw InputError(
          fmt::format("{}: the film begins at t = {} s, too late to estimate the release; allowed: times "
                      "counted from its "
                      "first line, or release_angle and release_spin with bounds, {{ from, to }}",
                      measured_.origin, measured_.film.t.front()));
    const auto [angle, spin] = begin_of(measured_.film, second);
    free_ = {free_parameter("release_angle", angle - 0.3, angle + 0.3),
             free_parameter("release_spin", spin * second - 0.5, spin * second + 0.5)};
  }
  if (model_of(spec_.scene).slips) free_.push_back(free_parameter("mu_static", 0.05, 1.5));
}

Design Explained::design_at(std::span<const double> at) const {
  Design design = spec_.design;
  for (std::size_t k = 0; k < free_.size(); ++k) design.*free_[k].variable.parameter() = at[k];
  return design;
}

bool Explained::errors_known() const {
  return !measured_.events.empty() || !std::isnan(measured_.film.error);
}

double Explained::unit_error() const {
  return measured_.events.empty() ? (errors_known() ? measured_.film.error : usual_error) : 1.0;
}

double Explained::error_of(std::size_t number) const {
  return measured_.events.empty() ? unit_error() : measured_.events[number].error;
}

double Explained::measured_at(std::size_t number) const {
  if (!measured_.events.empty()) return measured_.events[number].value;
  return has_markers() ? measured_.film.markers[number % 4][number / 4] : measured_.film.phi[number];
}

std::vector<double> Explained::model_at(std::span<const double> residuals) const {
  std::vector<double> model;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    model.push_back(measured_at(i) + residuals[i] * error_of(i));
  return model;
}

template <class S>
bool Explained::film_residuals(std::span<const double> at, std::span<const std::size_t> lines,
                               std::span<double> residuals, std::span<double> jacobian) const {
  const Design design = design_at(at);
  std::vector<double> times;
  for (const std::size_t line : lines) times.push_back(measured_.film.t[line]);
  const std::vector<MotionAt<S>> motion = motion_at<S>(design, spec_.scene, times);
  if (motion.empty()) return false;
  const std::size_t columns = problem_.bounds.size();
  const double error = unit_error(), R = spec_.scene.radius;
  const auto put = [&](std::size_t row, std::size_t number, const S& model, std::size_t origin) {
    residuals[row] = (value_of(model) - measured_at(number)) / error;
    if constexpr (has_derivatives<S>) {
      for (std::size_t k = 0; k < free_.size(); ++k) {
        const auto place =
            std::ranges::find(differentiable, free_[k].variable.parameter()) - differentiable.begin();
        jacobian[row * columns + k] = model.by[static_cast<std::size_t>(place)] / error;
      }
      for (std::size_t k = free_.size(); k < columns; ++k)
        jacobian[row * columns + k] = k - free_.size() == origin ? 1.0 / error : 0.0;
    }
  };
  const double x = at.size() > free_.size() ? at[free_.size()] : 0.0,
               y = at.size() > free_.size() ? at[free_.size() + 1] : 0.0;
  S L(design.offset_ratio);
  if constexpr (has_derivatives<S>) L = S::parameter(design.offset_ratio, 2);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!has_markers()) {
      put(i, lines[i], motion[i].phi, 0);
      continue;
    }
    const Trig<S> phi = trig(motion[i].phi);  // P is at (-L sin phi, -L cos phi) from O
    put(4 * i, 4 * lines[i], (motion[i].x - L * phi.sin) * R + x, 0);
    put(4 * i + 1, 4 * lines[i] + 1, (motion[i].y - L * phi.cos) * R + y, 1);
    put(4 * i + 2, 4 * lines[i] + 2, motion[i].x * R + x, 0);
    put(4 * i + 3, 4 * lines[i] + 3, motion[i].y * R + y, 1);
  }
  return std::ranges::all_of(residuals, [](double residual) { return std::isfinite(residual); }) &&
         std::ranges::all_of(jacobian, [](double derivative) { return std::isfinite(derivative); });
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

bool Explained::event_residuals(std::span<const double> at, std::span<double> residuals,
                                std::span<double> jacobian) const {
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

std::vector<double> Explained::with_origin(std::span<const double> at) const {
  std::vector<double> whole(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(free_.size()));
  if (!has_markers()) return whole;
  std::vector<double> residuals(4 * few_lines_.size());
  whole.resize(problem_.bounds.size(), 0.0);
  if (!film_residuals<double>(whole, few_lines_, residuals, {})) return whole;
  for (std::size_t i = 0; i < residuals.size(); ++i)
    whole[free_.size() + i % 2] -=
        residuals[i] * unit_error() / (0.5 * static_cast<double>(residuals.size()));
  return whole;
}

void Explained::coarse_sums(std::span<const std::vector<double>> places, std::span<double> sums) const {
  std::ranges::fill(sums, HUGE_VAL);
  if (measured_.events.empty()) {
    std::vector<double> residuals(few_lines_.size() * a_line());
    for (std::size_t i = 0; i < places.size(); ++i)
      if (film_residuals<double>(with_origin(places[i]), few_lines_, residuals, {}))
        sums[i] = std::inner_product(residuals.begin(), residuals.end(), residuals.begin(), 0.0);
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
