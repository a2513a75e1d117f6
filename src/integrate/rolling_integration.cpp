// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrate/rolling_integration.hpp"

#include <gsl/gsl_errno.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hoop/flight_search.hpp"
#include "hoop/jump_rule.hpp"
#include "hoop/landing.hpp"
#include "hoop/rolling_by_angle.hpp"
#include "hoop/units.hpp"
#include "trajectory/jump_measures.hpp"

namespace leapmap {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// Rolling conserves energy: a method that is off by more than this share of it has lost the motion. Far
/// looser than any tolerance worth having, it catches fixed steps and tolerances that are too long.
constexpr double most_energy_drift = 0.05;

constexpr const char* no_step = "the stepper found no step";
constexpr const char* no_event = "an event could not be located";
constexpr const char* energy_lost = "the energy is off by more than 5 %";
constexpr const char* out_of_steps = "more steps than max_steps";

template <class Model>
int right_hand_side(double, const double y[], double f[], void* params) {
  auto& system = *static_cast<typename Integration<Model>::System*>(params);
  ++system.evaluations;
  system.model.derivative(y, f);
  return GSL_SUCCESS;
}

template <class Model>
int jacobian(double, const double y[], double* dfdy, double dfdt[], void* params) {
  if constexpr (Model::has_jacobian) {
    static_cast<const typename Integration<Model>::System*>(params)->model.jacobian(y, dfdy);
    std::fill_n(dfdt, Model::dimension, 0.0);
    return GSL_SUCCESS;
  } else {
    return GSL_EUNIMPL;
  }
}

}  // namespace

template <class Model>
Integration<Model>::Integration(const IntegrationOptions& options)
    : options_(options),
      integrator_(*options.stepper, options.control,
                  {&right_hand_side<Model>, &jacobian<Model>, D, &system_}) {}

template <class Model>
Outcome Integration<Model>::solve(Start start, const Design& design, ContactState<double>& from,
                                  const Scene& scene, const Observer& observer) {
  Outcome outcome = roll(start, design, from, scene, observer);
  if (outcome.status == Status::jumped) {
    const Hoop<double>& hoop = system_.model.hoop;
    from = after_flight(hoop,
                        {.time = outcome.jump_time,
                         .travel = outcome.jump_distance,
                         .angle = outcome.jump_angle,
                         .spin = outcome.jump_spin,
                         .turned_in_flight = from.turned_in_flight},
                        outcome.flight_time);
    from.spin = spin_after_holding(hoop, trig(from.angle), from.slip + from.spin, from.normal, from.spin);
    from.slip = from.normal = 0.0;
  }
  to_seconds(outcome, time_unit(scene));
  return outcome;
}

template <class Model>
struct Integration<Model>::GuardsOf {
  System& system;
  const Rolling& rolling;

  void all(const State<D>& y, std::span<Sample<double>> guards) const {
    ++system.evaluations;
    const auto [normal_force, spin] = system.model.watched(y);
    guards[lift_off_guard] = normal_force;
    guards[turn_guard] = {rolling.way * spin.value, rolling.way * spin.rate};
  }
  Sample<double> operator()(std::size_t guard, const State<D>& y) const {
    std::array<Sample<double>, guard_count> guards;
    all(y, guards);
    return guards[guard];
  }
};

/// The method's own state inside the step.
template <class Model>
bool Integration<Model>::retake(double tau, State<D>& y) {
  if (!integrator_.retake(tau, y)) return false;
  if constexpr (Model::projects) system_.model.project(y);
  return true;
}

template <class Model>
bool Integration<Model>::advance() {
  if (!integrator_.advance()) return false;
  if constexpr (Model::projects) {
    State<D> y = integrator_.step().y1;
    system_.model.project(y);
    return integrator_.replace(y);
  }
  return true;
}

/// How long after the start of the step the hoop, which does not turn round between two moments, comes to an
/// angle.
template <class Model>
double Integration<Model>::time_at(double angle, double earliest, double latest) {
  const auto angle_at = [&](double tau) {
    State<D> y;
    return retake(tau, y) ? Sample<double>{system_.model.angle(y) - angle, system_.model.spin(y)}
                          : Sample<double>{NAN, 0.0};
  };
  const bool forwards = angle_at(latest).value > 0.0;
  return polish_root(angle_at, earliest, latest, 0.5 * (earliest + latest), forwards, 1e-15 * latest);
}

