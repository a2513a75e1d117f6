// SPDX-License-Identifier: GPL-3.0-or-later
/// The machine of contact_phases.hpp, for any way of rolling, sliding and flying: it tells which phase comes
/// next, is told how that ended, and lands by itself.
#pragma once

#include <cmath>

#include "friction/coulomb.hpp"
#include "hoop/flight_search.hpp"
#include "hoop/jump_rule.hpp"
#include "hoop/landing.hpp"
#include "hoop/sliding.hpp"
#include "hoop/stick.hpp"
#include "hoop/units.hpp"
#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"
#include "support/stop.hpp"
#include "trajectory/jump_measures.hpp"

namespace leapmap {

/// How a design goes on, or that it ends.
enum class NextPhase { rolls, slides_forwards, slides_backwards, leaves, ends };

/// The way that it slides, 1 or -1; 0: it does not.
inline int direction_of(NextPhase next) {
  return next == NextPhase::slides_forwards ? 1 : next == NextPhase::slides_backwards ? -1 : 0;
}

/// How far a design is followed that jumps; measured: what is in jump_measures.hpp is kept as well.
enum class Followed { to_lift_off, to_landing, to_measured_landing };

/// A contact at v != 0 slides; at v = 0 the forces of rolling decide.
template <class S>
NextPhase contact_phase(const Hoop<S>& hoop, const Contact<S>& contact, const ContactState<S>& at,
                        Leaving leaving) {
  const Trig<S> phi = trig(at.angle);
  const bool would_leave =
      leaving != Leaving::never && free_normal_force(hoop, phi, at.spin * at.spin) <= S(0);
  if (would_leave && (leaving == Leaving::always || at.slip != S(0))) return NextPhase::leaves;
  if (at.slip != S(0)) return at.slip > S(0) ? NextPhase::slides_forwards : NextPhase::slides_backwards;
  const auto guards =
      stick_guards(hoop, phi, S(at.spin * at.spin * contact_inertia(hoop, phi)), contact.mu_static);
  const S N = normal_force(hoop, phi, at.spin, angular_acceleration(hoop, phi, at.spin));
  if (N > S(0) && guards.downhill.value >= S(0) && guards.uphill.value >= S(0)) return NextPhase::rolls;
  if (would_leave) return NextPhase::leaves;
  return guards.uphill.value > guards.downhill.value ? NextPhase::slides_backwards  // F points downhill
                                                     : NextPhase::slides_forwards;
}

/// The flight of a hoop that leaves the plane, or rebounds from it.
template <class S>
Flight<S> flight_from(const Hoop<S>& hoop, const ContactState<S>& at) {
  const LiftOff<S> lift_off{at.time, at.angle, at.spin};
  return at.normal > S(0) ? fly_off(hoop, lift_off, at.normal) : fly(hoop, lift_off);
}

/// One design on its way through its phases, which fills in its outcome.
template <class S>
class PhaseMachine {
 public:
  /// from: the release, or a state just after a landing. Scene, observer and outcome have to outlive the
  /// machine.
  PhaseMachine(const Design& design, const ContactState<S>& from, const Scene& scene,
               const CoulombObserver& observer, Outcome& outcome,
               Followed followed = Followed::to_measured_landing)
      : scene_(&scene),
        observer_(&observer),
        outcome_(&outcome),
        hoop_(reduce<S>(design, scene)),
        contact_(contact_of<S>(design, scene)),
        runway_(S(2) * std::numbers::pi_v<S> * S(scene.runway)),
        resistance_(design.resisting_torque),
        followed_(followed) {
    put(from);
  }

  /// Lets the same design begin once more, from there. Its outcome is empty again.
  void put(const ContactState<S>& from) {
    at_ = from;
    released_ = contact_energy(hoop_, at_);
    slipped_ = driven_ = S(0);
    slides_ = false;
    sequence_ = {}, *outcome_ = {};
    rocking_.restart();
    const S rounding(1e-14);
    held_ = resistance_ > S(0) && at_.spin * at_.spin == S(0) &&
            std::abs(torque(hoop_, trig(at_.angle)) + hoop_.resistance) <= resistance_ * (S(1) + rounding);
  }

  NextPhase begin(Start start) {
    if (start == Start::landing) return go_on(phase_after_landing(Leaving::always));
    const NextPhase next = contact_phase(hoop_, contact_, at_, Leaving::unless_it_sticks);
    return next == NextPhase::leaves ? ended_as(Status::airborne_at_release) : go_on(next);
  }

