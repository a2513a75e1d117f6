// SPDX-License-Identifier: GPL-3.0-or-later
/// The machine of contact_phases.hpp, for any way of rolling and sliding.
#pragma once

#include <cmath>

#include "coulomb/coulomb.hpp"
#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"
#include "physics/flight_search.hpp"
#include "physics/landing.hpp"
#include "physics/sliding.hpp"
#include "physics/stick.hpp"
#include "trajectory/jump_rule.hpp"
#include "trajectory/units.hpp"

namespace leapmap {

/// What a contact with v = 0 or v != 0 goes on as.
enum class ContactPhase { rolls, slides_forwards, slides_backwards, leaves };

/// Whether a contact with n0 <= 0, which would leave the plane were it not held, does.
enum class Leaving {
  unless_it_sticks,  ///< rolling on is consistent there too, and what rolls goes on rolling
  always,
  never
};

/// At v != 0 it slides; at v = 0 the forces of rolling decide.
template <class S>
ContactPhase contact_phase(const Hoop<S>& hoop, const Contact<S>& contact, const ContactState<S>& at,
                           Leaving leaving) {
  const Trig<S> phi = trig(at.angle);
  const bool would_leave =
      leaving != Leaving::never && free_normal_force(hoop, phi, at.spin * at.spin) <= S(0);
  if (would_leave && (leaving == Leaving::always || at.slip != S(0))) return ContactPhase::leaves;
  if (at.slip != S(0)) return at.slip > S(0) ? ContactPhase::slides_forwards : ContactPhase::slides_backwards;
  const auto guards =
      stick_guards(hoop, phi, S(at.spin * at.spin * contact_inertia(hoop, phi)), contact.mu_static);
  const S N = normal_force(hoop, phi, at.spin, angular_acceleration(hoop, phi, at.spin));
  if (N > S(0) && guards.downhill.value >= S(0) && guards.uphill.value >= S(0)) return ContactPhase::rolls;
  if (would_leave) return ContactPhase::leaves;
  return guards.uphill.value > guards.downhill.value ? ContactPhase::slides_backwards  // F points downhill
                                                     : ContactPhase::slides_forwards;
}

/// Goes through the phases until the design ends. roll(hoop, contact, state, runway) and slide(...,
/// direction) move the state to their phase's end, or as far as they came; direction is 1 or -1.
template <class S, class Roll, class Slide>
Outcome go_through_phases(const Design& design, const Scene& scene, const CoulombObserver& observer,
                          const Roll& roll, const Slide& slide) {
  using std::abs;
  const Hoop<S> hoop = derive<S>(design);
  const Contact<S> contact = contact_of<S>(design, scene);
  const S runway = S(2) * std::numbers::pi_v<S> * S(scene.runway);
  ContactState<S> at;
  at.angle = S(design.release_angle), at.spin = S(design.release_spin);
  const S released = contact_energy(hoop, at);

  Outcome outcome;
  PhaseSequence sequence;
  S slipped(0);
  const auto state = [&] {
    return ContactState<double>{static_cast<double>(at.time),  static_cast<double>(at.travel),
                                static_cast<double>(at.angle), static_cast<double>(at.spin),
                                static_cast<double>(at.slip),  static_cast<double>(at.normal)};
  };
  const auto end = [&](Status status, const char* reason = nullptr) {
    if (observer.end) observer.end(state());
    outcome.status = status;
    outcome.failure = reason;
    outcome.phase_sequence = sequence.code();
    if (status == Status::failed || status == Status::indeterminate) {
      const std::uint64_t phases = outcome.phase_sequence;
      outcome = {};
      outcome.status = status, outcome.failure = reason, outcome.phase_sequence = phases;
    } else {
      outcome.slip_distance = static_cast<double>(slipped);
      to_seconds(outcome, time_unit(scene));
    }
    return outcome;
  };
  const auto begin = [&](Phase phase, int direction) {
    sequence.append(phase);
    if (observer.phase) observer.phase(phase, state(), direction);
  };

  ContactPhase next = contact_phase(hoop, contact, at, Leaving::unless_it_sticks);
  if (next == ContactPhase::leaves) return end(Status::airborne_at_release);
  if (at.spin < S(0)) return end(Status::stalled);

  while (sequence.count() < most_phases) {
    PhaseEnd ended;
    if (next == ContactPhase::leaves) {
      ended = PhaseEnd::lifts_off;
    } else if (next == ContactPhase::rolls) {
      begin(Phase::rolling, 0);
      ended = roll(hoop, contact, at, runway);
    } else {
      const int direction = next == ContactPhase::slides_forwards ? 1 : -1;
      begin(Phase::sliding, direction);
      const ContactState<S> from = at;
      ended = slide(hoop, contact, at, runway, direction);
      slipped += abs((at.travel - from.travel) - (at.angle - from.angle));
    }
    switch (ended) {
      case PhaseEnd::slips_forwards:
      case PhaseEnd::slips_backwards:
        next = free_normal_force(hoop, trig(at.angle), S(at.spin * at.spin)) <= S(0) ? ContactPhase::leaves
               : ended == PhaseEnd::slips_forwards ? ContactPhase::slides_forwards
                                                   : ContactPhase::slides_backwards;
        continue;
      case PhaseEnd::slip_ends:
        next = contact_phase(hoop, contact, at, Leaving::unless_it_sticks);
        continue;
      case PhaseEnd::stalls:
        return end(Status::stalled);
      case PhaseEnd::runway_ends:
        return end(Status::no_jump);
      case PhaseEnd::indeterminate:
        return end(Status::indeterminate);
      case PhaseEnd::too_long:
        return end(Status::failed, "it slides on for longer than is followed");
      case PhaseEnd::failed:
        return end(Status::failed, "a phase could not be solved to the tolerance");
      case PhaseEnd::lifts_off:
        break;
    }

    begin(Phase::flight, 0);
    const LiftOff<S> lift_off{at.time, at.angle, at.spin};
    const Flight<S> flight = at.normal > S(0) ? fly_off(hoop, lift_off, at.normal) : fly(hoop, lift_off);
    const LiftOff<double> told{static_cast<double>(at.time), static_cast<double>(at.angle),
                               static_cast<double>(at.spin)};
    const Flight<double> flown{static_cast<double>(flight.height), static_cast<double>(flight.apex_time),
                               static_cast<double>(flight.flight_time), static_cast<double>(flight.dip)};
    const bool jumps = consider(outcome, scene, design, told, flown);
    if (observer.lift_off) observer.lift_off(told, flown);
    if (jumps) {
      outcome.jump_distance = static_cast<double>(at.travel);
      outcome.energy_lost = static_cast<double>(released - contact_energy(hoop, at));
    }
    const Trig<S> phi = trig(at.angle);
    const Sample<S> travel = travel_in_flight(hoop, phi, at.spin, at.slip, flight.flight_time);
    const S climb = height_above_plane(hoop, phi, at.spin, flight.flight_time, at.normal).rate;
    at.time += flight.flight_time;
    at.travel += travel.value;
    at.angle += at.spin * flight.flight_time;
    const Landing<S> landing = land(hoop, trig(at.angle), {travel.rate - at.spin, climb, at.spin},
                                    contact.mu_kinetic, contact.restitution, contact.rest_speed);
    if (jumps) {
      outcome.landing_spin = static_cast<double>(landing.after.spin);
      return end(Status::jumped);
    }
    if (!(at.travel < runway)) return end(Status::no_jump);
    at.spin = landing.after.spin, at.slip = landing.after.slip;
    at.normal = landing.after.normal;
    // A flight that rounding made of n0 = 0 takes no time; it is contact.
    next = at.normal > S(0) ? ContactPhase::leaves
                            : contact_phase(hoop, contact, at,
                                            flight.flight_time > S(0) ? Leaving::always : Leaving::never);
  }
  return end(Status::failed, "more phases than a design may go through");
}

}  // namespace leapmap
