// SPDX-License-Identifier: GPL-3.0-or-later
/// One design's motion with friction and without an integrator: sliding by Picard's iteration from sample to
/// sample.
#include <cmath>
#include <memory>

#include "friction/coulomb.hpp"
#include "friction/model.hpp"
#include "friction/recorded_way.hpp"
#include "hoop/units.hpp"
#include "noslip/rolling_motion.hpp"

namespace leapmap::friction {
namespace {

/// A phase as it begins, in the solver's units.
struct Begun {
  Phase phase;
  ContactState<double> state;
  int direction;
  std::vector<ContactState<double>> turns{};  ///< of a rolling one
};

/// The thread's solver to a tolerance. Its tables of nodes take longer to make than a design to solve.
CoulombSolver<double>& solver_of(double tolerance) {
  struct Made {
    double tolerance;
    CoulombSolver<double> solver;
  };
  thread_local std::unique_ptr<Made> last;
  if (!last || last->tolerance != tolerance)
    last = std::make_unique<Made>(Made{tolerance, CoulombSolver<double>(tolerance)});
  return last->solver;
}

}  // namespace

Outcome record(const Design& design, const Scene& scene, double tolerance, RecordedWay& recorded) {
  CoulombSolver<double>& solver = solver_of(tolerance);
  Outcome found;
  Sequences<double>([&](Start start, std::span<const Design>, std::span<ContactState<double>> at,
                        std::span<Outcome> outcome) {
    outcome[0] = recorded_way(solver, start, design, at[0], scene, recorded);
  }).solve({&design, 1}, scene, {&found, 1});
  return found;
}

Motion tell_exactly(const Design& design, const Scene& scene, double tolerance, double interval) {
  Motion motion;
  std::vector<Begun> phases;
  std::vector<Flight<double>> flights;
  ContactState<double> end;
  CoulombObserver observer;
  observer.phase = [&](Phase phase, const ContactState<double>& state, int direction) {
    phases.push_back({phase, state, direction, {}});
    motion.phases.push_back(in_si(phase, state, direction, scene));
  };
  observer.lift_off = [&](const LiftOff<double>& lift_off, const Flight<double>& flight) {
    flights.push_back(flight);
    motion.candidates.push_back(in_si(lift_off, flight, scene));
  };
  observer.turn = [&](const ContactState<double>& state) { phases.back().turns.push_back(state); };
  observer.end = [&](const ContactState<double>& state) { end = state; };
  CoulombSolver<double>& solver = solver_of(tolerance);
  Sequences<double>([&](Start start, std::span<const Design>, std::span<ContactState<double>> at,
                        std::span<Outcome> outcome) {
    outcome[0] = solver.solve(start, design, at[0], scene, observer);
  }).solve({&design, 1}, scene, {&motion.outcome, 1});
  if (!(interval > 0.0)) return motion;

  const Hoop<double> hoop = reduce<double>(design, scene);
  const double mu = contact_of<double>(design, scene).mu_kinetic, second = time_unit(scene);
  const SlidingLeg<double> sliding(motion_tolerance);
  RollingMotion sampled(hoop, interval / second, motion.points);
  auto flight = flights.begin();
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const auto& [phase, from, direction, turns] = phases[i];
    const bool is_last = i + 1 == phases.size();
    const ContactState<double>& to = is_last ? end : phases[i + 1].state;
    if (phase == Phase::rolling) {
      const bool stalls = is_last && motion.outcome.sequence_end == Status::stalled;
      ContactState<double> begin = from;
      for (const ContactState<double>& turn : turns) {
        sampled.roll(begin, turn.angle, true);
        begin = turn;
      }
      sampled.roll(begin, to.angle, stalls);
    } else if (phase == Phase::sliding) {
      ContactState<double> at = from;
      const double friction = direction * mu;
      sampled.until(to.time, [&, way = direction](double t) {
        if (!sliding.advance(hoop, mu, at, t - at.time, way)) at.angle = NAN;
        at.time = t;
        return sliding_point(hoop, friction, at);
      });
    } else {
      motion.points.push_back(flight_point(hoop, from, 0.0));
      sampled.fly(from, (flight++)->flight_time);
    }
  }
  motion.end = sampled.end() * second;
  to_si(motion.points, scene);
  return motion;
}

}  // namespace leapmap::friction
