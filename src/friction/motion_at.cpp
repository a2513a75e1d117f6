// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/motion_at.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "friction/contact_phases.hpp"
#include "friction/recorded_way.hpp"
#include "friction/slide_again.hpp"
#include "hoop/landing.hpp"
#include "hoop/sliding.hpp"
#include "hoop/stick.hpp"
#include "hoop/units.hpp"
#include "noslip/roll_at_times.hpp"
#include "numerics/panel_place.hpp"

namespace leapmap {
namespace {

/// The parameters of a design, with derivatives by some of them.
template <class S>
class Seeded {
 public:
  Seeded(const Design& design, std::span<const std::size_t> by) : design_(design), by_(by) {
    if constexpr (has_derivatives<S>) assert(by.size() <= S::derivatives);
  }

  S parameter(std::size_t number) const {
    // One parameter where it follows the other.
    if (number == by_mu_kinetic && kinetic_follows(design_)) number = by_mu_static;
    return seeded<S>(design_.*differentiable[number], number, by_);
  }
  Hoop<S> hoop(const Scene& scene) const {
    if constexpr (has_derivatives<S>) {
      std::array<S, without_slip> parameters;
      for (std::size_t k = 0; k < parameters.size(); ++k) parameters[k] = parameter(k);
      return reduce(parameters, scene);
    } else {
      return reduce<S>(design_, scene);
    }
  }

 private:
  const Design& design_;
  std::span<const std::size_t> by_;
};

/// Accelerations in contact.
template <class S>
struct ContactRates {
  S angular, slip;
};

/// Places of times on a panel of a slide that is solved.
template <class S>
class TimesOnPanel {
 public:
  using Grid = SpectralPanel<double, SlidingPanels<S>::nodes>;

  TimesOnPanel(const ContactState<S>& from, const typename SlidingPanels<S>::Panel& panel)
      : begun_(value_of(from.time)), duration_(value_of(panel.end.time) - begun_) {
    for (std::size_t i = 0; i < rate_.size(); ++i) rate_[i] = value_of(panel.time_rate[i]);
    times_ = shared_panel<Grid>().integrals(rate_);
  }
  double place_of(double time) const {
    return place_of_integral(shared_panel<Grid>(), times_, rate_, duration_, time - begun_);
  }

 private:
  double begun_, duration_;
  typename Grid::Values times_, rate_;
};

/// One design, phase after phase.
template <class S>
class Walk {
 public:
  /// holds: landings hold at once.
  Walk(const Seeded<S>& design, const Scene& scene, bool holds, double accuracy)
      : accuracy_(accuracy),
        holds_(holds),
        hoop_(design.hoop(scene)),
        contact_{design.parameter(by_mu_static), design.parameter(by_mu_kinetic),
                 design.parameter(by_restitution), S(scene.rest_speed)} {
    if (contact_.mu_static < contact_.mu_kinetic) contact_.mu_static = contact_.mu_kinetic;
    at_.angle = design.parameter(by_release_angle), at_.spin = design.parameter(by_release_spin);
  }

  /// Begins a phase where the solver does. False: the derivatives are of another state.
  bool begin(const ContactState<double>& there) {
    constexpr double agreement = 1e-4;
    if constexpr (has_derivatives<S>) {
      return take_values(at_, there, agreement);
    } else {
      at_ = there;
      return true;
    }
  }

