// SPDX-License-Identifier: GPL-3.0-or-later
/// The event loop of everything that is integrated: one step after the other, and in each where its guards
/// fall through zero (numerics/events.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "numerics/events.hpp"
#include "support/stop.hpp"

namespace leapmap {

/// What becomes of a step.
enum class Stepped {
  taken,
  no_step,  ///< the method has none
  no_event  ///< a fall could not be located: nothing of the step may be believed
};

/// A guard, by number, falls: how long after the step's start, and the state there.
template <std::size_t D>
struct Event {
  double tau;
  std::size_t guard;
  State<D> state;
};

/// Reused from phase to phase, so that nothing is allocated in the loop.
template <std::size_t D>
class GuardedSteps {
 public:
  /// Begins at a state. sample(g, y): the value and the rate in time of guard g, of so many.
  template <class SampleOf>
  void begin(const State<D>& at, std::size_t guards, const SampleOf& sample) {
    now_.resize(guards);
    sample_all(sample, at, now_);
    if (falls_.size() < guards) falls_.resize(guards);
  }

  /// Takes a step of a method, which has advance(), step() and retake(), as GslIntegrator. angle(y): of the
  /// hoop; looks: for further falls, in half a revolution of it.
  template <class Method, class AngleOf, class SampleOf>
  Stepped take(Method& method, const AngleOf& angle, double looks, const SampleOf& sample) {
    throw_if_stopped();
    if (!method.advance()) return Stepped::no_step;
    const Step<D>& step = method.step();
    const double turned = std::abs(angle(step.y1) - angle(step.y0));
    // std::min(1000.0, NaN) is 1000.0.
    const auto count = 2 + static_cast<std::size_t>(std::min(1000.0, turned * (looks / std::numbers::pi)));
    look(step, count, sample);
    events_.clear();
    for (std::size_t g = 0; g < now_.size(); ++g) {
      const std::span<const Sample<double>> seen = std::span(seen_).subspan(g * count, count);
      find_falls(
          step, now_[g], seen, [&](const State<D>& y) { return sample(g, y); },
          [&](double tau, State<D>& y) { return method.retake(tau, y); }, falls_[g]);
      now_[g] = seen.back();
      if (falls_[g].failed) return Stepped::no_event;
      for (const Fall<D>& fall : falls_[g].falls) events_.push_back({fall.tau, g, fall.state});
    }
    // Of falls at one moment the first guard's comes first. (The page's compiler has no std::ranges sort.)
    std::stable_sort(events_.begin(), events_.end(),
                     [](const Event<D>& a, const Event<D>& b) { return a.tau < b.tau; });
    return Stepped::taken;
  }

  /// The falls of the step, in order of time.
  const std::vector<Event<D>>& events() const { return events_; }
  /// Those of one guard, with its near misses.
  const Falls<D>& falls(std::size_t guard) const { return falls_[guard]; }
  /// A guard at the end of the step, and at the start of the next.
  Sample<double>& now(std::size_t guard) { return now_[guard]; }

 private:
  /// Samples all guards at a state: by sample.all(y, guards), if there is one, else one after the other.
  template <class SampleOf>
  static void sample_all(const SampleOf& sample, const State<D>& y, std::span<Sample<double>> guards) {
    if constexpr (requires { sample.all(y, guards); }) {
      sample.all(y, guards);
    } else {
      for (std::size_t g = 0; g < guards.size(); ++g) guards[g] = sample(g, y);
    }
  }
  /// Samples every guard at so many looks of the step.
  template <class SampleOf>
  void look(const Step<D>& step, std::size_t count, const SampleOf& sample) {
    seen_.resize(now_.size() * count);
    at_look_.resize(now_.size());
    for (std::size_t k = 0; k < count; ++k) {
      sample_all(sample, state_at_look(step, k + 1, count), at_look_);
      for (std::size_t g = 0; g < now_.size(); ++g) seen_[g * count + k] = at_look_[g];
    }
  }

  std::vector<Sample<double>> now_, at_look_;
  std::vector<Sample<double>> seen_;  // of one guard after the other
  std::vector<Falls<D>> falls_;
  std::vector<Event<D>> events_;
};

}  // namespace leapmap
