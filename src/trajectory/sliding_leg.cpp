// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/sliding_leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap {
namespace {

constexpr double longest_angle = 1.0, first_angle = 0.5, shortest_angle = 0.05;  // of a panel by angle [rad]
constexpr double longest_time = 0.25, shortest_time = 1e-9;  // of a panel by time [sqrt(R/g)]
constexpr int most_panels = 2000, most_iterations = 60;

/// Whether the motion runs into where Ic + rho s q = 0: forces grow beyond all bounds on the way there.
template <class S>
bool jams(const Hoop<S>& hoop, const S& friction, const ContactState<S>& at) {
  const S ahead = at.angle + (at.spin < S(0) ? S(-1e-6) : S(1e-6));
  const S here = sliding_coefficients(hoop, trig(at.angle), friction).pivot;
  const S there = sliding_coefficients(hoop, trig(ahead), friction).pivot;
  return there < here && here < S(1e-3) * (hoop.Ic + hoop.rho);
}

}  // namespace

template <class S>
SlidingLeg<S>::SlidingLeg(double tolerance)
    : tolerance_(std::max(S(tolerance) * S(0.01), S(100) * std::numeric_limits<S>::epsilon())) {}

template <class S>
auto SlidingLeg<S>::stretch_of(const Hoop<S>& hoop, const S& friction, const ContactState<S>& from,
                               const S& length) const -> Stretch {
  // x = shift + q^2 takes out u's zero just before the start, where the spin is small and grows.
  const S u0 = from.spin * from.spin;
  const S rise = sliding_motion(hoop, trig(from.angle), u0, friction).angular;
  const S shift = rise > S(0) ? std::max(-u0 / (S(2) * rise), -length) : -length;
  const S begin = std::sqrt(-shift);
  return {shift, begin, std::sqrt(length - shift) - begin};
}

template <class S>
void SlidingLeg<S>::solve_by_angle(const Hoop<S>& hoop, const S& friction, const ContactState<S>& from,
                                   const Stretch& stretch, Panel& panel) const {
  const S u0 = from.spin * from.spin;
  Values a, b, angle, weight;
  std::array<Trig<S>, nodes> phi;
  panel.indeterminate = panel.resolved = false;
  for (std::size_t i = 0; i < nodes; ++i) {
    const S q = stretch.begin + stretch.span * panel_.node[i];
    weight[i] = S(2) * q * stretch.span;
    angle[i] = stretch.shift + q * q;
    phi[i] = trig(S(from.angle + angle[i]));
    const SlidingCoefficients<S> at = sliding_coefficients(hoop, phi[i], friction);
    panel.indeterminate = panel.indeterminate || !(at.pivot > S(0));
    const S turn = S(2) * at.turn * weight[i];
    a[i] = turn * hoop.rho * phi[i].cos;
    b[i] = turn * hoop.cos_slope;
  }
  const S end_q = stretch.begin + stretch.span, length = stretch.shift + end_q * end_q;
  panel.end.angle = from.angle + length;
  const Trig<S> end_phi = trig(panel.end.angle);
  panel.indeterminate = panel.indeterminate || !(sliding_coefficients(hoop, end_phi, friction).pivot > S(0));
  if (panel.indeterminate) return;

  const Values A = panel_.integrals(a);
  Values growth, driven;
  for (std::size_t i = 0; i < nodes; ++i) growth[i] = std::exp(A[i]), driven[i] = b[i] / growth[i];
  const Values B = panel_.integrals(driven);
  Values time_rate, slip_rate;
  for (std::size_t i = 0; i < nodes; ++i) {
    const S u = growth[i] * (u0 + B[i]);
    if (!(u > S(0))) return;
    time_rate[i] = weight[i] / std::sqrt(u);
    slip_rate[i] = sliding_motion(hoop, phi[i], u, friction).slip * time_rate[i];
    panel.free_force[i] = free_normal_force(hoop, phi[i], u);
  }
  const S end_u = std::exp(panel_.integral(a)) * (u0 + panel_.integral(driven));
  if (!(end_u > S(0))) return;
  panel.end.spin = std::sqrt(end_u);
  panel.end_force = free_normal_force(hoop, end_phi, end_u);
  panel.slip = panel_.integrals(slip_rate);
  Values travel_rate;
  for (std::size_t i = 0; i < nodes; ++i) {
    panel.slip[i] += from.slip;
    travel_rate[i] = panel.slip[i] * time_rate[i];
  }
  panel.travel = panel_.integrals(travel_rate);
  for (std::size_t i = 0; i < nodes; ++i) panel.travel[i] += from.travel + angle[i];
  const S duration = panel_.integral(time_rate);
  panel.end.time = from.time + duration;
  panel.end.slip = from.slip + panel_.integral(slip_rate);
  panel.end.travel = from.travel + length + panel_.integral(travel_rate);
  panel.resolved = panel_.tail(a) <= tolerance_ && panel_.tail(driven) <= tolerance_ * (S(1) + u0) &&
                   panel_.tail(time_rate) <= tolerance_ * duration * S(10) &&
                   panel_.tail(slip_rate) <= tolerance_ * (S(1) + std::abs(from.slip));
}

