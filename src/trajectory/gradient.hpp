// SPDX-License-Identifier: GPL-3.0-or-later
/// Derivatives of outcomes by the parameters of their designs: which are asked for, and where they go.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "hoop/flight_dual.hpp"
#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "numerics/dual.hpp"

namespace leapmap {

/// The parameters, in the order in which duals hold their derivatives. Without slip only the first eight
/// matter.
inline constexpr std::array<double Design::*, 11> differentiable{
    &Design::slope,         &Design::mass_ratio,   &Design::offset_ratio, &Design::inertia_factor,
    &Design::release_angle, &Design::release_spin, &Design::drive_torque, &Design::resisting_torque,
    &Design::mu_static,     &Design::mu_kinetic,   &Design::restitution};
inline constexpr std::size_t without_slip = 8;
inline constexpr std::size_t by_slope = 0, by_offset_ratio = 2, by_release_angle = 4, by_release_spin = 5,
                             by_resisting_torque = 7, by_mu_static = 8, by_mu_kinetic = 9,
                             by_restitution = 10;  ///< places among them

/// The place of a parameter among them.
inline std::size_t place_of(double Design::*parameter) {
  return static_cast<std::size_t>(std::find(differentiable.begin(), differentiable.end(), parameter) -
                                  differentiable.begin());
}

/// A number with its derivatives by every parameter of one design.
using DesignDual = Dual<double, differentiable.size()>;
/// A number with its derivatives by a state at a landing: angle, spin, slip and normal velocity.
using StateDual = Dual<double, 4>;
/// Whether a dual's derivatives are by the parameters of a design. To a StateDual these are constants, and it
/// knows derivatives of neither times nor ways.
template <class D>
inline constexpr bool is_by_design = !std::is_same_v<D, StateDual>;
/// As DesignDual without friction's, of one design and of as many as the machine has lanes.
using RollingDual = Dual<double, without_slip>;
using LanesDual = Dual<Batch, without_slip>;

/// The first parameters of a design as duals of themselves.
template <class D>
std::array<D, without_slip> dual_parameters(const Design& design) {
  std::array<D, without_slip> parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    parameters[k] = D::parameter(design.*differentiable[k], k);
  return parameters;
}

/// The hoop of those parameters, with its motor in flight as the scene has it.
template <class D>
Hoop<D> reduce(const std::array<D, without_slip>& p, const Scene& scene) {
  Hoop<D> hoop = reduce(p[0], p[1], p[2], p[3], p[6]);
  const auto plain = [](const D& number) { return number.value; };
  using T = decltype(hoop.rho.value);
  const T way = resisted_way(mapped<T>(hoop, plain), p[by_resisting_torque].value, p[by_release_angle].value,
                             p[by_release_spin].value);
  return in_flight(resisted(hoop, p[by_resisting_torque] * D(way)), scene);
}

/// Whether mu_kinetic is what mu_static is, and goes where that goes.
inline bool kinetic_follows(const Design& design) {
  return std::isnan(design.mu_kinetic) || design.mu_kinetic == design.mu_static;
}

/// Which derivatives are asked for.
struct GradientWanted {
  std::vector<OutcomeNumber> of;
  std::vector<std::size_t> by;  ///< places in `differentiable`

  bool wants(const OutcomeNumber& quantity) const {
    return std::find(of.begin(), of.end(), quantity) != of.end();
  }
  /// Whether one of them applies to an outcome's first jump, or to its way there.
  bool any_of_first_jump_in(const Outcome& outcome) const {
    return std::any_of(of.begin(), of.end(), [&](const OutcomeNumber& each) {
      return each.jump == 1 && std::isfinite(each.of(outcome));
    });
  }
};

/// Derivatives of designs, a column for each quantity and parameter asked for; NaN where a quantity does not
/// apply, or a derivative is infinite or cannot be told.
class Gradients {
 public:
  Gradients() = default;
  explicit Gradients(GradientWanted wanted)
      : wanted_(std::move(wanted)), columns_(wanted_.of.size() * wanted_.by.size()) {}