  /// On from the end of the rolling or sliding that was told last, in which the hoop moved `to` there.
  NextPhase after(PhaseEnd end, const ContactState<S>& to) {
    using std::abs;
    driven_ += hoop_.motor() * (to.angle - at_.angle);
    if (slides_) slipped_ += abs((to.travel - at_.travel) - (to.angle - at_.angle));
    const S turned_in_flight = at_.turned_in_flight;
    at_ = to, at_.turned_in_flight = turned_in_flight;
    switch (end) {
      case PhaseEnd::slips_forwards:
      case PhaseEnd::slips_backwards:
        return go_on(free_normal_force(hoop_, trig(at_.angle), S(at_.spin * at_.spin)) <= S(0)
                         ? NextPhase::leaves
                     : end == PhaseEnd::slips_forwards ? NextPhase::slides_forwards
                                                       : NextPhase::slides_backwards);
      case PhaseEnd::slip_ends:
        return go_on(contact_phase(hoop_, contact_, at_, Leaving::unless_it_sticks));
      case PhaseEnd::lifts_off:
        return go_on(NextPhase::leaves);
      case PhaseEnd::stalls:
        if (hoop_.resistance == S(0) || held_ || is_held(hoop_, trig(at_.angle)))
          return ended_as(Status::stalled);
        [[fallthrough]];
      case PhaseEnd::reverses:
        return ended_as(Status::failed, reverses_against_resistance);
      case PhaseEnd::runway_ends:
        return ended_as(Status::no_jump);
      case PhaseEnd::indeterminate:
        return ended_as(Status::indeterminate);
      case PhaseEnd::too_long:
        return ended_as(Status::failed, "it slides on for longer than is followed");
      case PhaseEnd::failed:
        break;
    }
    return ended_as(Status::failed, "a phase could not be solved to the tolerance");
  }

  /// On from the flight that was told last: it lands, unless that was it.
  NextPhase after(const Flight<S>& flight) {
    const LiftOff<S> lift_off{at_.time, at_.angle, at_.spin};
    if (sinks_without_motor()) return ended_as(Status::indeterminate);
    begin_phase(Phase::flight, 0);
    const bool jumps = look_at(lift_off, flight);
    if (jumps && followed_ == Followed::to_lift_off) return ended_as(Status::jumped);
    const S left_at = at_.travel;
    const S left = at_.angle;
    at_ = after_flight(hoop_, at_, flight.flight_time);
    if (hoop_.aloft != S(0)) driven_ += hoop_.motor() * (at_.angle - left);
    if (!jumps && !(std::abs(at_.travel) < runway_)) return ended_as(Status::no_jump);
    const Landing<S> landing = land(hoop_, trig(at_.angle), {at_.slip, at_.normal, at_.spin},
                                    contact_.mu_kinetic, contact_.restitution, contact_.rest_speed);
    if (jumps && followed_ == Followed::to_measured_landing)
      keep_measures(measures_of(hoop_, S(at_.travel - left_at), at_, landing), *outcome_);
    at_.spin = landing.after.spin, at_.slip = landing.after.slip;
    at_.normal = landing.after.normal;
    if (!jumps && at_.spin * hoop_.resistance < S(0))
      return ended_as(Status::failed, reverses_against_resistance);
    if (jumps) {
      outcome_->landing_spin = static_cast<double>(at_.spin);
      return ended_as(Status::jumped);
    }
    // A flight that rounding made of n0 = 0 takes no time; it is contact.
    return go_on(phase_after_landing(flight.flight_time > S(0) ? Leaving::always : Leaving::never));
  }

  const Hoop<S>& hoop() const { return hoop_; }
  const Contact<S>& contact() const { return contact_; }
  /// How far the centre may travel.
  const S& runway() const { return runway_; }
  /// Where the last phase begins. Of a design that has ended: where it ended. For a jump that is just after
  /// the landing, or the lift-off if it is followed no further.
  const ContactState<S>& at() const { return at_; }

 private:
  NextPhase phase_after_landing(Leaving leaving) const {
    return at_.normal > S(0) ? NextPhase::leaves : contact_phase(hoop_, contact_, at_, leaving);
  }

