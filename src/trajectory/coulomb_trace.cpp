// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "physics/sliding.hpp"
#include "trajectory/coulomb_integration.hpp"
#include "trajectory/trace_points.hpp"

namespace leapmap {
namespace {

/// friction: mu_kinetic, with the sign of the sliding.
TracePoint sliding_point(const Hoop<double>& hoop, double friction, const ContactState<double>& at) {
  const auto motion = sliding_motion(hoop, trig(at.angle), at.spin * at.spin, friction);
  return {at.time, at.angle, at.spin, at.travel, 0.0, motion.normal_force, motion.friction, Phase::sliding};
}

/// The motion sampled: contact by integration, flights in closed form.
std::vector<TracePoint> sample(const Design& design, const Scene& scene, double interval) {
  const Hoop<double> hoop = derive<double>(design);
  const double mu = contact_of<double>(design, scene).mu_kinetic;
  std::vector<TracePoint> points;
  TraceSampler sampler{interval, points};
  ContactState<double> now;
  CoulombObserver observer;
  observer.phase = [&](Phase, const ContactState<double>& state, int) { now = state; };
  observer.lift_off = [&](const LiftOff<double>&, const Flight<double>& flight) {
    points.push_back(flight_point(hoop, now, 0.0));
    sampler.until(now.time + flight.flight_time,
                  [&](double t) { return flight_point(hoop, now, t - now.time); });
    points.push_back(flight_point(hoop, now, flight.flight_time));
  };
  CoulombIntegration(adaptive("gsl-rk8pd", check_tolerance))
      .solve(design, scene, observer,
             [&](Phase phase, int direction, const ContactState<double>& at, double end,
                 const ContactMotion& motion) {
               sampler.until(at.time + end, [&](double t) {
                 ContactState<double> state = at;
                 if (t > at.time && !motion(t - at.time, state)) state.angle = NAN;
                 return phase == Phase::rolling ? rolling_point(hoop, state)
                                                : sliding_point(hoop, direction * mu, state);
               });
             });
  return points;
}

}  // namespace

Story tell_with_friction(const Design& design, const Scene& scene, const IntegrationOptions& options,
                         double tolerance, double interval) {
  Story story;
  CoulombObserver observer;
  observer.phase = [&](Phase phase, const ContactState<double>& state, int direction) {
    story.phases.push_back({phase, state, direction});
  };
  observer.lift_off = [&](const LiftOff<double>& lift_off, const Flight<double>& flight) {
    story.candidates.push_back({lift_off, flight});
  };
  if (options.stepper) {
    story.outcome = CoulombIntegration(options).solve(design, scene, observer);
    story.checked = CoulombSolver<double>(check_tolerance).solve(design, scene);
  } else {
    story.outcome = CoulombSolver<double>(tolerance).solve(design, scene, observer);
    story.checked = CoulombIntegration(adaptive("gsl-rk8pd", check_tolerance)).solve(design, scene);
  }
  if (interval > 0.0) story.points = sample(design, scene, interval);
  return story;
}

}  // namespace leapmap
