// SPDX-License-Identifier: GPL-3.0-or-later
/// Motions at given times from the phases that an exact solver went through, with friction or without.
#pragma once

#include "trajectory/motion_at.hpp"
#include "trajectory/recorded_way.hpp"

namespace leapmap {

/// The motion of a design whose phases are recorded, as MotionAtTimes has it.
///
/// Between the ends of phases rolling follows from the vis viva and the time's integral
/// (noslip/roll_panels.hpp), sliding from the panels that the solver took, solved once more in S: a time's
/// place on a panel is found by interpolation and one step of Newton's method. A phase's end gets its
/// derivatives by one such step of what is zero there. Derivatives by mu_kinetic are added to those by
/// mu_static where it follows that.
template <class S>
std::vector<MotionAt<S>> motion_along(const RecordedWay& recorded, const Design& design, const Scene& scene,
                                      std::span<const double> times, double accuracy,
                                      std::span<const std::size_t> by);

/// A model's MotionAtTimes. record(design, scene, tolerance, recorded): solves a design and records it.
template <class S, Outcome (*record)(const Design&, const Scene&, double, RecordedWay&)>
std::vector<MotionAt<S>> recorded_motion(const Design& design, const Scene& scene,
                                         std::span<const double> times, double accuracy,
                                         std::span<const std::size_t> by) {
  constexpr double tolerance = 1e-12;  // of what is recorded, whatever is read from it
  RecordedWay recorded;
  const Status status = record(design, scene, tolerance, recorded).status;
  if (recorded.phases.empty() || status == Status::failed || status == Status::indeterminate) return {};
  return motion_along<S>(recorded, design, scene, times, accuracy, by);
}
template <Outcome (*record)(const Design&, const Scene&, double, RecordedWay&)>
inline constexpr MotionsAtTimes recorded_motions{
    recorded_motion<double, record>, recorded_motion<FewDual, record>, recorded_motion<DesignDual, record>};

}  // namespace leapmap