  NextPhase go_on(NextPhase next) {
    if (sequence_.count() >= most_phases)
      return ended_as(Status::failed, contact_.restitution > S(0) && contact_.rest_speed < S(1e-12)
                                          ? endless_rebounds
                                          : "more phases than a design may go through");
    if (next == NextPhase::leaves) return next;
    // At rest the resistance is as large as it has to be for a hoop that does not slide.
    if (held_ && next != NextPhase::rolls) return ended_as(Status::failed, reverses_against_resistance);
    slides_ = next != NextPhase::rolls;
    if (!begin_phase(slides_ ? Phase::sliding : Phase::rolling, direction_of(next))) return next;
    ended_as(Status::stalled);
    outcome_->slip_distance = Outcome::none;  // it goes on slipping, a little less on every swing
    return NextPhase::ends;
  }

  /// Returns whether the hoop rocks to rest: the phase is then its last.
  bool begin_phase(Phase phase, int direction) {
    const ContactState<double> state = in_double(at_);
    sequence_.append(phase);
    if (observer_->phase) observer_->phase(phase, state, direction);
    return rocking_.settles(phase, direction, state.travel, state.angle, state.spin);
  }

  /// What is not known of a design that has no answer is not told.
  NextPhase ended_as(Status status, const char* reason = nullptr) {
    if (observer_->end) observer_->end(in_double(at_));
    if (status == Status::failed || status == Status::indeterminate) {
      *outcome_ = {};
    } else {
      outcome_->slip_distance = static_cast<double>(slipped_);
      to_seconds(*outcome_, time_unit(*scene_));
    }
    outcome_->status = status;
    outcome_->failure = reason;
    outcome_->phase_sequence = sequence_.code();
    return NextPhase::ends;
  }

  /// Whether it is the motor alone that lifts the hoop off, and idles in flight, so that the flight would
  /// begin by sinking into the plane, even if it came up again later. Neither contact nor flight is
  /// consistent then.
  bool sinks_without_motor() const {
    const bool idles = hoop_.motor() != S(0) && hoop_.aloft == S(0);
    if (!idles || at_.normal > S(0)) return false;
    return hoop_.cos_slope + hoop_.rho * trig(at_.angle).cos * at_.spin * at_.spin > S(1e-9);
  }

  /// Tells of a flight, and whether it is the jump.
  bool look_at(const LiftOff<S>& lift_off, const Flight<S>& flight) {
    const LiftOff<double> plain_lift_off{static_cast<double>(lift_off.time),
                                         static_cast<double>(lift_off.angle),
                                         static_cast<double>(lift_off.spin)};
    const Flight<double> flown{static_cast<double>(flight.height), static_cast<double>(flight.apex_time),
                               static_cast<double>(flight.flight_time), static_cast<double>(flight.dip)};
    const bool jumps = consider(*outcome_, *scene_, plain_lift_off, flown, static_cast<double>(at_.travel));
    if (observer_->lift_off) observer_->lift_off(plain_lift_off, flown);
    if (jumps) {
      outcome_->energy_lost = static_cast<double>(released_ + driven_ - contact_energy(hoop_, at_));
    }
    return jumps;
  }

  const Scene* scene_;
  const CoulombObserver* observer_;
  Outcome* outcome_;
  Hoop<S> hoop_;
  Contact<S> contact_;
  S runway_, resistance_;
  Followed followed_;
  S released_, slipped_;
  S driven_;            // work of the motor
  ContactState<S> at_;  // where the last phase began, or where all ended
  bool slides_;         // in the current phase
  bool held_;           // it begins at rest, and the resisting torque is the larger one
  PhaseSequence sequence_;
  Rocking rocking_;
};

/// Goes through the phases until the design ends. roll(hoop, contact, state, runway) and slide(...,
/// direction) move the state to their phase's end, or as far as they came; direction is 1 or -1.
template <class S, class Roll, class Slide>
Outcome go_through_phases(Start start, const Design& design, ContactState<S>& from, const Scene& scene,
                          const CoulombObserver& observer, const Roll& roll, const Slide& slide) {
  Outcome outcome;
  PhaseMachine<S> machine(design, from, scene, observer, outcome);
  for (NextPhase next = machine.begin(start); next != NextPhase::ends;) {
    throw_if_stopped();
    if (next == NextPhase::leaves) {
      next = machine.after(flight_from(machine.hoop(), machine.at()));
      continue;
    }
    ContactState<S> at = machine.at();
    const PhaseEnd end =
        next == NextPhase::rolls
            ? roll(machine.hoop(), machine.contact(), at, machine.runway())
            : slide(machine.hoop(), machine.contact(), at, machine.runway(), direction_of(next));
    next = machine.after(end, at);
  }
  if (outcome.status == Status::jumped) from = machine.at();
  return outcome;
}

}  // namespace leapmap
