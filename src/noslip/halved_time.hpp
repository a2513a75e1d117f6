// SPDX-License-Identifier: GPL-3.0-or-later
/// The time that rolling takes, of one design, by halving intervals until they agree: for designs whose spin
/// has a needle, or that are a hair past an equilibrium or from a stall.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

#include "hoop/rolling_by_angle.hpp"
#include "numerics/dual.hpp"
#include "numerics/quadrature.hpp"

namespace leapmap {

/// E near the release, released + 2 push x + bend x^2, and its zeros.
template <class T>
struct ReleaseParabola {
  T bend, discriminant, root;
  MaskOf<T> real;  ///< whether it has zeros
  /// The nearer zero. Without one E is far from zero if its least value is, over the distance that takes: -1
  /// will do.
  T nearer;
};

template <class T>
ReleaseParabola<T> parabola_at_release(const Roll<T>& roll) {
  using std::sqrt;
  ReleaseParabola<T> p;
  p.bend = -roll.hoop.rho * cos_from_vertical(roll.hoop, roll.release_trig);
  p.discriminant = roll.push * roll.push - roll.released * p.bend;
  p.root = sqrt(larger(p.discriminant, T(0)));
  p.real = p.discriminant >= T(0);
  p.nearer = select(p.real, -roll.released / (roll.push + p.root), T(-1));
  return p;
}

/// S: a number, or a dual, whose time is then as well resolved in every derivative. T: lanes of it, in which
/// the nodes of a rule lie side by side.
template <class S, class T = AbreastOf<S>>
class HalvedTime {
 public:
  using Number = ScalarOf<S>;

  /// The rule is applied to each half.
  HalvedTime(const Roll<S>& roll, Number tolerance, const GaussRule<Number>& rule);

  /// From the release over an angle. NaN where it cannot be told: so near a stall that E is lost in its
  /// roundings. Derivatives are NaN where they are not known to six digits. To be called once.
  S until(const S& end);

 private:
  using Plain = std::decay_t<decltype(value_of(std::declval<T>()))>;

  /// A number, of all lanes or of one, with its derivatives if V has any.
  template <class V, class X>
  static decltype(auto) as(const X& number) {
    if constexpr (has_derivatives<V> == has_derivatives<X>)
      return (number);
    else
      return value_of(number);
  }
  template <class V>
  V slowness_past(const V& x);
  template <class V>
  V stretched_slowness(const V& past);
  S edge_after(const S& x, const S& end) const;
  template <class V, class F>
  auto rule(const F& f, const S& a, const S& b);
  template <class F>
  void halve(const F& f, const S& a, const S& b, const Number& whole, int depth);

  static constexpr Number epsilon = std::numeric_limits<Number>::epsilon();
  static constexpr int most_halvings = 60;
  static constexpr std::size_t most_nodes = 32;

  const Roll<S>& roll_;
  Number tolerance_;
  std::array<Plain, most_nodes / Lanes<Plain>::count> nodes_, weights_;  // those to spare weigh nothing
  std::size_t rows_;                                                     // of lanes
  S release_;  // less whole turns, of which nothing depends
  S q0_;       // x = q (2 q0 + q) takes out E's zero before the release
  // The same in all lanes; of E and J, as functions of x.
  T wide_release_, wide_q0_, released_, rho2_, push2_, by_sine_, by_versine_, J_min_;
  // Relative, of J / E in the panel at hand: roundings of E's terms, and of the angle in J.
  Plain unsure_ = Plain(Number(0));
  S total_{0};
  Number doubt_{0};  // of the total, where it has derivatives: what roundings of E make of them
  long panels_left_ = 20'000;
};

}  // namespace leapmap