  /// Rolls to where the next phase begins, or without end, and adds where the hoop is at times on the way.
  void roll(std::span<const double> turns, const ContactState<double>* to, std::span<const double> times,
            std::vector<MotionAt<S>>& taken) {
    constexpr double ever = std::numeric_limits<double>::infinity();
    RollAtTimes<S> phase(hoop_, at_, turns, to ? to->angle : ever, accuracy_);
    for (const double time : times) {
      const auto [state, acceleration] = phase.at(time);
      taken.push_back(
          {state.angle, state.travel, S(0.0), state.spin, value_of(state.spin), 0.0, acceleration});
    }
    if (to) at_ = phase.at(to->time).state;
  }
  /// The same of sliding, over the panels that are recorded, and on.
  bool slide(const RecordedSlide<double>& recorded, int direction, const ContactState<double>* to,
             std::span<const double> times, std::vector<MotionAt<S>>& taken) {
    static const SlidingPanels<S> panels(1e-12);
    const S friction = contact_.mu_kinetic * static_cast<double>(direction);
    std::size_t next = 0;
    const auto take = [&](const ContactState<S>& near) {
      const ContactState<S> at = at_time(near, times[next++], Phase::sliding, direction);
      const ContactRates<S> rates = rates_at(at, Phase::sliding, direction);
      taken.push_back({at.angle, at.travel, S(0.0), at.spin, value_of(at.slip) + value_of(at.spin), 0.0,
                       value_of(rates.angular)});
    };
    const auto read = [&](const auto& about, const ContactState<S>& from, const SlidePanel<S>& part,
                          const typename SlidingPanels<S>::Panel& panel) {
      if (next == times.size() || !(times[next] < value_of(panel.end.time))) return;
      const TimesOnPanel<S> on_panel(from, panel);
      while (next < times.size() && times[next] < value_of(panel.end.time))
        take(panels.state_within(about, from, part, panel, S(on_panel.place_of(times[next]))));
    };
    SlideAgain<S> again(panels, hoop_, friction);
    again.begin(at_);
    if (!again.over(recorded, at_, read)) return false;
    // After that only these times are left: within a rounding of the phase's end, or after the search's end
    // where the slide cannot be solved.
    if (!to && next < times.size() && !again.over_time(times.back() - value_of(at_.time), at_, read) &&
        at_.spin == S(0.0)) {
      taken.resize(taken.size() + times.size() - next,
                   {at_.angle, at_.travel, S(0.0), S(0.0), 0.0, 0.0, 0.0});
      return true;
    }
    while (next < times.size()) take(at_);
    return true;
  }
  /// Ends a phase of contact where the next one begins.
  void end_contact(Phase phase, int direction, Phase next) {
    const S later = lateness(phase, direction, next);
    at_ = moved(at_, later, phase, direction);
    if (phase == Phase::sliding && next != Phase::flight) at_.slip = S(0.0);
    at_.normal = S(0.0);
  }
  /// A flight, and its landing after flight_time; infinite: it never lands.
  void fly(double flight_time, std::span<const double> times, std::vector<MotionAt<S>>& taken) {
    const Trig<S> phi = trig(at_.angle);
    for (const double time : times) {
      const S t = S(time) - at_.time;
      const Turned<S> turned = turned_in_flight(hoop_, at_.spin, t);
      const Sample<S> travel = travel_in_flight(hoop_, phi, at_.spin, at_.slip, t);
      const auto height = height_above_plane(hoop_, phi, at_.spin, t, at_.normal);
      taken.push_back({at_.angle + turned.value, at_.travel + travel.value, height.value, turned.rate,
                       value_of(travel.rate), value_of(height.rate), value_of(hoop_.aloft)});
    }
    if (!std::isfinite(flight_time)) return;
    S flown(flight_time);
    if constexpr (has_derivatives<S>) {
      const auto end = height_above_plane(hoop_, phi, at_.spin, flown, at_.normal);
      flown = with_derivatives(flight_time, end.value, end.rate.value);
    }
    at_ = after_flight(hoop_, at_, flown);
    const Trig<S> landed = trig(at_.angle);
    const ContactVelocity<S> before{at_.slip, at_.normal, at_.spin};
    const Landing<S> landing =
        holds_ ? hold(hoop_, landed, before)
               : land(hoop_, landed, before, contact_.mu_kinetic, contact_.restitution, contact_.rest_speed);
    at_.spin = landing.after.spin, at_.slip = landing.after.slip, at_.normal = landing.after.normal;
  }

