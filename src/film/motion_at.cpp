// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/motion_at.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "friction/contact_phases.hpp"
#include "hoop/landing.hpp"
#include "hoop/sliding.hpp"
#include "hoop/stick.hpp"
#include "hoop/units.hpp"
#include "model/model.hpp"
#include "trajectory/gradient.hpp"

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

/// What moves in contact: angle, spin, travel, slip.
template <class S>
using Moving = std::array<S, 4>;
/// What is integrated of it, angle and spin; travel and slip follow from them and the time.
template <class S>
using Turning = std::array<S, 2>;

template <class S>
Turning<S> stepped(const Turning<S>& from, const Turning<S>& rate, double by) {
  return {from[0] + rate[0] * by, from[1] + rate[1] * by};
}

/// Gragg's midpoint steps over a span, so many.
template <class S, class Rate>
Turning<S> midpoint_steps(const Turning<S>& from, double span, int count, const Rate& rate) {
  const double h = span / count;
  Turning<S> before = from, at = stepped(from, rate(from), h);
  for (int k = 1; k < count; ++k) {
    const Turning<S> next = stepped(before, rate(at), 2.0 * h);
    before = at, at = next;
  }
  const Turning<S> last = stepped(before, rate(at), h);
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = (at[i] + last[i]) * 0.5;
  return at;
}

/// Over a span of time by extrapolation, in halves where that does not agree with itself.
template <class S, class Rate>
Turning<S> integrated(const Turning<S>& from, double span, const Rate& rate, double allowed, long& budget,
                      int depth = 0) {
  constexpr std::array counts{2, 4, 6, 8, 10};
  constexpr double longest = 0.3;
  constexpr int most_halvings = 30;
  if (--budget < 0) {  // nothing to be followed: it is not told
    const S lost(std::numeric_limits<double>::quiet_NaN());
    return {lost, lost};
  }
  const auto halved = [&] {
    return integrated(integrated(from, 0.5 * span, rate, allowed, budget, depth + 1), 0.5 * span, rate,
                      allowed, budget, depth + 1);
  };
  if (span > longest && depth < most_halvings) return halved();
  std::array<Turning<S>, counts.size()> before, row;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    row[0] = midpoint_steps(from, span, counts[k], rate);
    for (std::size_t j = 1; j <= k; ++j) {  // Neville, in squares of the step
      const double ratio = static_cast<double>(counts[k]) / counts[k - j];
      for (std::size_t i = 0; i < row[j].size(); ++i)
        row[j][i] = row[j - 1][i] + (row[j - 1][i] - before[j - 1][i]) * (1.0 / (ratio * ratio - 1.0));
    }
    double error = 0.0;
    for (std::size_t i = 0; i < row[k].size() && k > 0; ++i)
      error =
          std::max(error, largest_part(S(row[k][i] - before[k - 1][i])) / (1.0 + largest_part(row[k][i])));
    if (k > 0 && error <= allowed) return row[k];
    before = row;
  }
  return depth < most_halvings ? halved() : row.back();
}

/// One design, phase after phase.
template <class S>
class Walk {
 public:
  Walk(const Seeded<S>& design, const Scene& scene, double accuracy, std::size_t times)
      : accuracy_(accuracy),
        hoop_(design.hoop(scene)),
        contact_{design.parameter(by_mu_static), design.parameter(by_mu_kinetic),
                 design.parameter(by_restitution), S(scene.rest_speed)},
        budget_((accuracy < 1e-6 ? 20'000 : 3'000) + 10 * static_cast<long>(times)) {
    if (contact_.mu_static < contact_.mu_kinetic) contact_.mu_static = contact_.mu_kinetic;
    at_ = {design.parameter(by_release_angle), design.parameter(by_release_spin), S(0.0), S(0.0)};
  }

