// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/gradient.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "friction/model.hpp"
#include "friction/panel_forces.hpp"
#include "friction/recorded_way.hpp"
#include "friction/slide_again.hpp"
#include "hoop/landing.hpp"
#include "hoop/sliding.hpp"
#include "hoop/stick.hpp"
#include "hoop/units.hpp"
#include "trajectory/jump_measures.hpp"

namespace leapmap {
namespace {

/// A guard, in weights, that passes zero more slowly than this, per sqrt(R/g) or per radian: its zero is
/// known to so few digits that no derivative is worth telling.
constexpr double slowest = 1e-4;
/// The chain of duals repeats the plain solver's states so closely, or something was not as it seemed.
constexpr double agreement = 1e-6;

/// As contact_of has it. Where mu_kinetic follows mu_static both are one parameter, and so they are where
/// mu_static, being less than mu_kinetic, counts as much. Constants for a StateDual.
template <class D>
Contact<D> contact_for(const Design& design, const Scene& scene) {
  if constexpr (!is_by_design<D>) {
    return contact_of<D>(design, scene);
  } else {
    const bool one = kinetic_follows(design) || design.mu_static < design.mu_kinetic;
    const D fixed = kinetic_follows(design) ? D::parameter(design.mu_static, by_mu_static)
                                            : D::parameter(design.mu_kinetic, by_mu_kinetic);
    return {one ? fixed : D::parameter(design.mu_static, by_mu_static), fixed,
            D::parameter(design.restitution, by_restitution), D(scene.rest_speed)};
  }
}

/// The chain of one design's phases.
template <class D>
class Chain {
 public:
  Chain(const Hoop<D>& hoop, const Contact<D>& contact, const ContactState<D>& from, double second,
        const SlidingPanels<D>& panels, const SlidingPanels<double>& plain_panels,
        const DualTime<DesignDual>& time)
      : panels_(panels),
        plain_panels_(plain_panels),
        time_(time),
        second_(second),
        contact_(contact),
        hoop_(hoop),
        at_(from) {
    turns_on_ = any_aloft(hoop);
    released_ = contact_energy(hoop_, at_);
  }

  /// Asks for what the way to the jump asks of hoop and motor.
  void follow_way() { meter_.emplace(hoop_, at_.spin); }

  /// put(quantity, value, unit) takes what is known; a chain that breaks puts no more, and returns false.
  template <class Put>
  bool run(const RecordedWay& recorded, const Outcome& outcome, const Put& put) {
    std::size_t flight = 0, slide = 0;
    for (std::size_t k = 0; k < recorded.phases.size(); ++k) {
      const RecordedWay::Begun& begun = recorded.phases[k];
      const bool last = k + 1 == recorded.phases.size();
      const ContactState<double>& next = last ? recorded.end : recorded.phases[k + 1].at;
      if (!agrees(begun.at)) return false;
      switch (begun.phase) {
        case Phase::rolling:
          if (last) break;  // it stalls, or the runway ends: nothing slips any more
          if (!roll(begun, next)) return false;
          break;
        case Phase::sliding:
          if (slide == recorded.slides.size()) break;  // it rocks to rest, which nobody followed
          if (!slide_on(recorded.slides[slide++], begun.direction, next,
                        !last && recorded.phases[k + 1].phase == Phase::flight))
            return false;
          break;
        case Phase::flight:
          fly(recorded.flights[flight], flight == 0, last && outcome.status == Status::jumped, put);
          ++flight;
          break;
      }
    }
    put(&Outcome::slip_distance, slipped_, 1.0);
    return true;
  }

  /// Where it came to: of a jump just after its landing.
  const ContactState<D>& at() const { return at_; }

 private:
  /// Takes the plain solver's values, if the chain came to the same.
  bool agrees(const ContactState<double>& there) {
    if constexpr (!is_by_design<D>) at_.time = D(there.time);
    return take_values(at_, there, agreement);
  }

