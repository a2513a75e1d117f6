// SPDX-License-Identifier: GPL-3.0-or-later
/// Where the polynomial on a panel first falls to zero, told by bounds: no dip is passed over because it lies
/// between two nodes.
///
/// Between neighbouring nodes the polynomial p is its cubic Hermite interpolant but for an error of at most
/// M x^2 (h - x)^2 / 24, M a bound of |p''''|. In Bernstein's form the cubic's inner coefficients bear that
/// error: lowered by M h^4 / 288, and still above zero as both ends are, they prove that p has no zero there.
/// What they do not prove is halved.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numerics/root.hpp"
#include "numerics/spectral.hpp"

namespace leapmap {

/// The least and the most of a function's values at a panel's nodes and ends, and the largest of its rates.
template <class S>
struct PanelExtent {
  S least, most, steepest;

  /// Of offset + factor times the function, factor 1 or -1.
  PanelExtent of(const S& offset, const S& factor) const {
    return factor > S(0) ? PanelExtent{offset + least, offset + most, steepest}
                         : PanelExtent{offset - most, offset - least, steepest};
  }
};

template <class S, std::size_t n>
PanelExtent<S> extent_of(const typename SpectralPanel<S, n>::Values& values,
                         const typename SpectralPanel<S, n>::Values& rates, const Sample<S>& first,
                         const Sample<S>& last) {
  using T = typename SpectralPanel<S, n>::T;
  using std::abs, std::max, std::min;
  T least(min(first.value, last.value)), most(max(first.value, last.value)),
      steepest(max(abs(first.rate), abs(last.rate)));
  for (std::size_t i = 0; i < n; i += Lanes<T>::count) {
    const T value = Lanes<T>::load(values.data() + i), rate = Lanes<T>::load(rates.data() + i);
    least = smaller(least, value), most = larger(most, value), steepest = larger(steepest, T(abs(rate)));
  }
  const auto least_of = lanes_of(least), most_of = lanes_of(most), steepest_of = lanes_of(steepest);
  return {*std::min_element(least_of.begin(), least_of.end()),
          *std::max_element(most_of.begin(), most_of.end()),
          *std::max_element(steepest_of.begin(), steepest_of.end())};
}

/// Well above zero everywhere: a third of a spacing on, the tangent of no node comes down to a thousandth,
/// which is more than the cubics are off by where the nodes resolve the function.
template <class S, std::size_t n>
bool is_clear_of_zero(const SpectralPanel<S, n>& panel, const PanelExtent<S>& extent) {
  return extent.least - extent.steepest * panel.longest_spacing() / S(3) > S(1e-3) * extent.most;
}

/// A function at a panel's start, nodes and end, knot after knot.
template <class S, std::size_t n>
struct PanelKnots {
  using Panel = SpectralPanel<S, n>;
  using T = typename Panel::T;
  static constexpr std::size_t width = Lanes<T>::count, padded = n + 2 + width;
  std::array<S, padded> place, value, rate;

  PanelKnots(const Panel& panel, const typename Panel::Values& values, const typename Panel::Values& rates,
             const Sample<S>& first, const Sample<S>& last) {
    place.fill(S(1)), value.fill(last.value), rate.fill(last.rate);
    place[0] = S(0), value[0] = first.value, rate[0] = first.rate;
    std::copy(panel.node.begin(), panel.node.end(), place.begin() + 1);
    std::copy(values.begin(), values.end(), value.begin() + 1);
    std::copy(rates.begin(), rates.end(), rate.begin() + 1);
  }
  Sample<S> at(std::size_t knot) const { return {value[knot], rate[knot]}; }

