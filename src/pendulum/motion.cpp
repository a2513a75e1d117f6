// SPDX-License-Identifier: GPL-3.0-or-later
/// One robot's motion, integrated in time.
#include <cmath>
#include <vector>

#include "hoop/units.hpp"
#include "pendulum/model.hpp"
#include "pendulum/solver.hpp"
#include "trajectory/trace_points.hpp"

namespace leapmap::pendulum {
namespace {

ContactState<double> contact_state(double time, const Y& at) {
  return {.time = time, .travel = at[x], .angle = at[phi], .spin = at[w], .slip = at[vx] - at[w]};
}

MotionPoint point_of(const System& system, double time, const Y& at) {
  const Forces<double> f = system.forces(at);
  const Phase phase = system.mode == ContactMode::rolls    ? Phase::rolling
                      : system.mode == ContactMode::slides ? Phase::sliding
                                                           : Phase::flight;
  return {time,  at[phi], at[w], at[x],   phase == Phase::flight ? at[y] : 0.0, f.normal, f.friction,
          phase, at[psi], at[u], f.torque};
}

}  // namespace

Motion tell_by_integration(const Design& design, const Scene& scene, const IntegrationOptions& options,
                           double interval) {
  Motion motion;
  const double every = interval / time_unit(scene);
  std::vector<MotionPoint> aloft;  // of the last flight, which may turn out to be none
  bool takes_off = true;
  MotionPoint landing{};
  TraceSampler contact{every, motion.points}, flight{every, aloft};
  const auto sample = [](TraceSampler& sampler, const TakenStep& step) {
    sampler.until(step.began + step.end, [&](double t) {
      Y at = step.from;
      if (t > step.began && !step.state_at(t - step.began, at)) at[phi] = NAN;
      return point_of(step.system, t, at);
    });
  };
  const auto fly = [&] {
    motion.points.insert(motion.points.end(), aloft.begin(), aloft.end());
    motion.points.push_back(landing);
    contact.next = flight.next;
  };
  Observer observer;
  observer.phase = [&](Phase phase, int direction, double time, const Y& at) {
    motion.phases.push_back(in_si(phase, contact_state(time, at), direction, scene));
  };
  if (interval > 0.0) {
    observer.contact_step = [&](const TakenStep& step) { sample(contact, step); };
    observer.flight_step = [&](const TakenStep& step) {
      if (takes_off) {
        aloft.assign(1, point_of(step.system, step.began, step.from));
        flight.next = static_cast<long>(std::floor(step.began / every)) + 1;
        takes_off = false;
      }
      sample(flight, step);
      if (Y at; step.state_at(step.end, at)) landing = point_of(step.system, step.began + step.end, at);
    };
  }
  const bool slips = scene.friction == Friction::coulomb;
  observer.lift_off = [&](double time, const Y& at, const Flight<double>& flown) {
    motion.candidates.push_back(in_si(LiftOff<double>{time, at[phi], at[w]}, flown, scene));
    takes_off = true;
    const bool ends = !slips && flown.height >= scene.hop_height;  // a flight that is a phase
    if (ends) motion.phases.push_back(in_si(Phase::flight, contact_state(time, at), 0, scene));
    if (interval > 0.0 && slips && flown.flight_time > 0.0) fly();
  };
  Solver solver(options);
  motion.outcome = solver.solve(design, scene, observer);
  if (interval > 0.0 && !slips && motion.outcome.status == Status::jumped) fly();  // after the step it ends
  to_si(motion.points, scene);
  motion.end = motion.points.empty() ? 0.0 : motion.points.back().t;
  return motion;
}

}  // namespace leapmap::pendulum