  /// Makes room for so many designs, of which nothing is known.
  void begin(std::size_t designs) {
    for (std::vector<double>& column : columns_)
      column.assign(designs, std::numeric_limits<double>::quiet_NaN());
  }
  /// d of[i] / d by[j] of every design.
  std::span<const double> column(std::size_t i, std::size_t j) const {
    return columns_[i * wanted_.by.size() + j];
  }
  /// The same by what it is; it must be asked for.
  std::span<const double> column(const OutcomeNumber& of, double Design::*by) const {
    const auto i = std::find(wanted_.of.begin(), wanted_.of.end(), of) - wanted_.of.begin();
    const auto j = std::find_if(wanted_.by.begin(), wanted_.by.end(),
                                [&](std::size_t k) { return differentiable[k] == by; }) -
                   wanted_.by.begin();
    return column(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  }
  const GradientWanted& wanted() const { return wanted_; }
  /// The derivatives of one quantity of one design, in the members of their parameters; else NaN.
  Design of_design(const OutcomeNumber& of, std::size_t design) const {
    Design by;
    for (double Design::*parameter : differentiable) by.*parameter = std::numeric_limits<double>::quiet_NaN();
    const auto i =
        static_cast<std::size_t>(std::find(wanted_.of.begin(), wanted_.of.end(), of) - wanted_.of.begin());
    for (std::size_t j = 0; j < wanted_.by.size(); ++j)
      by.*differentiable[wanted_.by[j]] = column(i, j)[design];
    return by;
  }

  /// Of one design: there are no derivatives by a parameter, of whatever quantity.
  void forget(std::size_t by, std::size_t design) {
    scale_by(by, design, std::numeric_limits<double>::quiet_NaN());
  }
  /// Multiplies the derivatives of one design by a parameter.
  void scale_by(std::size_t by, std::size_t design, double factor) {
    for (std::size_t j = 0; j < wanted_.by.size(); ++j)
      if (wanted_.by[j] == by)
        for (std::size_t i = 0; i < wanted_.of.size(); ++i)
          columns_[i * wanted_.by.size() + j][design] *= factor;
  }

  /// The derivatives of one quantity of one design, in `unit` of the solver's own. Does nothing if they are
  /// not asked for.
  template <std::size_t N>
  void put(const OutcomeNumber& quantity, std::size_t design, const Dual<double, N>& value,
           double unit = 1.0) {
    for_each(quantity, [&](std::vector<double>& column, std::size_t by) {
      if (by < N) column[design] = unit * value.by[by];
    });
  }
  /// The same of several designs, each in the lane of its bit.
  template <class T, std::size_t N, class Index>
  void put(const OutcomeNumber& quantity, const Index& designs, unsigned lanes, const Dual<T, N>& value,
           double unit) {
    for_each(quantity, [&](std::vector<double>& column, std::size_t by) {
      if (by >= N) return;
      const auto derivatives = lanes_of(value.by[by]);
      for (std::size_t k = 0; k < derivatives.size(); ++k)
        if (lanes >> k & 1u) column[designs[k]] = unit * derivatives[k];
    });
  }

  /// What others hold of that, for so many designs.
  void take(const Gradients& others, std::size_t designs) {
    begin(designs);
    for (std::size_t i = 0; i < wanted_.of.size(); ++i)
      for (std::size_t j = 0; j < wanted_.by.size(); ++j) {
        const std::span<const double> column = others.column(wanted_.of[i], differentiable[wanted_.by[j]]);
        std::copy(column.begin(), column.end(), columns_[i * wanted_.by.size() + j].begin());
      }
  }

  /// Multiplies the derivatives of a quantity of one design.
  void scale(const OutcomeNumber& quantity, std::size_t design, double factor) {
    for_each(quantity, [&](std::vector<double>& column, std::size_t) { column[design] *= factor; });
  }

 private:
  template <class Visit>
  void for_each(const OutcomeNumber& quantity, const Visit& visit) {
    for (std::size_t i = 0; i < wanted_.of.size(); ++i)
      if (wanted_.of[i] == quantity)
        for (std::size_t j = 0; j < wanted_.by.size(); ++j)
          visit(columns_[i * wanted_.by.size() + j], wanted_.by[j]);
  }

  GradientWanted wanted_;
  std::vector<std::vector<double>> columns_;
};

/// What the jump's lift-off and its flight come to; put(quantity, derivatives, unit). second: of the solver's
/// unit of time.
template <class D, class Put>
void put_jump(const Put& put, const D& angle, const D& spin, const D& distance, const FlightDual<D>& flight,
              double second) {
  put(&Outcome::jump_height, flight.height, 1.0);
  put(&Outcome::jump_angle, angle, 1.0);
  put(&Outcome::jump_spin, spin, 1.0);
  put(&Outcome::jump_distance, distance, 1.0);
  put(&Outcome::apex_time, flight.apex_time, second);
  put(&Outcome::flight_time, flight.flight_time, second);
}

/// Solves designs[i] into outcomes[i], and puts their derivatives. Owns its workspace: one a thread.
using GradientSolver =
    std::function<void(std::span<const Design> designs, std::span<Outcome> outcomes, Gradients& gradients)>;

}  // namespace leapmap