  /// Of as many intervals as there are lanes, from knot `first` on: in which of them the cubic stays above
  /// the slack and what it may be off by, a bit for each. bend: of the fourth derivative.
  unsigned clear_from(std::size_t first, const S& bend, const S& slack) const {
    const auto load = [&](const auto& numbers, std::size_t i) { return Lanes<T>::load(numbers.data() + i); };
    const T h = load(place, first + 1) - load(place, first), third = h * T(S(1) / S(3));
    const T a = load(value, first), b = load(value, first + 1);
    const T inner_a = a + third * load(rate, first), inner_b = b - third * load(rate, first + 1);
    const T square = h * h, least = T(bend / S(288)) * square * square + T(slack);
    return Lanes<T>::bits((b > T(S(0))) & (smaller(inner_a, inner_b) > least));
  }
};

template <class S>
struct PanelFall {
  S place;      ///< in (0, 1]; 2: it does not fall
  bool unsure;  ///< a dip to about zero is less than `slack` deep or high: finer nodes would tell
};

/// values, rates: of a function and its derivative by the panel's coordinate at the nodes; first, last: at
/// its ends, where `first` may be zero but for rounding. slack: what the polynomial may be off by.
template <class S, std::size_t n>
PanelFall<S> first_fall(const SpectralPanel<S, n>& panel, const typename SpectralPanel<S, n>::Values& values,
                        const typename SpectralPanel<S, n>::Values& rates, Sample<S> first,
                        const Sample<S>& last, const S& slack) {
  using std::min;
  constexpr S none(2), shortest(1e-9);
  const auto at = [&](const S& x) { return Sample<S>{panel.value(values, x), panel.value(rates, x)}; };
  const auto polish = [&](const S& a, const S& b, const S& guess) {
    return polish_root(at, a, b, guess, false, S(4) * std::numeric_limits<S>::epsilon());
  };
  // A function that starts at zero but for rounding falls at once, or before the first node, or is above zero
  // from there on.
  const bool starts_at_zero = !(first.value > S(0));
  if (starts_at_zero && first.rate > S(0))
    for (S b = panel.node[0]; b > S(1e-12) && !(at(b).value > S(0)); b *= S(0.5))
      if (at(b * S(0.5)).value > S(0)) return {polish(b * S(0.5), b, b * S(0.75)), false};
  if (starts_at_zero && (!(values[0] > S(0)) || first.rate * panel.node[0] < -slack))
    return {std::numeric_limits<S>::epsilon(), false};
  const S bend = panel.fourth_derivative_bound(values);
  bool unsure = false;
  int looks_left = 2'000;  // a function that keeps within the slack of zero is never told for sure
  // Whether the dip that is entered between a and b turns before it is deeper than the slack.
  const auto is_shallow = [&](S a, S b, Sample<S> at_b) {
    const S h = b - a;
    while (b < S(1) && S(0) > at_b.rate && at_b.value > -slack) {
      a = b, b = min(S(1), b + h), at_b = at(b);
    }
    if (at_b.rate < S(0)) return at_b.value > -slack;  // it does not turn on this panel
    for (int k = 0; k < 50 && at_b.value > -slack; ++k) {
      const S middle = a + (b - a) * S(0.5);
      const Sample<S> at_middle = at(middle);
      if (at_middle.value <= -slack) return false;
      at_middle.rate < S(0) ? a = middle : b = middle;
    }
    return at_b.value > -slack;
  };
  // A fall in (a, b], or none; values at a are not below zero.
  const auto search = [&](const auto& self, const S& a, const Sample<S>& at_a, const S& b,
                          const Sample<S>& at_b) -> S {
    const S h = b - a, error = bend * h * h * h * h / S(288);
    const S inner_a = at_a.value + h * at_a.rate / S(3), inner_b = at_b.value - h * at_b.rate / S(3);
    if (at_b.value > S(0) && min(inner_a, inner_b) > error + slack) return none;
    const bool monotone = min({at_a.value - inner_a, inner_a - inner_b, inner_b - at_b.value}) > S(2) * error;
    if (!(at_b.value > S(0)) && at_a.value > S(0) && (monotone || h < S(1e-4))) {
      if (at_b.value > -slack) unsure = unsure || is_shallow(a, b, at_b);
      if (at_b.value == S(0)) return b;
      return polish(a, b, S(a + h * at_a.value / (at_a.value - at_b.value)));
    }
    if (h < shortest || --looks_left < 0) {
      unsure = unsure || (slack > S(0) && min(inner_a, inner_b) <= slack);
      return at_b.value > S(0) ? none : b;
    }
    const S middle = a + h * S(0.5);
    const Sample<S> at_middle = at(middle);
    if (const S left = self(self, a, at_a, middle, at_middle); left < none) return left;
    return self(self, middle, at_middle, b, at_b);
  };
  unsigned clear = 0;
  const PanelKnots<S, n> knots(panel, values, rates, first, last);
  for (std::size_t i = starts_at_zero ? 1 : 0; i <= n; ++i) {
    if (i % knots.width == 0 || (starts_at_zero && i == 1))
      clear = knots.clear_from(i / knots.width * knots.width, bend, slack);
    if (clear >> i % knots.width & 1u) continue;
    const S place = search(search, knots.place[i], knots.at(i), knots.place[i + 1], knots.at(i + 1));
    if (place < none) return {place, unsure};
  }
  return {none, unsure};
}

}  // namespace leapmap
