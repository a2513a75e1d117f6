// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "trajectory/coulomb_integration.hpp"
#include "trajectory/rolling_integration.hpp"
#include "trajectory/trace_points.hpp"

namespace leapmap {
namespace {

Story of_rolling(const Design& design, const Scene& scene, const IntegrationOptions& options, double interval,
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
    const double start = jump.lift_off.time;
    const ContactState<double> lift_off = rolled(start, {jump.lift_off.angle, jump.lift_off.spin});
    story.points.push_back(rolling_point(hoop, lift_off));
    sampler.fly(hoop, lift_off, jump.flight.flight_time);
  }
  return story;
}

Story with_friction(const Design& design, const Scene& scene, const IntegrationOptions& options,
                    double interval) {
  const Hoop<double> hoop = derive<double>(design);
  const double mu = contact_of<double>(design, scene).mu_kinetic;
  Story story;
  TraceSampler sampler{interval, story.points};
  CoulombObserver observer;
  observer.phase = [&](Phase phase, const ContactState<double>& state, int direction) {
    story.phases.push_back({phase, state, direction});
  };
  observer.lift_off = [&](const LiftOff<double>& lift_off, const Flight<double>& flight) {
    story.candidates.push_back({lift_off, flight});
    if (!(interval > 0.0)) return;
    const ContactState<double>& from = story.phases.back().state;
    story.points.push_back(flight_point(hoop, from, 0.0));
    sampler.fly(hoop, from, flight.flight_time);
  };
  StepObserver step;
  if (interval > 0.0) {
    step = [&](Phase phase, int direction, const ContactState<double>& at, double end,
               const ContactMotion& motion) {
      sampler.until(at.time + end, [&](double t) {
        ContactState<double> state = at;
        if (t > at.time && !motion(t - at.time, state)) state.angle = NAN;
        return phase == Phase::rolling ? rolling_point(hoop, state)
                                       : sliding_point(hoop, direction * mu, state);
      });
    };
  }
  story.outcome = CoulombIntegration(options).solve(design, scene, observer, step);
  return story;
}

}  // namespace

Story tell_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                          double interval, double graze_limit) {
  return scene.friction == Friction::coulomb ? with_friction(design, scene, options, interval)
                                             : of_rolling(design, scene, options, interval, graze_limit);
}

}  // namespace leapmap
