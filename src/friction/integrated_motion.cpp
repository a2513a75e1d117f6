// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion with friction, integrated in time.
#include <cmath>

#include "friction/coulomb_integration.hpp"
#include "friction/model.hpp"
#include "hoop/units.hpp"
#include "trajectory/trace_points.hpp"

namespace leapmap::friction {

Motion tell_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                           double interval) {
  const Hoop<double> hoop = reduce<double>(design, scene);
  const double mu = contact_of<double>(design, scene).mu_kinetic;
  Motion motion;
  TraceSampler sampler{interval / time_unit(scene), motion.points};
  ContactState<double> last;
  CoulombObserver observer;
  observer.phase = [&](Phase phase, const ContactState<double>& state, int direction) {
    last = state;
    motion.phases.push_back(in_si(phase, state, direction, scene));
  };
  observer.lift_off = [&](const LiftOff<double>& lift_off, const Flight<double>& flight) {
    motion.candidates.push_back(in_si(lift_off, flight, scene));
    if (!(interval > 0.0)) return;
    motion.points.push_back(flight_point(hoop, last, 0.0));
    sampler.fly(hoop, last, flight.flight_time);
  };
  StepObserver step;
  if (interval > 0.0) {
    step = [&](Phase phase, int direction, const ContactState<double>& at, double end,
               const ContactMotion& moved) {
      sampler.until(at.time + end, [&](double t) {
        ContactState<double> state = at;
        if (t > at.time && !moved(t - at.time, state)) state.angle = NAN;
        return phase == Phase::rolling ? rolling_point(hoop, state)
                                       : sliding_point(hoop, direction * mu, state);
      });
    };
  }
  CoulombIntegration integration(options);
  Sequences<double>([&](Start start, std::span<const Design>, std::span<ContactState<double>> at,
                        std::span<Outcome> outcome) {
    outcome[0] = integration.solve(start, design, at[0], scene, observer, step);
  }).solve({&design, 1}, scene, {&motion.outcome, 1});
  to_si(motion.points, scene);
  if (!motion.points.empty()) motion.end = motion.points.back().t;
  return motion;
}

}  // namespace leapmap::friction