  bool roll(const RecordedWay::Begun& begun, const ContactState<double>& to) {
    const Roll<D> roll = begin_roll(hoop_, at_.angle, at_.spin);
    const D there(to.angle);
    const D E = vis_viva_past_release(roll, D(there - at_.angle));
    const Trig<D> phi = trig(there);
    const StickGuards<D> guards = stick_guards(hoop_, phi, E, contact_.mu_static);
    const Sample<D>& guard =
        abs(guards.downhill.value) < abs(guards.uphill.value) ? guards.downhill : guards.uphill;
    const double J = contact_inertia(hoop_, phi).value;
    if (!(std::abs(guard.rate.value) > slowest * J * J)) return false;
    const D end = with_derivatives(to.angle, guard.value, guard.rate.value);
    const D left = vis_viva_past_release(roll, D(end - at_.angle)) / contact_inertia(hoop_, trig(end));
    if (!(left > D(0.0))) return false;
    with_meter([&](auto& meter) { meter.roll(roll, at_.spin, begun.turns, end); });
    if constexpr (is_by_design<D>) at_.time += time_.time(hoop_, at_.angle, at_.spin, begun.turns, end);
    at_.travel += end - at_.angle;
    driven_ += hoop_.motor() * (end - at_.angle);
    at_.angle = end;
    at_.spin = to.spin < 0.0 ? -sqrt(left) : sqrt(left);
    return true;
  }

  bool slide_on(const RecordedSlide<double>& taken, int direction, const ContactState<double>& to,
                bool then_flies) {
    const ContactState<D> from = at_;
    const D friction = contact_.mu_kinetic * static_cast<double>(direction);
    SlideAgain<D> slide(panels_, hoop_, friction);
    slide.begin(at_);
    const bool is_known = slide.over(taken, at_, [&](const auto&... of_panel) {
      with_meter([&](auto& meter) { meet(meter, of_panel...); });
    });
    if (!is_known) return false;
    const Trig<D> phi = trig(at_.angle);
    const SlidingMotion<D> motion = sliding_motion(hoop_, phi, at_.spin * at_.spin, friction);
    const double travels = at_.slip.value + at_.spin.value;
    // What is zero here, and how fast it falls or rises.
    const bool slip_ends = to.slip == 0.0;
    const D zero = slip_ends    ? at_.slip
                   : then_flies ? free_normal_force(hoop_, phi, at_.spin * at_.spin)
                                : at_.travel;
    const double rate =
        slip_ends ? motion.slip.value
        : then_flies
            ? at_.spin.value * free_normal_force_rate(hoop_, phi, at_.spin * at_.spin, motion.angular).value
            : travels;
    if (!(std::abs(rate) > slowest)) return false;
    for (std::size_t k = 0; k < zero.by.size(); ++k) {
      const double later = -zero.by[k] / rate;
      at_.time.by[k] += later;
      at_.angle.by[k] += later * at_.spin.value;
      at_.spin.by[k] += later * motion.angular.value;
      at_.slip.by[k] += later * motion.slip.value;
      at_.travel.by[k] += later * travels;
    }
    const D turned = at_.angle - from.angle;
    with_meter([&](auto& meter) {
      const D force = sliding_motion(hoop_, trig(at_.angle), at_.spin * at_.spin, friction).normal_force;
      meter.meet({force, at_.spin}), meter.turn(turned);
    });
    if (slip_ends) at_.slip = D(0.0);
    driven_ += hoop_.motor() * turned;
    slipped_ += abs(at_.travel - from.travel - turned);
    return true;
  }

  /// The largest force and spins within a panel, which are looked for in plain numbers.
  void meet(WayMeter<D>& meter, const typename SlidingPanels<D>::Slide& slide, const ContactState<D>& at,
            const SlidePanel<D>& part, const typename SlidingPanels<D>::Panel& panel) {
    const SlidingPanels<double>::Slide plain_slide{
        mapped<double>(hoop_, [](const D& number) { return number.value; }),
        slide.friction.value,
        {},
        {},
        slide.free_force.value};
    SlidePanel<double> plain_part{{}, part.duration.value};
    if (part.stretch)
      plain_part.stretch = {part.stretch->shift.value, part.stretch->begin.value, part.stretch->span.value,
                            part.stretch->curve.value};
    const ContactState<double> from = plain(at);
    SlidingPanels<double>::Panel plain_panel;
    plain_panels_.solve(plain_slide, from, plain_part, plain_panel);
    const PanelForces<double> known(plain_panels_, plain_slide, from, plain_part, plain_panel);
    const PanelForces<D> forces(panels_, slide, at, part, panel);
    meter.slide([&](double place) { return known.rated_at(place); },
                [&](double place) { return forces.at(place); });
  }