  /// Goes through a phase from one time to another, and adds where it is at those between.
  void contact(Phase phase, int direction, double from, double to, std::span<const double> times,
               std::vector<MotionAt<S>>& taken) {
    const auto rate = rate_of(phase, direction);
    const auto turning_rate = [&](const Turning<S>& at) -> Turning<S> {
      const Moving<S> rates = rate({at[0], at[1], S(0.0), S(0.0)});
      return {rates[0], rates[1]};
    };
    const auto since = moving_since(phase, direction, at_);
    Turning<S> turning{at_[0], at_[1]};
    double time = from;
    for (const double sample : times) {
      if (!rests_) {
        const Turning<S> next = integrated(turning, sample - time, turning_rate, accuracy_, budget_);
        rests_ = value_of(next[1]) * value_of(hoop_.resistance) < 0.0;
        const double span = rests_ ? span_to_rest(turning, sample - time, turning_rate) : sample - time;
        turning = rests_ ? integrated(turning, span, turning_rate, accuracy_, budget_) : next;
        at_ = since(turning, time + span - from);
      }
      time = sample;
      if (rests_) {
        taken.push_back({at_[0], at_[2], S(0.0), S(0.0), 0.0, 0.0, 0.0});
        continue;
      }
      const Moving<S> rates = rate(at_);
      taken.push_back({at_[0], at_[2], S(0.0), at_[1], value_of(rates[2]), 0.0, value_of(rates[1])});
    }
    if (std::isfinite(to))
      at_ = since(integrated(turning, to - time, turning_rate, accuracy_, budget_), to - from);
  }
  /// Ends a phase of contact where the next one begins.
  void end_contact(Phase phase, int direction, Phase next) {
    const S later = lateness(phase, direction, next);
    at_ = moved(at_, rate_of(phase, direction)(at_), later);
    if (phase == Phase::sliding && next != Phase::flight) at_[3] = S(0.0);
    late_ = later, normal_ = S(0.0);
  }
  /// Begins the next one: as if it had begun in time.
  void begin_contact(Phase phase, int direction) {
    at_ = moved(at_, rate_of(phase, direction)(at_), -late_);
    late_ = S(0.0);
  }
  /// A flight, and its landing after flight_time; infinite: it never lands.
  void fly(double from, double flight_time, std::span<const double> times, std::vector<MotionAt<S>>& taken) {
    const Trig<S> phi = trig(at_[0]);
    for (const double sample : times) {
      const S t = S(sample - from) - late_;
      const Turned<S> turned = turned_in_flight(hoop_, at_[1], t);
      const Sample<S> travel = travel_in_flight(hoop_, phi, at_[1], at_[3], t);
      const auto height = height_above_plane(hoop_, phi, at_[1], t, normal_);
      taken.push_back({at_[0] + turned.value, at_[2] + travel.value, height.value, turned.rate,
                       value_of(travel.rate), value_of(height.rate), value_of(hoop_.aloft)});
    }
    if (!std::isfinite(flight_time)) return;
    S flown(flight_time);
    if constexpr (has_derivatives<S>) {
      const auto end = height_above_plane(hoop_, phi, at_[1], flown, normal_);
      flown = with_derivatives(flight_time, end.value, end.rate.value);
    }
    const Sample<S> travel = travel_in_flight(hoop_, phi, at_[1], at_[3], flown);
    const S rise = height_above_plane(hoop_, phi, at_[1], flown, normal_).rate;
    const Turned<S> turned = turned_in_flight(hoop_, at_[1], flown);
    at_[2] = at_[2] + travel.value;
    at_[0] = at_[0] + turned.value, at_[1] = turned.rate;
    const Landing<S> landing = land(hoop_, trig(at_[0]), {travel.rate - at_[1], rise, at_[1]},
                                    contact_.mu_kinetic, contact_.restitution, contact_.rest_speed);
    at_[1] = landing.after.spin, at_[3] = landing.after.slip, normal_ = landing.after.normal;
    late_ = late_ + flown - S(flight_time);
  }

