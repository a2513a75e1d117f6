// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/trace_points.hpp"

#include <cmath>

#include "physics/flight_search.hpp"
#include "physics/rolling.hpp"
#include "trajectory/exact.hpp"

namespace leapmap {
namespace {

/// The story as the integration tells it, unchecked.
Story integrated(const Design& design, const Scene& scene, const IntegrationOptions& options, double interval,
                 double graze_limit) {
  const Hoop<double> hoop = derive<double>(design);
  Story story;
  TraceSampler sampler{interval, story.points};
  const auto rolled = [&](double t, const OneCoordinate::Y& y) {
    return ContactState<double>{
        .time = t, .travel = y[0] - design.release_angle, .angle = y[0], .spin = y[1]};
  };

  RollingObserver observer;
  observer.lift_off = [&](const LiftOff<double>& lift_off, const Flight<double>& flight) {
    story.candidates.push_back({lift_off, flight});
  };
  observer.graze = [&](const Graze& graze) {
    if (std::abs(graze.normal_force) < graze_limit) story.grazes.push_back(graze);
  };
  if (interval > 0.0) {
    observer.step = [&](const GslIntegrator<2>& integrator, double end) {
      const double t0 = integrator.step().t0;
      sampler.until(t0 + end, [&](double t) {
        OneCoordinate::Y y = integrator.step().y0;
        if (!integrator.retake(t - t0, y)) y.fill(NAN);
        return rolling_point(hoop, rolled(t, y));
      });
    };
  }
  story.outcome = RollingIntegration(options).solve(design, scene, observer);

  if (interval > 0.0 && story.outcome.status == Status::jumped) {
    const Candidate& jump = story.candidates.back();
    const double start = jump.lift_off.time, flown = jump.flight.flight_time;
    const ContactState<double> lift_off = rolled(start, {jump.lift_off.angle, jump.lift_off.spin});
    story.points.push_back(rolling_point(hoop, lift_off));
    sampler.until(start + flown, [&](double t) { return flight_point(hoop, lift_off, t - start); });
    story.points.push_back(flight_point(hoop, lift_off, flown));
  }
  return story;
}

}  // namespace

Story tell(const Design& design, const Scene& scene, const IntegrationOptions& options, double interval,
           double graze_limit) {
  Story story = integrated(design, scene, options, interval, graze_limit);
  ExactSolver<Batch>(check_tolerance).solve({&design, 1}, scene, {&story.checked, 1});
  return story;
}

Story tell_exactly(const Design& design, const Scene& scene, double tolerance, double interval,
                   double graze_limit) {
  Story story = integrated(design, scene, adaptive("gsl-rk8pd", check_tolerance), interval, graze_limit);
  story.checked = story.outcome;
  story.candidates.clear();

  // As a sweep solves it: all but the times, which are within the tolerance, are the map's to the last digit.
  std::vector<LiftOff<double>> lift_offs;
  ExactSolver<Batch>(tolerance).solve({&design, 1}, scene, {&story.outcome, 1}, &lift_offs);
  const Hoop<double> hoop = derive<double>(design);
  const Roll<double> roll = begin_roll(hoop, design.release_angle, design.release_spin);
  const RollingTime<double> time(tolerance);
  for (LiftOff<double>& lift_off : lift_offs) {
    lift_off.time = time.halving(roll, lift_off.angle);
    story.candidates.push_back({lift_off, fly(hoop, lift_off)});
  }
  if (story.candidates.empty()) return story;
  const Outcome& outcome = story.outcome;
  story.candidates.front().lift_off.time = outcome.first_jump_time;
  story.candidates.front().flight.height = outcome.first_jump_height;
  if (outcome.status == Status::jumped) {
    Candidate& jump = story.candidates.back();
    jump.lift_off.time = outcome.jump_time;
    jump.flight = {outcome.jump_height, outcome.apex_time, outcome.flight_time, outcome.dip};
  }
  return story;
}

}  // namespace leapmap