  /// Calls use(meter), if there is one.
  template <class Use>
  void with_meter(const Use& use) {
    if constexpr (is_by_design<D>)
      if (meter_) use(*meter_);
  }

  template <class Put>
  void fly(const Flight<double>& flight, bool first, bool jumps, const Put& put) {
    const Trig<D> phi = trig(at_.angle);
    const FlightDual<D> flown =
        with_derivatives(hoop_, phi, at_.spin, at_.normal, flight.apex_time, flight.flight_time);
    if (first) {
      put(&Outcome::first_jump_height, flown.height, 1.0);
      if constexpr (is_by_design<D>) put(&Outcome::first_jump_time, at_.time, second_);
    }
    if (jumps) {
      put_jump(put, at_.angle, at_.spin, at_.travel, flown, second_);
      if constexpr (is_by_design<D>) put(&Outcome::jump_time, at_.time, second_);
      put(&Outcome::dip,
          D(0.5) * height_above_plane(hoop_, phi, at_.spin, D(deepest(flight)), at_.normal).value, 1.0);
      put(&Outcome::energy_lost, released_ + driven_ - contact_energy(hoop_, at_), 1.0);
    }
    with_meter([&](auto& meter) {
      if (jumps)
        put_way(meter.way(), [&](double Outcome::*quantity, const D& value) { put(quantity, value, 1.0); });
      meter.fly(at_.spin, flown.flight_time);
    });
    const D left_at = at_.travel, left = at_.angle;
    at_ = after_flight(hoop_, at_, flown.flight_time);
    if (turns_on_) driven_ += hoop_.motor() * (at_.angle - left);
    const Landing<D> landing = land(hoop_, trig(at_.angle), {at_.slip, at_.normal, at_.spin},
                                    contact_.mu_kinetic, contact_.restitution, contact_.rest_speed);
    if (jumps)
      put_measures(measures_of(hoop_, D(at_.travel - left_at), at_, landing), D(1.0),
                   [&](double Outcome::*kept, const D& value) { put(kept, value, 1.0); });
    at_.spin = landing.after.spin, at_.slip = landing.after.slip, at_.normal = landing.after.normal;
    if (jumps) put(&Outcome::landing_spin, at_.spin, 1.0);
  }

  /// When the flight is deepest below the plane before its apex; zero: it never is.
  double deepest(const Flight<double>& flight) const {
    if (!(flight.dip < 0.0)) return 0.0;
    Hoop<double> hoop{};  // of which a flight sees these
    hoop.cos_slope = hoop_.cos_slope.value, hoop.rho = hoop_.rho.value, hoop.aloft = hoop_.aloft.value;
    return lowest_time(hoop, at_.angle.value, at_.spin.value, at_.normal.value, flight.apex_time);
  }