 private:
  auto rate_of(Phase phase, int direction) const {
    return
        [this, rolls = phase == Phase::rolling,
         friction = contact_.mu_kinetic * static_cast<double>(direction)](const Moving<S>& at) -> Moving<S> {
          const Trig<S> phi = trig(at[0]);
          if (rolls) return {at[1], angular_acceleration(hoop_, phi, at[1]), at[1], S(0.0)};
          const auto motion = sliding_motion(hoop_, phi, S(at[1] * at[1]), friction);
          return {at[1], motion.angular, at[3] + at[1], motion.slip};
        };
  }
  /// What moves some time after the state that a phase begins at, by angle and spin then.
  auto moving_since(Phase phase, int direction, const Moving<S>& begun) const {
    const S friction = contact_.mu_kinetic * static_cast<double>(direction);
    return [begun, rolls = phase == Phase::rolling,
            momentum = SlidingMomentum<S>(hoop_, friction, trig(begun[0]), begun[1])](
               const Turning<S>& at, double time) -> Moving<S> {
      if (rolls) return {at[0], at[1], begun[2] + (at[0] - begun[0]), S(0.0)};
      const Trig<S> phi = trig(at[0]);
      return {at[0], at[1], begun[2] + momentum.travelled(phi, S(time), begun[3]),
              begun[3] + momentum.slip_gained(phi, at[1], S(time))};
    };
  }
  /// How far into a span of time the spin is used up: against a resistance the hoop stays there. Its angle
  /// has no derivative by the time of that.
  template <class Rate>
  double span_to_rest(const Turning<S>& from, double span, const Rate& rate) {
    constexpr int halvings = 50;
    double low = 0.0, high = span;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (low + high);
      const bool past =
          value_of(integrated(from, middle, rate, accuracy_, budget_)[1]) * value_of(hoop_.resistance) < 0.0;
      (past ? high : low) = middle;
    }
    return low;
  }
  static Moving<S> moved(const Moving<S>& from, const Moving<S>& rate, const S& by) {
    Moving<S> to;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] + rate[i] * by;
    return to;
  }
  /// How much later than its plain time a phase ends: no more than derivatives.
  S lateness(Phase phase, int direction, Phase next) const {
    if constexpr (has_derivatives<S>) {
      const Trig<S> phi = trig(at_[0]);
      const S spin = at_[1];
      S zero(0.0);
      double rate = 1.0;
      if (phase == Phase::sliding) {
        const auto motion =
            sliding_motion(hoop_, phi, S(spin * spin), contact_.mu_kinetic * static_cast<double>(direction));
        zero = next == Phase::flight ? free_normal_force(hoop_, phi, S(spin * spin)) : at_[3];
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
  Hoop<S> hoop_;
  Contact<S> contact_;
  Moving<S> at_;
  S normal_{0.0};
  S late_{0.0};
  bool rests_ = false;  // against a resistance, for good
  long budget_;         // of steps, halves of steps among them
};

}  // namespace

template <class S>
std::vector<MotionAt<S>> motion_at(const Design& design, const Scene& scene, std::span<const double> times,
                                   double accuracy, std::span<const std::size_t> by) {
  constexpr double tolerance = 1e-12;  // whatever the accuracy: a thread keeps its solver
  const Motion motion =
      need(model_of(scene), &Model::tell_exactly, "semi-analytic motion")(design, scene, tolerance, 0.0);
  std::vector<MotionAt<S>> taken;
  const Status status = motion.outcome.status;
  if (motion.phases.empty() || status == Status::failed || status == Status::indeterminate) return taken;
  const double second = time_unit(scene);
  std::vector<double> scaled;
  for (const double time : times) scaled.push_back(time / second);
  const std::span<const double> all = scaled;
  Walk<S> walk(Seeded<S>(design, by), scene, accuracy, times.size());
  std::size_t next = 0, flight = 0;
  // Lift-offs that were flown: without slip a spurious one is rolled over.
  const std::size_t flights =
      static_cast<std::size_t>(std::count_if(motion.phases.begin(), motion.phases.end(),
                                             [](const PhaseStart& p) { return p.phase == Phase::flight; }));
  const std::size_t rolled_over = motion.candidates.size() - std::min(flights, motion.candidates.size());
  for (std::size_t k = 0; k < motion.phases.size(); ++k) {
    const PhaseStart& phase = motion.phases[k];
    const bool last = k + 1 == motion.phases.size();
    const double from = phase.t / second, to = last ? HUGE_VAL : motion.phases[k + 1].t / second;
    std::size_t end = next;
    while (end < all.size() && (last || all[end] < to)) ++end;
    const std::span<const double> here = all.subspan(next, end - next);
    next = end;
    if (phase.phase == Phase::flight) {
      walk.fly(from, last ? HUGE_VAL : motion.candidates[rolled_over + flight++].flight_time / second, here,
               taken);
      if (!last && motion.phases[k + 1].phase != Phase::flight)
        walk.begin_contact(motion.phases[k + 1].phase, motion.phases[k + 1].direction);
      continue;
    }
    walk.contact(phase.phase, phase.direction, from, to, here, taken);
    if (last) break;
    const PhaseStart& then = motion.phases[k + 1];
    walk.end_contact(phase.phase, phase.direction, then.phase);
    if (then.phase != Phase::flight) walk.begin_contact(then.phase, then.direction);
  }
  for (const MotionAt<S>& at : taken)
    if (!std::isfinite(value_of(at.phi)) || !std::isfinite(value_of(at.x)) || !std::isfinite(value_of(at.y)))
      return {};
  return taken;
}

template std::vector<MotionAt<double>> motion_at(const Design&, const Scene&, std::span<const double>, double,
                                                 std::span<const std::size_t>);
template std::vector<MotionAt<FewDual>> motion_at(const Design&, const Scene&, std::span<const double>,
                                                  double, std::span<const std::size_t>);
template std::vector<MotionAt<DesignDual>> motion_at(const Design&, const Scene&, std::span<const double>,
                                                     double, std::span<const std::size_t>);

}  // namespace leapmap
