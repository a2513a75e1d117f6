// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>

#include "physics/sliding.hpp"
#include "support/errors.hpp"
#include "trajectory/coulomb_integration.hpp"
#include "trajectory/trace.hpp"

namespace leapmap {
namespace {

constexpr double most_points = 1e7;
constexpr double check_tolerance = 1e-12;

/// slide_friction: mu_kinetic, with the sign of the sliding.
TracePoint contact_point(const Hoop<double>& hoop, double slide_friction, Phase phase,
                         const ContactState<double>& at) {
  const Trig<double> phi = trig(at.angle);
  double normal = 0.0, friction = 0.0;
  if (phase == Phase::rolling) {
    const double acceleration = angular_acceleration(hoop, phi, at.spin);
    normal = normal_force(hoop, phi, at.spin, acceleration);
    friction = friction_force(hoop, phi, at.spin, acceleration);
  } else {
    const auto motion = sliding_motion(hoop, phi, at.spin * at.spin, slide_friction);
    normal = motion.normal_force, friction = motion.friction;
  }
  return {at.time, at.angle, at.spin, at.travel, 0.0, normal, friction, phase};
}

TracePoint flight_point(const Hoop<double>& hoop, const ContactState<double>& from, double flown) {
  const Trig<double> phi = trig(from.angle), turned = trig(from.spin * flown);
  const double y =
      hoop.rho * (phi.sin * x_minus_sin(from.spin * flown, turned.sin) - phi.cos * turned.versine) +
      flown * (from.normal - 0.5 * hoop.cos_slope * flown);
  return {from.time + flown,
          from.angle + from.spin * flown,
          from.spin,
          from.travel + travel_in_flight(hoop, phi, from.spin, from.slip, flown).value,
          y,
          0.0,
          0.0,
          Phase::flight};
}

/// The motion sampled: contact by integration, flights in closed form.
std::vector<TracePoint> sample(const Design& design, const Scene& scene, double interval) {
  const Hoop<double> hoop = derive<double>(design);
  const double mu = contact_of<double>(design, scene).mu_kinetic;
  std::vector<TracePoint> points;
  long next = 0;  // sample
  const auto sample_until = [&](double end, const auto& point_at) {
    if (!(end / interval < most_points))
      throw InputError(
          fmt::format("a trace of more than {} points; allowed: a longer interval", most_points));
    for (; interval * static_cast<double>(next) <= end; ++next)
      points.push_back(point_at(interval * static_cast<double>(next)));
  };
  ContactState<double> now;
  CoulombObserver observer;
  observer.phase = [&](Phase, const ContactState<double>& state, int) { now = state; };
  observer.lift_off = [&](const LiftOff<double>&, const Flight<double>& flight) {
    points.push_back(flight_point(hoop, now, 0.0));
    sample_until(now.time + flight.flight_time,
                 [&](double t) { return flight_point(hoop, now, t - now.time); });
    points.push_back(flight_point(hoop, now, flight.flight_time));
  };
  CoulombIntegration(adaptive("gsl-rk8pd", check_tolerance))
      .solve(design, scene, observer,
             [&](Phase phase, int direction, const ContactState<double>& at, double end,
                 const ContactMotion& motion) {
               sample_until(at.time + end, [&](double t) {
                 ContactState<double> state = at;
                 if (t > at.time && !motion(t - at.time, state)) state.angle = NAN;
                 return contact_point(hoop, direction * mu, phase, state);
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
