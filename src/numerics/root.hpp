// SPDX-License-Identifier: GPL-3.0-or-later
/// A bracketed root of a scalar function whose derivative is known, to the last digits the function carries.
#pragma once

#include <cmath>
#include <limits>

#include "numerics/lanes.hpp"

namespace leapmap {

/// A function's value and its derivative at one point.
template <class T>
struct Sample {
  T value, rate;
};

/// The same with the second and third derivatives.
template <class T>
struct CurvedSample {
  T value, rate, curvature, jerk;
};

/// Newton's iteration, or Householder's of order 4 where f gives its curvature, kept inside a bracket:
/// bisects where a step would leave it or is not half as long as the last one. On SIMD lanes each lane is a
/// search of its own, independent of its neighbours; only lanes in `wanted` are searched, the others return
/// anything.
///
/// f(x) returns a Sample or a CurvedSample; f must change sign between a and b: from below to above where
/// `rising`, else from above to below. Ends when the next step is sure to be below `resolution`, or the
/// bracket is; never takes more than 200 evaluations. Sure: steps d1, d2 of an iteration of order p are
/// followed by one of d2 (d2 / d1)^p; near a multiple root that estimate stays large, as it should. A sample
/// that is not finite ends the search with NaN, so that a failed evaluation is never a silent root.
template <class T, class F>
T polish_root(const F& f, T a, T b, T guess, MaskOf<T> rising, T resolution, MaskOf<T> wanted) {
  using std::abs;
  T x = select((guess > a) & (guess < b), guess, a + (b - a) * T(0.5));
  T result = x;
  T last_step = b - a;  // of any kind
  T previous(0);        // of the iteration; 0: the last step was none
  MaskOf<T> searching = wanted;
  for (int evaluation = 0; evaluation < 200 && any(searching); ++evaluation) {
    const auto s = f(x);
    const MaskOf<T> finite = s.value - s.value == T(0);
    const MaskOf<T> hit = s.value == T(0);
    const MaskOf<T> beyond = (s.value > T(0)) == rising;
    b = select(beyond, x, b);
    a = select(beyond, a, x);
    constexpr bool curved = requires { s.curvature; };
    T step;
    if constexpr (curved) {
      const T square = s.rate * s.rate, bend = s.value * s.curvature;
      step = T(-3) * s.value * (T(2) * square - bend) /
             (T(6) * s.rate * (square - bend) + s.value * s.value * s.jerk);
    } else {
      step = -s.value / s.rate;
    }
    const T proposed = x + step, length = abs(step);
    const MaskOf<T> inside = (proposed > a) & (proposed < b);
    const MaskOf<T> stepping = inside & (length <= T(0.5) * last_step);
    const T ratio = length / previous;
    T next_length = length * ratio * ratio;
    if constexpr (curved) next_length = next_length * ratio * ratio;
    // A converged step may leave the bracket by a rounding error: x itself is then the root.
    const MaskOf<T> converged = (length <= resolution) | (stepping & (next_length <= resolution));
    const T next = select(stepping, proposed, a + (b - a) * T(0.5));
    const T best = select(hit | (converged & !inside), x, select(converged, proposed, next));
    result = select(searching, select(finite, best, T(std::numeric_limits<double>::quiet_NaN())), result);
    searching = searching & finite & !(hit | converged | (b - a <= resolution));
    last_step = abs(next - x);
    previous = select(stepping, length, T(0));
    x = next;
  }
  return result;
}

template <class T, class F>
T polish_root(const F& f, T a, T b, T guess, bool rising, T resolution) {
  return polish_root(f, a, b, guess, MaskOf<T>(rising), resolution, MaskOf<T>(true));
}

}  // namespace leapmap