template <class Model>
bool Integration<Model>::is_believable(const State<D>& y, double energy) const {
  const Model& model = system_.model;
  const Trig<double> phi = trig(model.angle(y));
  const double kinetic = kinetic_energy(model.hoop, phi, model.spin(y));
  const double drift = kinetic + potential_energy(model.hoop, model.angle(y), phi) - energy;
  return std::abs(drift) <= most_energy_drift * (1.0 + kinetic);
}

template <class Model>
void Integration<Model>::tell_grazes(const Rolling& rolling, double end) {
  if (!rolling.observer.graze) return;
  for (const NearMiss& miss : steps_.falls(lift_off_guard).near_misses)
    if (State<D> y; miss.tau <= end && retake(miss.tau, y))
      rolling.observer.graze({rolling.from.time + integrator_.step().t0 + miss.tau, system_.model.angle(y),
                              miss.value, miss.minimum});
}

/// Flies off, tau after the start of the step. True: it is the jump.
template <class Model>
bool Integration<Model>::take(Rolling& rolling, const LiftOff<double>& lift_off, double tau) {
  const Flight<double> flight = fly(system_.model.hoop, lift_off);
  const bool is_jump = consider(rolling.outcome, rolling.scene, lift_off, flight,
                                lift_off.angle - (rolling.from.angle - rolling.from.travel));
  if (is_jump)
    keep_measures(measures_of(system_.model.hoop, lift_off.angle, lift_off.spin, flight.flight_time),
                  rolling.outcome);
  if (rolling.observer.step && is_jump && tau > 0.0) rolling.observer.step(integrator_, tau);
  if (rolling.observer.lift_off) rolling.observer.lift_off(lift_off, flight);
  return is_jump;
}

/// Takes the step's lift-offs up to the end of the way. True: the outcome is settled.
template <class Model>
bool Integration<Model>::take_lift_offs(Rolling& rolling, double end) {
  const Model& model = system_.model;
  const Falls<D>& found = steps_.falls(lift_off_guard);
  for (const Fall<D>& fall : found.falls) {
    const LiftOff<double> at{rolling.from.time + integrator_.step().t0 + fall.tau, model.angle(fall.state),
                             model.spin(fall.state)};
    if (fall.tau > end) break;
    if (!is_believable(fall.state, rolling.energy)) {
      rolling.outcome = failed_outcome(energy_lost);
      return true;
    }
    if (!take(rolling, at, fall.tau)) continue;
    // The minimum that made this fall lies just after it.
    const auto made_by = std::ranges::find_if(
        found.near_misses, [&](const NearMiss& miss) { return miss.minimum && miss.tau >= fall.tau; });
    tell_grazes(rolling, made_by == found.near_misses.end() ? fall.tau : made_by->tau);
    return true;
  }
  return false;
}

/// When in the step the way ends: at the end of the runway, or where a hoop that has turned round twice comes
/// to where it set out; infinity: later. Counts the turns until then.
template <class Model>
double Integration<Model>::end_of_way(Rolling& rolling) {
  const Model& model = system_.model;
  const Step<D>& step = integrator_.step();
  const double release = rolling.from.angle;
  double from = 0.0, travelled = model.angle(step.y0) - release;
  const auto part = [&](double to, double turned_to) {
    if (rolling.turns >= 2 && (travelled > 0.0) != (turned_to > 0.0)) {
      rolling.outcome.status = Status::stalled;
      return time_at(release, from, to);
    }
    if (const double there = rolling.from.travel + turned_to; std::abs(there) >= rolling.runway) {
      rolling.outcome.status = Status::no_jump;
      return time_at(release - rolling.from.travel + std::copysign(rolling.runway, there), from, to);
    }
    from = to, travelled = turned_to;
    return HUGE_VAL;
  };
  for (const Fall<D>& turned : steps_.falls(turn_guard).falls) {
    if (const double end = part(turned.tau, model.angle(turned.state) - release); end < HUGE_VAL) return end;
    if (const Hoop<double>& hoop = model.hoop; hoop.resistance != 0.0) {
      if (is_held(hoop, trig(model.angle(turned.state))))
        rolling.outcome.status = Status::stalled;
      else
        rolling.outcome = failed_outcome(reverses_against_resistance);
      return turned.tau;
    }
    ++rolling.turns;
    if (rolling.turns == 1) rolling.side = travelled;
    // From rest, or nearly, the second or third turn is at the release, or short of it by the method's error.
    const bool same_side = (travelled > 0.0) == (rolling.side > 0.0);
    if (rolling.turns == 3 || (rolling.turns == 2 && (same_side || rolling.from.spin == 0.0))) {
      rolling.outcome.status = Status::stalled;
      return turned.tau;
    }
  }
  return part(step.h, model.angle(step.y1) - release);
}

