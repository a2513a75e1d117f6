// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion without slip, integrated in time.
#include <cmath>

#include "hoop/units.hpp"
#include "integrate/rolling_integration.hpp"
#include "noslip/model.hpp"
#include "noslip/rolling_motion.hpp"

namespace leapmap::noslip {

Motion tell_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                           double interval, double graze_limit) {
  const Hoop<double> hoop = reduce<double>(design, scene);
  const double second = time_unit(scene);
  Motion motion;
  TraceSampler sampler{interval / second, motion.points};
  ContactState<double> from;
  const auto rolled = [&](double t, const OneCoordinate::Y& y) {
    return ContactState<double>{
        .time = t, .travel = from.travel + (y[0] - from.angle), .angle = y[0], .spin = y[1]};
  };

  RollingObserver observer;
  LiftOff<double> last;
  Flight<double> flown;
  observer.lift_off = [&](const LiftOff<double>& lift_off, const Flight<double>& flight) {
    last = lift_off, flown = flight;
    motion.candidates.push_back(in_si(lift_off, flight, scene));
  };
  observer.graze = [&](const Graze& graze) {
    if (std::abs(graze.normal_force) >= graze_limit) return;
    motion.grazes.push_back(graze);
    motion.grazes.back().t *= second;
  };
  if (interval > 0.0) {
    observer.step = [&](const GslIntegrator<2>& integrator, double end) {
      const double t0 = from.time + integrator.step().t0;
      sampler.until(t0 + end, [&](double t) {
        OneCoordinate::Y y = integrator.step().y0;
        if (!integrator.retake(t - t0, y)) y.fill(NAN);
        return rolling_point(hoop, rolled(t, y));
      });
    };
  }
  RollingIntegration integration(options);
  Sequences<double>([&](Start start, std::span<const Design>, std::span<ContactState<double>> at,
                        std::span<Outcome> outcome) {
    from = at[0];
    outcome[0] = integration.solve(start, design, at[0], scene, observer);
    if (outcome[0].status == Status::airborne_at_release || way_of(hoop, from.angle, from.spin) == 0.0)
      return;
    const bool jumps = outcome[0].status == Status::jumped;
    if (!jumps || last.time > from.time) motion.phases.push_back(in_si(Phase::rolling, from, 0, scene));
    if (!jumps) return;
    const ContactState<double> lift_off = rolled(last.time, {last.angle, last.spin});
    motion.phases.push_back(in_si(Phase::flight, lift_off, 0, scene));
    if (interval > 0.0) {
      motion.points.push_back(rolling_point(hoop, lift_off));
      sampler.fly(hoop, lift_off, flown.flight_time);
    }
  }).solve({&design, 1}, scene, {&motion.outcome, 1});
  to_si(motion.points, scene);
  if (!motion.points.empty()) motion.end = motion.points.back().t;
  return motion;
}

}  // namespace leapmap::noslip
