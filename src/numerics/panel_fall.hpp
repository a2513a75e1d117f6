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
    const S a = offset + factor * least, b = offset + factor * most;
    return {smaller(a, b), larger(a, b), steepest};
  }
};

template <class S, std::size_t n>
PanelExtent<S> extent_of(const typename SpectralPanel<S, n>::Values& values,
                         const typename SpectralPanel<S, n>::Values& rates, const Sample<S>& first,
                         const Sample<S>& last) {
  using Panel = SpectralPanel<S, n>;
  using T = typename Panel::T;
  using std::abs;
  T least(smaller(first.value, last.value)), most(larger(first.value, last.value)),
      steepest(larger(S(abs(first.rate)), S(abs(last.rate))));
  for (std::size_t i = 0; i < n; i += Panel::width) {
    const T value = Panel::at(values, i), rate = Panel::at(rates, i);
    least = smaller(least, value), most = larger(most, value), steepest = larger(steepest, T(abs(rate)));
  }
  if constexpr (Panel::width == 1) {
    return {least, most, steepest};
  } else {
    const auto least_of = lanes_of(least);
    return {*std::min_element(least_of.begin(), least_of.end()), largest_lane(most), largest_lane(steepest)};
  }
}

/// Well above zero everywhere: a third of a spacing on, the tangent of no node comes down to a thousandth,
/// which is more than the cubics are off by where the nodes resolve the function.
template <class S, std::size_t n>
MaskOf<S> is_clear_of_zero(const SpectralPanel<S, n>& panel, const PanelExtent<S>& extent) {
  return extent.least - extent.steepest * S(panel.longest_spacing() / 3) > S(ScalarOf<S>(1e-3)) * extent.most;
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
  const auto at = [&](const S& x) {
    const auto [value, rate] = panel.template values<2>({&values, &rates}, x);
    return Sample<S>{value, rate};
  };
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
  const S bend = panel.roughness(values).fourth;
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

/// The first falls of as many functions as T has lanes, each on a panel of its own.
template <class T>
struct PlainFall {
  T place;             ///< in (0, 1]; 2: it does not fall
  MaskOf<T> is_plain;  ///< else first_fall has to look: at a dip, or at a start that is no rise from zero
};

/// The same as first_fall, of lanes where the first interval in which the cubic comes near zero holds a plain
/// fall through it. bend: a bound of the functions' fourth derivatives. Lanes outside `asked` return
/// anything.
template <class T, std::size_t n>
PlainFall<T> plain_fall(const SpectralPanel<T, n>& panel, const typename SpectralPanel<T, n>::Values& values,
                        const typename SpectralPanel<T, n>::Values& rates, const Sample<T>& first,
                        const Sample<T>& last, const T& bend, const T& slack, const MaskOf<T>& asked) {
  using std::abs;
  using S = ScalarOf<T>;
  const T zero(S(0));
  const MaskOf<T> starts_at_zero = !(first.value > zero);
  const MaskOf<T> rises = (first.rate > zero) & (values[0] > zero);
  MaskOf<T> looking = asked & ((first.value > zero) | rises);
  MaskOf<T> monotone(false);  // and all that is found below: of the interval found
  T from(S(0)), to(S(1));
  Sample<T> at_from = first, at_to = last;
  for (std::size_t i = 0; i <= n && any(looking); ++i) {
    const T third(panel.third[i]), error = bend * T(panel.bent[i]);
    const Sample<T> at_a = i == 0 ? first : Sample<T>{values[i - 1], rates[i - 1]},
                    at_b = i == n ? last : Sample<T>{values[i], rates[i]};
    const T inner_a = at_a.value + third * at_a.rate, inner_b = at_b.value - third * at_b.rate;
    MaskOf<T> near = looking & !((at_b.value > zero) & (smaller(inner_a, inner_b) > error + slack));
    if (i == 0) near = near & !starts_at_zero;
    if (!any(near)) continue;
    looking = looking & !near;
    from = select(near, T(i == 0 ? S(0) : panel.node[i - 1]), from);
    to = select(near, T(i == n ? S(1) : panel.node[i]), to);
    at_from = {select(near, at_a.value, at_from.value), select(near, at_a.rate, at_from.rate)};
    at_to = {select(near, at_b.value, at_to.value), select(near, at_b.rate, at_to.rate)};
    const T least_fall = smaller(smaller(at_a.value - inner_a, inner_a - inner_b), inner_b - at_b.value);
    monotone = monotone | (near & (least_fall > T(S(2)) * error));
  }
  const MaskOf<T> falls = monotone & (at_from.value > zero) & !(at_to.value > -slack);
  PlainFall<T> fall{T(S(2)), asked & (looking | falls)};
  if (!any(falls)) return fall;
  // From where the cubic falls, which two steps from the chain tell well enough.
  const T h = to - from;
  T x = at_from.value / (at_from.value - at_to.value);
  const T d = at_to.value - at_from.value, m_from = h * at_from.rate, m_to = h * at_to.rate;
  const T c2 = T(S(3)) * d - T(S(2)) * m_from - m_to, c3 = m_from + m_to - T(S(2)) * d;
  for (int k = 0; k < 2; ++k)
    x = x -
        (at_from.value + x * (m_from + x * (c2 + x * c3))) / (m_from + x * (T(S(2)) * c2 + x * T(S(3)) * c3));
  const auto at = [&](const T& place) {
    const auto [value, rate] = panel.template values<2>({&values, &rates}, place);
    return Sample<T>{value, rate};
  };
  // One step of Newton's method, where the cubic's curvature bends it by next to nothing.
  const T guess = from + h * x;
  const Sample<T> there = at(guess);
  const T step = -there.value / there.rate,
          bent = T(S(2)) * (c2 + T(S(3)) * x * c3) / (h * h) * step * step / there.rate;
  T place = guess + step - T(S(0.5)) * bent;
  const MaskOf<T> unsure = falls & !((abs(bent) <= T(S(1e-12))) & (place > from) & (place < to));
  if (any(unsure))
    place = select(unsure,
                   polish_root(at, from, to, guess, MaskOf<T>(false),
                               T(S(4) * std::numeric_limits<S>::epsilon()), unsure),
                   place);
  fall.place = select(falls, place, fall.place);
  fall.is_plain = asked & (looking | (falls & (place <= T(S(1)))));
  return fall;
}

}  // namespace leapmap