template <class S>
void SlidingLeg<S>::solve_by_time(const Hoop<S>& hoop, const S& friction, const ContactState<S>& from,
                                  const S& duration, Panel& panel) const {
  panel.indeterminate = panel.resolved = false;
  Values angle, spin, angular, slip_rate, travel_rate;
  for (std::size_t i = 0; i < nodes; ++i)
    spin[i] = from.spin, angle[i] = from.angle + from.spin * duration * panel_.node[i];
  bool settled = false;
  for (int iteration = 0; iteration < most_iterations && !settled; ++iteration) {
    for (std::size_t i = 0; i < nodes; ++i) {
      const Trig<S> phi = trig(angle[i]);
      if (!(sliding_coefficients(hoop, phi, friction).pivot > S(0))) {
        panel.indeterminate = true;
        return;
      }
      const SlidingMotion<S> motion = sliding_motion(hoop, phi, S(spin[i] * spin[i]), friction);
      angular[i] = duration * motion.angular;
      slip_rate[i] = duration * motion.slip;
      panel.free_force[i] = free_normal_force(hoop, phi, S(spin[i] * spin[i]));
    }
    const Values gained = panel_.integrals(angular);
    S change(0);
    for (std::size_t i = 0; i < nodes; ++i) {
      change = std::max(change, std::abs(from.spin + gained[i] - spin[i]));
      spin[i] = from.spin + gained[i];
    }
    const Values turned = panel_.integrals(spin);
    for (std::size_t i = 0; i < nodes; ++i) angle[i] = from.angle + duration * turned[i];
    settled = change <= S(4) * std::numeric_limits<S>::epsilon() * (S(1) + std::abs(from.spin));
  }
  panel.end.spin = from.spin + panel_.integral(angular);
  panel.end.angle = from.angle + duration * panel_.integral(spin);
  const Trig<S> end_phi = trig(panel.end.angle);
  panel.indeterminate = !(sliding_coefficients(hoop, end_phi, friction).pivot > S(0));
  if (panel.indeterminate) return;
  panel.end_force = free_normal_force(hoop, end_phi, S(panel.end.spin * panel.end.spin));
  panel.slip = panel_.integrals(slip_rate);
  for (std::size_t i = 0; i < nodes; ++i) {
    panel.slip[i] += from.slip;
    travel_rate[i] = duration * (panel.slip[i] + spin[i]);
  }
  panel.travel = panel_.integrals(travel_rate);
  for (S& x : panel.travel) x += from.travel;
  panel.end.time = from.time + duration;
  panel.end.slip = from.slip + panel_.integral(slip_rate);
  panel.end.travel = from.travel + panel_.integral(travel_rate);
  panel.resolved = settled && panel_.tail(angular) <= tolerance_ * (S(1) + std::abs(from.spin)) &&
                   panel_.tail(slip_rate) <= tolerance_ * (S(1) + std::abs(from.slip));
}