/// The spin falls to zero on the way down, and rises to it on the way up: it is seen so that it falls.
template <class Model>
void Integration<Model>::take_way(Rolling& rolling) {
  Sample<double>& spin = steps_.now(turn_guard);
  const double sign = spin.value > 0.0 || (spin.value == 0.0 && spin.rate > 0.0) ? 1.0 : -1.0;
  rolling.way *= sign;
  spin = {sign * spin.value, sign * spin.rate};
}

/// Takes a step, and what happens in it. True: the outcome is settled.
template <class Model>
bool Integration<Model>::step_on(Rolling& rolling) {
  take_way(rolling);
  // A look every 22.5 degrees: the normal force swings once or twice a revolution.
  const Stepped stepped = steps_.take(
      *this, [&](const State<D>& y) { return system_.model.angle(y); }, 8.0, GuardsOf{system_, rolling});
  const std::vector<Fall<D>>& turns = steps_.falls(turn_guard).falls;
  // A step in which it turns round twice is too long.
  const bool turned_twice = turns.size() > 1 || (!turns.empty() && !has_fallen(steps_.now(turn_guard)));
  if (stepped != Stepped::taken || turned_twice) {
    rolling.outcome = failed_outcome(stepped == Stepped::no_step ? no_step : no_event);
    return true;
  }
  const Step<D>& step = integrator_.step();
  const double end = end_of_way(rolling);
  const Status ended_as = rolling.outcome.status;
  if (ended_as == Status::failed) return true;
  rolling.outcome.status = Status::not_computed;
  if (take_lift_offs(rolling, end)) return true;
  if (!is_believable(step.y1, rolling.energy)) {
    rolling.outcome = failed_outcome(energy_lost);
    return true;
  }
  tell_grazes(rolling, end);
  if (rolling.observer.step) rolling.observer.step(integrator_, std::min(end, step.h));
  rolling.outcome.status = ended_as;
  return ended_as != Status::not_computed;
}

/// The outcome with its times in sqrt(R/g).
template <class Model>
Outcome Integration<Model>::roll(Start start, const Design& design, const ContactState<double>& from,
                                 const Scene& scene, const Observer& observer) {
  system_.model.set(reduce<double>(design, scene));
  const State<D> release = system_.model.rolling(from.angle, from.spin);
  Rolling rolling{from, scene, observer, rolling_energy(system_.model.hoop, from.angle, from.spin),
                  two_pi * scene.runway};
  steps_.begin(release, guard_count, GuardsOf{system_, rolling});
  if (steps_.now(lift_off_guard).value <= 0.0) {
    if (start == Start::release) rolling.outcome.status = Status::airborne_at_release;
    if (start == Start::release || take(rolling, {from.time, from.angle, from.spin}, 0.0))
      return rolling.outcome;
  }
  if (setting_out(system_.model.hoop, from.angle, trig(from.angle), from.spin) == 0.0) {
    rolling.outcome.status = Status::stalled;
    return rolling.outcome;
  }
  if (!integrator_.start(release, 0.01 / (1.0 + std::abs(steps_.now(turn_guard).value))))
    return failed_outcome(no_step);
  for (long taken = 0; taken < options_.max_steps; ++taken)
    if (step_on(rolling)) return rolling.outcome;
  return failed_outcome(out_of_steps);
}

template class Integration<OneCoordinate>;
template class Integration<Multipliers<false, false>>;
template class Integration<Multipliers<false, true>>;
template class Integration<Multipliers<true, false>>;
template class Integration<Multipliers<true, true>>;

}  // namespace leapmap
