// SPDX-License-Identifier: GPL-3.0-or-later
/// How referees see that something happens: by functions of the state alone that fall through zero.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "numerics/events.hpp"

namespace leapmap::referee {

/// Falls through zero where something happens.
template <class Motion>
using GuardOf = std::function<double(const Motion&)>;

/// Samples guards of a system that says what motion(y) a state is, how fast a motion goes on, rates(motion),
/// and what a moment(motion) is: their rates are their changes along the motion's straight continuation.
template <class System>
class Sampled {
 public:
  using Y = typename System::Y;
  using Guard = GuardOf<typename System::Motion>;

  /// Both have to outlive it.
  Sampled(const System& system, const std::vector<Guard>& guards) : system_(system), guards_(guards) {}

  void all(const Y& y, std::span<Sample<double>> samples) const {
    const Around around = around_of(y);
    for (std::size_t i = 0; i < guards_.size(); ++i) samples[i] = around.sample(guards_[i]);
  }
  Sample<double> operator()(std::size_t number, const Y& y) const {
    return around_of(y).sample(guards_[number]);
  }

 private:
  /// A state, and those a moment later and earlier.
  struct Around {
    typename System::Motion at, ahead, behind;
    double moment;

    Sample<double> sample(const Guard& guard) const {
      return {guard(at), (guard(ahead) - guard(behind)) / (2.0 * moment)};
    }
  };
  Around around_of(const Y& y) const {
    const auto at = system_.motion(y);
    const Y f = system_.rates(at);
    const double moment = system_.moment(at);
    Y ahead = y, behind = y;
    for (std::size_t i = 0; i < y.size(); ++i) ahead[i] += moment * f[i], behind[i] -= moment * f[i];
    return {at, system_.motion(ahead), system_.motion(behind), moment};
  }

  const System& system_;
  const std::vector<Guard>& guards_;
};

}  // namespace leapmap::referee