template <class S>
S SlidingLeg<S>::first_event(const Hoop<S>& hoop, const ContactState<S>& at, const S& runway, int direction,
                             const Panel& panel, PhaseEnd& end) const {
  struct Guard {
    PhaseEnd end;
    S offset, factor;  // of the values that it falls with
    const Values& values;
    S first, last;
  };
  const S sign(direction);
  const Guard guards[]{
      {PhaseEnd::lifts_off, S(0), S(1), panel.free_force,
       free_normal_force(hoop, trig(at.angle), S(at.spin * at.spin)), panel.end_force},
      {PhaseEnd::slip_ends, S(0), sign, panel.slip, sign * at.slip, sign * panel.end.slip},
      {PhaseEnd::runway_ends, runway, S(-1), panel.travel, runway - at.travel, runway - panel.end.travel}};
  S earliest(2);
  for (const Guard& guard : guards) {
    const auto value_at = [&](std::size_t i) {
      return i < nodes ? guard.offset + guard.factor * guard.values[i] : guard.last;
    };
    const auto place_of = [&](std::size_t i) { return i < nodes ? panel_.node[i] : S(1); };
    const auto between = [&](const S& x) {
      return guard.offset + guard.factor * panel_.value(guard.values, x);
    };
    S left = guard.first, left_place(0);
    for (std::size_t i = 0; i <= nodes && left_place < earliest; ++i) {
      S right = value_at(i), right_place = place_of(i);
      // A dip between the nodes: the parabola through three of them says where to ask.
      if (right > S(0) && i > 0 && i < nodes && right < left && right < value_at(i + 1)) {
        const S d1 = left - right, d2 = value_at(i + 1) - right, h1 = right_place - left_place,
                h2 = place_of(i + 1) - right_place;
        const S vertex = right_place + S(0.5) * (d1 * h2 * h2 - d2 * h1 * h1) / (d1 * h2 + d2 * h1);
        if (const S lowest = between(vertex); lowest < S(0)) right = lowest, right_place = vertex;
      }
      // A guard that starts at zero is above it from the first node on, unless it falls at once.
      if (!(right > S(0))) {
        S a = left_place, b = right_place, fa = left, fb = right;
        for (int k = 0; k < 100 && b - a > S(4) * std::numeric_limits<S>::epsilon() && fb != S(0); ++k) {
          S x = fa > S(0) ? (a * fb - b * fa) / (fb - fa) : a + (b - a) * S(0.5);  // Illinois
          if (!(x > a && x < b)) x = a + (b - a) * S(0.5);
          const S fx = between(x);
          if (fx > S(0)) {
            a = x, fa = fx, fb *= S(0.5);
          } else {
            b = x, fb = fx, fa *= S(0.5);
          }
        }
        if (b < earliest) earliest = b, end = guard.end;
        break;
      }
      left = right, left_place = right_place;
    }
  }
  return earliest;
}

template <class S>
PhaseEnd SlidingLeg<S>::run(const Hoop<S>& hoop, const S& mu_kinetic, ContactState<S>& at, const S& runway,
                            int direction) const {
  const S friction = direction > 0 ? mu_kinetic : -mu_kinetic;
  if (!(sliding_coefficients(hoop, trig(at.angle), friction).pivot > S(0))) return PhaseEnd::indeterminate;

  Panel panel;
  S length(first_angle), duration(longest_time);
  for (int taken = 0; taken < most_panels; ++taken) {
    // By angle while the hoop turns forwards and its spin is not about to change sign; else by time.
    Stretch stretch{};
    bool by_angle = at.spin > S(0) ||
                    (at.spin == S(0) && sliding_motion(hoop, trig(at.angle), S(0), friction).angular > S(0));
    if (by_angle) {
      for (; length >= S(shortest_angle); length *= S(0.5)) {
        stretch = stretch_of(hoop, friction, at, length);
        solve_by_angle(hoop, friction, at, stretch, panel);
        if (panel.resolved) break;
      }
      by_angle = panel.resolved;
    }
    if (!by_angle) {
      for (;; duration *= S(0.5)) {
        solve_by_time(hoop, friction, at, duration, panel);
        if (panel.resolved) break;
        if (duration < S(shortest_time))
          return panel.indeterminate || jams(hoop, friction, at) ? PhaseEnd::indeterminate : PhaseEnd::failed;
      }
    }
    PhaseEnd end = PhaseEnd::failed;
    const S place = first_event(hoop, at, runway, direction, panel, end);
    if (place > S(1)) {
      at = panel.end;
      length = std::clamp(S(1.5) * length, S(first_angle), S(longest_angle));
      duration = std::min(S(2) * duration, S(longest_time));
      continue;
    }
    // The panel once more, ending there: its end is better than a value between nodes.
    if (by_angle) {
      stretch.span *= place;
      solve_by_angle(hoop, friction, at, stretch, panel);
    } else {
      solve_by_time(hoop, friction, at, S(duration * place), panel);
    }
    at = panel.end;
    if (end == PhaseEnd::slip_ends) at.slip = S(0);
    return end;
  }
  return PhaseEnd::failed;
}

template class SlidingLeg<double>;
template class SlidingLeg<long double>;

}  // namespace leapmap
