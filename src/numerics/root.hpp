// SPDX-License-Identifier: GPL-3.0-or-later
/// A bracketed root of a scalar function whose derivative is known, to the last digits the function carries.
#pragma once

#include <cmath>
#include <limits>

namespace leapmap {

/// A function's value and its derivative at one point.
template <class T>
struct Sample {
  T value, rate;
};

/// Newton's iteration kept inside a bracket: bisects where Newton would leave it or stops halving its steps.
///
/// f(x) returns a Sample; f must change sign between a and b (f(a) > 0 iff rising is false). Ends when a
/// Newton step is below `resolution`, or when the bracket is; never takes more than 200 evaluations. A sample
/// that is not finite ends the search with NaN, so that a failed evaluation is never a silent root.
template <class T, class F>
T polish_root(const F& f, T a, T b, T guess, bool rising, T resolution) {
  using std::abs, std::isfinite;
  T x = (guess > a && guess < b) ? guess : a + (b - a) * T(0.5);
  T last_step = b - a;
  for (int evaluation = 0; evaluation < 200; ++evaluation) {
    const Sample<T> s = f(x);
    if (!isfinite(s.value)) return std::numeric_limits<T>::quiet_NaN();
    if (s.value == T(0)) return x;
    (s.value > T(0)) == rising ? b = x : a = x;
    const T newton = x - s.value / s.rate;
    const bool inside = newton > a && newton < b;
    const bool shrinking = abs(newton - x) <= T(0.5) * last_step;
    const T next = inside && shrinking ? newton : a + (b - a) * T(0.5);
    last_step = abs(next - x);
    // A converged Newton step may leave the bracket by a rounding error: x itself is then the root.
    if (abs(newton - x) <= resolution) return inside ? newton : x;
    if (b - a <= resolution) return next;
    x = next;
  }
  return x;
}

}  // namespace leapmap
