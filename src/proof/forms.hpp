// SPDX-License-Identifier: GPL-3.0-or-later
/// Enclosures over a box of designs. A number of all designs is a dual of balls: it carries its derivatives
/// by one variable (an angle or a time) and by the parameters that vary. The mean-value form
///   f(x, p) in f(x0, p0) + f_x (x - x0) + sum f_k (p_k - p0_k)
/// about the design in the middle is narrower than f itself where the box is small, and both hold.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <tuple>
#include <vector>

#include "numerics/root.hpp"
#include "proof/ball.hpp"

namespace leapmap {

/// Of a box in N parameters: derivative 0 is by the variable, 1 + k by parameter k.
template <std::size_t N>
using BoxDual = Dual<Ball, N + 1>;

/// A number, or what is made of numbers: of all designs of the box, and of the one in the middle.
template <template <class> class Of, std::size_t N>
struct Both {
  Of<BoxDual<N>> all;
  Of<Ball> middle;
};
template <class T>
using Itself = T;
template <std::size_t N>
using BothNumbers = Both<Itself, N>;

template <std::size_t N>
struct Forms {
  std::array<Ball, N> reach;  ///< of each parameter about the middle of the box

  /// f of all designs by its mean-value form, where f is that in the middle.
  Ball about(const Ball& middle, const BoxDual<N>& all) const {
    Ball sum = middle;
    for (std::size_t k = 0; k < N; ++k) sum = sum + all.by[k + 1] * reach[k];
    return sum;
  }
  /// The number with its narrower enclosure, and without the derivative by the variable.
  BothNumbers<N> narrowed(BoxDual<N> all, const Ball& middle) const {
    if constexpr (N > 0) all.value = meet(all.value, about(middle, all));
    if constexpr (N == 0) all.value = middle;
    all.by[0] = Ball(0);
    return {all, middle};
  }

  /// All values and slopes of f, a function of what `of` is and of a variable, between two of its values.
  template <class F, template <class> class Of>
  Sample<Ball> range(const F& f, const Both<Of, N>& of, double from, double to) const {
    const double inside = from + 0.5 * (to - from);
    const Ball variable = Ball::between(from, to), middle(inside), step = variable - middle;
    const auto there = f(of.middle, middle);
    if constexpr (N == 0) {  // mostly enough, at a third of the cost
      const Sample<Ball> all = f(of.middle, variable);
      const Sample<Ball> found{meet(all.value, there.value + all.rate * step), all.rate};
      if (found.value.sign() != 0 || found.rate.sign() != 0) return found;
    }
    const auto all = f(of.all, BoxDual<N>::parameter(variable, 0));
    const auto form = [&](const auto& part, const Ball& at_middle) {
      return meet(part.value, about(at_middle + part.by[0] * step, part));
    };
    return {form(all.value, there.value), meet(form(all.rate, there.rate), all.value.by[0])};
  }

  /// Where f is zero between two values of its variable, of which it has one zero for each design: narrower
  /// by Newton's method for intervals, with its derivatives.
  template <class F, template <class> class Of>
  BothNumbers<N> zero(const F& f, const Both<Of, N>& of, double from, double to) const;

 private:
  /// Derivatives of that zero by the parameters, from 1 on: -f_k / f_x wherever it may be.
  template <class F, template <class> class Of>
  std::array<Ball, N + 1> slopes(const F& f, const Both<Of, N>& of, double from, double to) const;
};

/// The values of the variable where f may be zero, between two of its values. value_at: f at a double.
template <class ValueAt, class RateIn>
Ball newton(const ValueAt& value_at, const RateIn& rate_in, double from, double to) {
  constexpr int most_steps = 60;
  Ball found = Ball::between(from, to);
  for (int k = 0; k < most_steps; ++k) {
    const double middle = from + 0.5 * (to - from);
    const Ball value = value_at(middle), rate = rate_in(from, to);
    double begin = from, end = to;
    if (rate.sign() != 0) {
      found = meet(Ball::between(from, to), Ball(middle) - value / rate);
      begin = std::max(from, found.lower()), end = std::min(to, found.upper());
    } else if (value.sign() != 0) {  // the slope is known of each piece, not of all together
      const int before = value_at(from).sign();
      if (before == 0) break;
      (value.sign() == before ? begin : end) = middle;
      found = Ball::between(begin, end);
    }
    const bool enough = !(end - begin < 0.8 * (to - from));
    from = begin, to = end;
    if (enough) break;
  }
  return found;
}

template <std::size_t N>
template <class F, template <class> class Of>
BothNumbers<N> Forms<N>::zero(const F& f, const Both<Of, N>& of, double from, double to) const {
  const Ball middle =
      newton([&](double x) { return f(of.middle, Ball(x)).value; },
             [&](double a, double b) { return f(of.middle, Ball::between(a, b)).rate; }, from, to);
  if constexpr (N == 0) return {BoxDual<N>(middle), middle};
  const Ball all = newton([&](double x) { return range(f, of, x, x).value; },
                          [&](double a, double b) { return range(f, of, a, b).rate; }, from, to);
  BoxDual<N> root(all);
  root.by = slopes(f, of, all.lower(), all.upper());
  return narrowed(root, middle);
}

template <std::size_t N>
template <class F, template <class> class Of>
std::array<Ball, N + 1> Forms<N>::slopes(const F& f, const Both<Of, N>& of, double from, double to) const {
  constexpr int most_halvings = 6;
  std::optional<std::array<Ball, N + 1>> found;
  std::vector<std::tuple<double, double, int>> todo{{from, to, 0}};
  while (!todo.empty()) {
    const auto [a, b, halvings] = todo.back();
    todo.pop_back();
    const Sample<Ball> here = range(f, of, a, b);
    if (here.value.sign() != 0) continue;  // the zero is elsewhere
    const double middle = a + 0.5 * (b - a);
    if (halvings < most_halvings && (here.rate.sign() == 0 || halvings < 2) && a < middle && middle < b) {
      todo.emplace_back(a, middle, halvings + 1), todo.emplace_back(middle, b, halvings + 1);
      continue;
    }
    const auto there = f(of.all, BoxDual<N>::parameter(Ball::between(a, b), 0));
    const bool is_first = !found;
    if (is_first) found.emplace();
    for (std::size_t k = 1; k <= N; ++k) {
      const Ball slope = -there.value.by[k] / here.rate;
      (*found)[k] = is_first ? slope : hull((*found)[k], slope);
    }
  }
  return found.value_or(std::array<Ball, N + 1>{});
}

}  // namespace leapmap
