// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion at given times by whatever model the scene names.
#pragma once

#include "model/model.hpp"
#include "trajectory/motion_at.hpp"

namespace leapmap {

/// As MotionAtTimes has it.
template <class S>
std::vector<MotionAt<S>> motion_at(const Design& design, const Scene& scene, std::span<const double> times,
                                   double accuracy = 1e-11,
                                   std::span<const std::size_t> by = by_every_parameter) {
  const MotionsAtTimes at_times = need(model_of(scene), &Model::at_times, "semi-analytic motion");
  return at_times.in<S>()(design, scene, times, accuracy, by);
}

}  // namespace leapmap