  const SlidingPanels<D>& panels_;
  const SlidingPanels<double>& plain_panels_;
  const DualTime<DesignDual>& time_;
  double second_;
  Contact<D> contact_;
  Hoop<D> hoop_;
  bool turns_on_;  // the motor, in flight
  ContactState<D> at_;
  D released_{0.0}, driven_{0.0}, slipped_{0.0};
  std::optional<WayMeter<D>> meter_;
};

}  // namespace

template <class D>
template <class Put>
void CoulombJumps<D>::derive(const Design& design, const Scene& scene, const Outcome& solved,
                             bool follows_way, const Put& put) {
  RecordedWay recorded;
  ContactState<double> at = released<double>(design);
  if (!same_flags(solved, recorded_way(plain_, Start::release, design, at, scene, recorded))) return;
  Chain<D> chain(reduce(dual_parameters<D>(design), scene), contact_for<D>(design, scene),
                 dual_release(design), time_unit(scene), panels_, plain_panels_, time_);
  if (follows_way) chain.follow_way();
  chain.run(recorded, solved, put);
}

template <class D>
Outcome CoulombJumps<D>::jump(Start start, const Design& design, const Scene& scene, ContactState<D>& at,
                              const PutDual<D>& put) {
  RecordedWay recorded;
  ContactState<double> landed = plain(at);
  Outcome outcome = recorded_way(plain_, start, design, landed, scene, recorded);
  if (outcome.status != Status::jumped) return outcome;
  Chain<D> chain(reduce(parameters_for<D>(design), scene), contact_for<D>(design, scene), at,
                 time_unit(scene), panels_, plain_panels_, time_);
  const bool known =
      chain.run(recorded, outcome, [&](double Outcome::*quantity, const D& value, double unit) {
        if (put) put(quantity, value, unit);
      });
  at = chain.at();
  set_values(at, landed);
  if (!known)
    for (D* number : {&at.time, &at.travel, &at.angle, &at.spin, &at.slip, &at.normal})
      number->by.fill(std::numeric_limits<double>::quiet_NaN());
  return outcome;
}

void CoulombGradients::solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
                             Gradients& gradients) {
  for (std::size_t i = 0; i < designs.size(); ++i) outcomes[i] = solver_.solve(designs[i], scene);
  derive_solved(designs, scene, outcomes, gradients);
}

void CoulombGradients::derive_solved(std::span<const Design> designs, const Scene& scene,
                                     std::span<const Outcome> outcomes, Gradients& gradients) {
  gradients.begin(designs.size());
  const std::vector<OutcomeNumber>& asked = gradients.wanted().of;
  const bool follows_ways = std::any_of(asked.begin(), asked.end(), is_of_way);
  for (std::size_t i = 0; i < designs.size(); ++i) {
    if (outcomes[i].status == Status::failed || outcomes[i].status == Status::indeterminate ||
        !(gradients.wanted().any_of_first_jump_in(outcomes[i]) ||
          (follows_ways && outcomes[i].status == Status::jumped)))
      continue;
    const auto put = [&](double Outcome::*quantity, DesignDual value, double unit) {
      if (kinetic_follows(designs[i])) value.by[by_mu_kinetic] = std::numeric_limits<double>::quiet_NaN();
      if (is_of_way(quantity) || std::isfinite(outcomes[i].*quantity))
        gradients.put(quantity, i, value, unit);
    };
    duals_.derive(designs[i], scene, outcomes[i], follows_ways, put);
  }
}

GradientSolver friction::gradients(const Scene& scene, double tolerance, const Wanted& wanted,
                                   const GradientWanted&) {
  Scene to_first = scene;
  to_first.jumps = 1;
  const GradientSolver first =
      [solver = std::make_shared<CoulombGradients>(tolerance), plain = exact(to_first, tolerance, wanted),
       scene](std::span<const Design> designs, std::span<Outcome> outcomes, Gradients& gradients) {
        plain(designs, outcomes);
        solver->derive_solved(designs, scene, outcomes, gradients);
      };
  if (scene.jumps == 1) return first;
  return in_sequence(first, jumps(scene, tolerance, wanted), dual_jumps(scene, tolerance), scene);
}

namespace {

template <class D>
DualJumpSolver<D> jumps_in(const Scene& scene, double tolerance) {
  return [solver = std::make_shared<CoulombJumps<D>>(tolerance), scene](
             Start start, const Design& design, ContactState<D>& at, const PutDual<D>& put) {
    return solver->jump(start, design, scene, at, put);
  };
}

}  // namespace

DualJumpSolver<DesignDual> friction::dual_jumps(const Scene& scene, double tolerance) {
  return jumps_in<DesignDual>(scene, tolerance);
}
DualJumpSolver<StateDual> friction::state_jumps(const Scene& scene, double tolerance) {
  return jumps_in<StateDual>(scene, tolerance);
}

}  // namespace leapmap