 private:
  ContactRates<S> rates_at(const ContactState<S>& at, Phase phase, int direction) const {
    const Trig<S> phi = trig(at.angle);
    if (phase == Phase::rolling) return {angular_acceleration(hoop_, phi, at.spin), S(0.0)};
    const SlidingMotion<S> motion = sliding_motion(hoop_, phi, S(at.spin * at.spin),
                                                   contact_.mu_kinetic * static_cast<double>(direction));
    return {motion.angular, motion.slip};
  }
  /// A state a little later, to first order.
  ContactState<S> moved(const ContactState<S>& at, const S& by, Phase phase, int direction) const {
    const ContactRates<S> rates = rates_at(at, phase, direction);
    return a_little_later(at, rates.angular, rates.slip, by);
  }
  /// At a time that a state is near.
  ContactState<S> at_time(const ContactState<S>& near, double time, Phase phase, int direction) const {
    return moved(near, S(time) - near.time, phase, direction);
  }
  /// How much later than its plain time a phase ends: no more than derivatives.
  S lateness(Phase phase, int direction, Phase next) const {
    if constexpr (has_derivatives<S>) {
      const Trig<S> phi = trig(at_.angle);
      const S spin = at_.spin;
      S zero(0.0);
      double rate = 1.0;
      if (phase == Phase::sliding) {
        const auto motion =
            sliding_motion(hoop_, phi, S(spin * spin), contact_.mu_kinetic * static_cast<double>(direction));
        zero = next == Phase::flight ? free_normal_force(hoop_, phi, S(spin * spin)) : at_.slip;
        rate = next == Phase::flight
                   ? spin.value * free_normal_force_rate(hoop_, phi, S(spin * spin), motion.angular).value
                   : motion.slip.value;
      } else if (next == Phase::flight) {
        const S acceleration = angular_acceleration(hoop_, phi, spin);
        zero = normal_force(hoop_, phi, spin, acceleration);
        rate = normal_force_rate(hoop_, phi, spin, acceleration).value;
      } else {
        const auto guards =
            stick_guards(hoop_, phi, S(spin * spin * contact_inertia(hoop_, phi)), contact_.mu_static);
        const Sample<S>& guard =
            abs(guards.downhill.value) < abs(guards.uphill.value) ? guards.downhill : guards.uphill;
        zero = guard.value, rate = guard.rate.value * spin.value;
      }
      return with_derivatives(0.0, zero, rate);
    } else {
      return 0.0;
    }
  }

  double accuracy_;
  bool holds_;
  Hoop<S> hoop_;
  Contact<S> contact_;
  ContactState<S> at_;
};

}  // namespace

template <class S>
std::vector<MotionAt<S>> motion_along(const RecordedWay& recorded, const Design& design, const Scene& scene,
                                      std::span<const double> times, double accuracy,
                                      std::span<const std::size_t> by) {
  const double second = time_unit(scene);
  std::vector<double> scaled;
  for (const double time : times) scaled.push_back(time / second);
  std::span<const double> left = scaled;
  std::vector<MotionAt<S>> taken;
  taken.reserve(times.size());
  Walk<S> walk(Seeded<S>(design, by), scene, recorded.holds, accuracy);
  std::size_t flight = 0, slide = 0;
  for (std::size_t k = 0; k < recorded.phases.size(); ++k) {
    const RecordedWay::Begun& phase = recorded.phases[k];
    const RecordedWay::Begun* then = k + 1 < recorded.phases.size() ? &recorded.phases[k + 1] : nullptr;
    const ContactState<double>* to = then ? &then->at : nullptr;
    if (!walk.begin(phase.at)) return {};
    const auto until = to ? std::lower_bound(left.begin(), left.end(), to->time) : left.end();
    const std::span<const double> here(left.begin(), until);
    left = left.subspan(here.size());
    if (phase.phase == Phase::flight) {
      walk.fly(to ? recorded.flights[flight++].flight_time : HUGE_VAL, here, taken);
      continue;
    }
    if (phase.phase == Phase::rolling) {
      walk.roll(phase.turns, to, here, taken);
    } else {
      const RecordedSlide<double> none{};  // of one that rocks to rest
      const bool is_recorded = slide < recorded.slides.size();
      if (!walk.slide(is_recorded ? recorded.slides[slide++] : none, phase.direction, to, here, taken))
        return {};
    }
    if (then) walk.end_contact(phase.phase, phase.direction, then->phase);
  }
  for (const MotionAt<S>& at : taken)
    if (!std::isfinite(value_of(at.phi)) || !std::isfinite(value_of(at.x)) || !std::isfinite(value_of(at.y)))
      return {};
  return taken;
}

template std::vector<MotionAt<double>> motion_along(const RecordedWay&, const Design&, const Scene&,
                                                    std::span<const double>, double,
                                                    std::span<const std::size_t>);
template std::vector<MotionAt<FewDual>> motion_along(const RecordedWay&, const Design&, const Scene&,
                                                     std::span<const double>, double,
                                                     std::span<const std::size_t>);
template std::vector<MotionAt<DesignDual>> motion_along(const RecordedWay&, const Design&, const Scene&,
                                                        std::span<const double>, double,
                                                        std::span<const std::size_t>);

}  // namespace leapmap
