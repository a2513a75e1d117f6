// SPDX-License-Identifier: GPL-3.0-or-later
/// Where a guard, a smooth scalar of the state, falls through zero inside one accepted step of an integrator.
///
/// The rule. A point is on the falling side if the guard is negative there, or zero and falling; otherwise it
/// is on the rising side. A fall at t* is reported by the step with t0 < t* <= t1: a step that starts on the
/// guard and falls has already been on the falling side and reports nothing. A touch that comes down to
/// exactly zero and leaves upwards is no fall. One that goes below zero, by however little, is a fall.
///
/// Pairs. Two falls and rises inside one step leave equal signs at its ends, and are found by looking at the
/// extrema between them. The ends' values and slopes are the method's own, so a single extremum is never
/// missed; samples at interior points, taken from a cubic Hermite interpolant, catch steps that hold more
/// than one. The interpolant only says where to look. Wherever it is not clear of zero, the method itself
/// retakes the part of the step up to that point and its value decides, and every reported time is polished
/// on retaken steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "numerics/root.hpp"

namespace leapmap {

template <std::size_t D>
using State = std::array<double, D>;

/// One accepted step from t0 to t0 + h: states y and their derivatives f at both ends.
template <std::size_t D>
struct Step {
  double t0 = 0, h = 0;
  State<D> y0{}, f0{}, y1{}, f1{};
};

/// The state inside a step by cubic Hermite interpolation, tau after its start.
template <std::size_t D>
State<D> interpolate(const Step<D>& step, double tau) {
  const double x = tau / step.h, z = 1.0 - x;
  const double a = z * z * (1.0 + 2.0 * x), b = x * x * (3.0 - 2.0 * x);
  const double c = x * z * z * step.h, d = -x * x * z * step.h;
  State<D> y;
  for (std::size_t i = 0; i < D; ++i)
    y[i] = a * step.y0[i] + b * step.y1[i] + c * step.f0[i] + d * step.f1[i];
  return y;
}

/// True on the falling side of a guard; see the rule above.
template <class S>
bool has_fallen(const Sample<S>& guard) {
  return guard.value < S(0) || (guard.value == S(0) && guard.rate < S(0));
}

/// A fall, or an extremum of the guard near zero: how long after the step's start, and the state or value
/// there.
template <std::size_t D>
struct Fall {
  double tau;
  State<D> state;
};
struct NearMiss {
  double tau;
  double value;  ///< of the guard at its extremum
  bool minimum;  ///< a minimum below zero makes a fall; a maximum above zero makes the fall after it
};

/// What one step held. Reused from step to step, so that nothing is allocated in the loop.
template <std::size_t D>
struct Falls {
  std::vector<Fall<D>> falls;         ///< in order of time
  std::vector<NearMiss> near_misses;  ///< extrema the method had to be asked about
  bool failed = false;                ///< a retaken step failed: nothing here may be believed
  struct Knot {
    double tau;
    bool fallen;
  };
  std::vector<Knot> knots;
};

/// When the look of that number is, of so many that end with the step.
template <std::size_t D>
double time_of_look(const Step<D>& step, std::size_t number, std::size_t count) {
  return number < count ? step.h * static_cast<double>(number) / static_cast<double>(count) : step.h;
}

/// The state that a look sees: inside the step the interpolant's.
template <std::size_t D>
State<D> state_at_look(const Step<D>& step, std::size_t number, std::size_t count) {
  return number < count ? interpolate(step, time_of_look(step, number, count)) : step.y1;
}

/// Finds the falls of guard in the step. guard(state) returns value and time derivative; retake(tau, state)
/// puts the method's own state at tau into state and returns false if it cannot; `first` is the guard at the
/// step's start, seen[k - 1] at look k of seen.size().
template <std::size_t D, class Guard, class Retake>
void find_falls(const Step<D>& step, const Sample<double>& first, std::span<const Sample<double>> seen,
                const Guard& guard, const Retake& retake, Falls<D>& out) {
  out.falls.clear();
  out.near_misses.clear();
  out.failed = false;
  const Sample<double>& last = seen.back();

  const auto guessed = [&](double tau) { return guard(interpolate(step, tau)); };
  const auto retaken = [&](double tau) -> Sample<double> {
    State<D> y;
    if (retake(tau, y)) return guard(y);
    out.failed = true;
    return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  };
  // An extremum is a root of the guard's rate; the rate's own slope is taken by a short difference.
  const auto guessed_rate = [&](double tau) -> Sample<double> {
    const double delta = 1e-4 * step.h * (tau > 0.5 * step.h ? -1.0 : 1.0);
    const double rate = guessed(tau).rate;
    return {rate, (guessed(tau + delta).rate - rate) / delta};
  };

  // Time resolution: beyond the last bits of t there is nothing to polish.
  const double resolution = 2.0 * std::numeric_limits<double>::epsilon() * (std::abs(step.t0) + step.h);
  double reach = std::max(std::abs(first.value), std::abs(last.value));

  out.knots.assign(1, {0.0, has_fallen(first)});
  Sample<double> left = first;
  double left_tau = 0.0;
  for (std::size_t look = 1; look <= seen.size(); ++look) {
    const double right_tau = time_of_look(step, look, seen.size());
    const Sample<double>& right = seen[look - 1];
    reach = std::max(reach, std::abs(right.value));
    if ((left.rate < 0.0) != (right.rate < 0.0)) {
      const bool minimum = left.rate < 0.0;
      double tau = polish_root(guessed_rate, left_tau, right_tau,
                               left_tau + (right_tau - left_tau) * left.rate / (left.rate - right.rate),
                               minimum, 1e-3 * step.h);
      double value = guessed(tau).value;
      // The interpolant is trusted only to say that nothing happens, and only where it stays clear of zero by
      // half the guard's reach over the step: what might make or undo a fall is always asked of the method.
      const bool turns_to_zero = minimum ? value > -0.1 * reach : value < 0.1 * reach;
      const bool unclear = turns_to_zero && std::abs(value) < 0.5 * reach;
      const bool decides = (value < 0.0) != out.knots.back().fallen || (value < 0.0) != has_fallen(last);
      if (unclear || decides) {
        // Newton with the interpolant's curvature. The value is flat here: half the digits of tau give all of
        // its.
        const double curvature = guessed_rate(tau).rate;
        constexpr int most_refinements = 20;
        for (int refinement = 0; refinement < most_refinements; ++refinement) {
          const Sample<double> at = retaken(tau);
          value = at.value;
          const double next = std::clamp(tau - at.rate / curvature, left_tau, right_tau);
          const bool settled = !(std::abs(next - tau) > 1e-8 * step.h);
          if (settled || refinement + 1 == most_refinements) break;
          tau = next;
        }
        if (unclear) out.near_misses.push_back({tau, value, minimum});
        out.knots.push_back({tau, value < 0.0});
      }
    }
    left = right;
    left_tau = right_tau;
  }
  out.knots.push_back({step.h, has_fallen(last)});
  if (out.failed) return;

  for (std::size_t i = 1; i < out.knots.size(); ++i) {
    const auto from = out.knots[i - 1], to = out.knots[i];
    if (from.fallen || !to.fallen) continue;
    const double guess =
        polish_root(guessed, from.tau, to.tau, 0.5 * (from.tau + to.tau), false, 1e-6 * step.h);
    Fall<D> fall{polish_root(retaken, from.tau, to.tau, guess, false, resolution), {}};
    // A bracket without a root would end at one of its ends, far from zero: that is no fall but a failed
    // step.
    const bool found =
        !out.failed && retake(fall.tau, fall.state) && std::abs(guard(fall.state).value) <= 0.01 * reach;
    found ? out.falls.push_back(fall) : void(out.failed = true);
  }
}

}  // namespace leapmap
