// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/sliding_leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap {
namespace {

constexpr double longest_angle = 2.0, first_angle = 1.2;  // of a panel by angle [rad]
constexpr double shortest_angle = 1e-12;                  // of 1 + |angle|
constexpr double vanishing_angle = 0.05;  // where the spin vanishes within less than this, panels are by time
constexpr double longest_time = 1.0, first_time = 0.25,
                 shortest_time = 1e-12;  // of a panel by time [sqrt(R/g)]
constexpr int most_panels = 10'000, most_iterations = 60;

/// Relative rounding of the accelerations: Ic + rho s q comes of terms that may cancel.
template <class S>
S rounding_of(const Hoop<S>& hoop, const S& friction, const S& pivot) {
  return S(16) * std::numeric_limits<S>::epsilon() *
         (hoop.Ic + hoop.rho * (hoop.rho + S(2) * std::abs(friction))) / pivot;
}

/// Whether Ic + rho s q is zero or below, as far as doubles can tell: forces grow beyond all bounds on the
/// way there.
template <class S>
bool at_edge(const Hoop<S>& hoop, const S& friction, const Trig<S>& phi) {
  const S pivot = sliding_coefficients(hoop, phi, friction).pivot;
  return !(pivot > S(0)) || rounding_of(hoop, friction, pivot) > S(1e-3);
}

}  // namespace

template <class S>
SlidingLeg<S>::SlidingLeg(double tolerance)
    : tolerance_(std::max(S(tolerance) * S(0.5), S(100) * std::numeric_limits<S>::epsilon())) {}

template <class S>
auto SlidingLeg<S>::stretch_of(const S& spin, const S& rise, const S& length) -> Stretch {
  // x = shift + q^2 takes out u's zero just before the start, where the spin is small and grows.
  const S shift = rise > S(0) ? std::max(-spin * spin / (S(2) * rise), -length) : -length;
  const S begin = std::sqrt(-shift);
  return {shift, begin, std::sqrt(length - shift) - begin};
}

template <class S>
void SlidingLeg<S>::solve_by_angle(const Hoop<S>& hoop, const S& friction, const ContactState<S>& from,
                                   const Stretch& stretch, Panel& panel) const {
  // The nodes in lanes.
  using T = typename SpectralPanel<S, nodes>::T;
  constexpr std::size_t width = Lanes<T>::count;
  const auto get = [](const Values& values, std::size_t i) { return Lanes<T>::load(values.data() + i); };
  const auto put = [](const T& value, Values& values, std::size_t i) {
    Lanes<T>::store(value, values.data() + i);
  };
  const Hoop<T> hoops = widened<T>(hoop);
  const T m(friction);

  using std::exp, std::sqrt;
  const S u0 = from.spin * from.spin;
  Values a, b, angle, weight;
  std::array<Trig<T>, nodes / width> phi;
  std::array<SlidingCoefficients<T>, nodes / width> coefficients;
  panel.indeterminate = panel.spin_vanishes = false;
  panel.excess = std::numeric_limits<S>::infinity();
  const S end_q = stretch.begin + stretch.span, length = stretch.shift + end_q * end_q;
  panel.end.angle = from.angle + length;
  const Trig<S> end_phi = trig(panel.end.angle);
  const S end_pivot = sliding_coefficients(hoop, end_phi, friction).pivot;
  panel.indeterminate = !(end_pivot > S(0));
  for (std::size_t i = 0; i < nodes; i += width) {
    const T q = T(stretch.begin) + T(stretch.span) * get(panel_.node, i);
    const T w = q * T(S(2) * stretch.span), x = T(stretch.shift) + q * q;
    const Trig<T> at_node = phi[i / width] = trig(T(from.angle) + x);
    const SlidingCoefficients<T> at = coefficients[i / width] = sliding_coefficients(hoops, at_node, m);
    panel.indeterminate = panel.indeterminate || !all(at.pivot > T(0));
    const T turn = T(2) * at.turn * w;
    put(turn * hoops.rho * at_node.cos, a, i);
    put(turn * hoops.cos_slope, b, i);
    put(w, weight, i);
    put(x, angle, i);
  }
  if (panel.indeterminate) return;

  const Values A = panel_.integrals(a);
  Values growth, driven;
  for (std::size_t i = 0; i < nodes; i += width) {
    const T grown = exp(get(A, i));
    put(grown, growth, i);
    put(get(b, i) / grown, driven, i);
  }
  const Values B = panel_.integrals(driven);
  const S end_u = std::exp(panel_.integral(a)) * (u0 + panel_.integral(driven));
  bool turns = end_u > S(0);
  Values time_rate, slip_rate, travel_rate;
  for (std::size_t i = 0; i < nodes; i += width) {
    const T u = get(growth, i) * (T(u0) + get(B, i));
    turns = turns && all(u > T(0));
    const T rate = get(weight, i) / sqrt(u);
    put(rate, time_rate, i);
    put(sliding_motion(hoops, phi[i / width], u, m, coefficients[i / width]).slip * rate, slip_rate, i);
    put(free_normal_force(hoops, phi[i / width], u), panel.free_force, i);
  }
  panel.spin_vanishes = !turns;
  if (!turns) return;
  panel.end.spin = std::sqrt(end_u);
  panel.end_force = free_normal_force(hoop, end_phi, end_u);
  panel.slip = panel_.integrals(slip_rate);
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
  panel.excess =
      std::max({panel_.tail(a), panel_.tail(driven) / (S(1) + u0), S(0.1) * panel_.tail(time_rate) / duration,
                panel_.tail(slip_rate) / (S(1) + std::abs(from.slip))}) /
      tolerance_;
}

template <class S>
void SlidingLeg<S>::solve_by_time(const Hoop<S>& hoop, const S& friction, const ContactState<S>& from,
                                  const S& duration, Panel& panel) const {
  panel.indeterminate = false;
  panel.excess = std::numeric_limits<S>::infinity();
  Values angle, spin, angular, slip_rate, travel_rate;
  for (std::size_t i = 0; i < nodes; ++i)
    spin[i] = from.spin, angle[i] = from.angle + from.spin * duration * panel_.node[i];
  bool settled = false;
  using T = typename SpectralPanel<S, nodes>::T;
  constexpr std::size_t width = Lanes<T>::count;
  const Hoop<T> hoops = widened<T>(hoop);
  const T m(friction), length(duration);
  for (int iteration = 0; iteration < most_iterations && !settled; ++iteration) {
    for (std::size_t i = 0; i < nodes; i += width) {
      const Trig<T> phi = trig(Lanes<T>::load(angle.data() + i));
      if (!all(sliding_coefficients(hoops, phi, m).pivot > T(S(0)))) {
        panel.indeterminate = true;
        return;
      }
      const T w = Lanes<T>::load(spin.data() + i), u = w * w;
      const SlidingMotion<T> motion = sliding_motion(hoops, phi, u, m);
      Lanes<T>::store(length * motion.angular, angular.data() + i);
      Lanes<T>::store(length * motion.slip, slip_rate.data() + i);
      Lanes<T>::store(free_normal_force(hoops, phi, u), panel.free_force.data() + i);
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
  const S end_pivot = sliding_coefficients(hoop, end_phi, friction).pivot;
  panel.indeterminate = !(end_pivot > S(0));
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
  if (settled)
    panel.excess = std::max(panel_.tail(angular) / (S(1) + std::abs(from.spin)),
                            panel_.tail(slip_rate) / (S(1) + std::abs(from.slip))) /
                   (tolerance_ + rounding_of(hoop, friction, end_pivot));
}

template <class S>
S SlidingLeg<S>::first_event(const S& free_force, const ContactState<S>& at, const S& runway, int direction,
                             const Panel& panel, PhaseEnd& end) const {
  struct Guard {
    PhaseEnd end;
    S offset, factor;  // of the values that it falls with
    const Values& values;
    S first, last;
  };
  const S sign(direction);
  const Guard guards[]{
      {PhaseEnd::lifts_off, S(0), S(1), panel.free_force, free_force, panel.end_force},
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
    // Where all values are well above zero nothing falls between them either.
    const auto [least, most] = std::minmax_element(guard.values.begin(), guard.values.end());
    const S lowest_value =
        guard.factor > S(0) ? guard.offset + guard.factor * *least : guard.offset + guard.factor * *most;
    const S highest_value =
        guard.factor > S(0) ? guard.offset + guard.factor * *most : guard.offset + guard.factor * *least;
    if (std::min({lowest_value, guard.first, guard.last}) > S(0.05) * highest_value) continue;
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
  Panel panel;
  S length(first_angle), duration(first_time);
  // The tails go about with the length's power `nodes`: a length that just meets the tolerance, with some
  // slack.
  const auto change = [](const Panel& tried, const S& most) {
    return std::clamp(S(0.85) * std::pow(tried.excess, S(-1) / S(nodes)), S(0.3), most);
  };
  const auto shrink = [&](const Panel& tried) {
    return std::isfinite(tried.excess) ? change(tried, S(0.85)) : S(0.5);
  };
  for (int taken = 0; taken < most_panels; ++taken) {
    // By angle while the hoop turns forwards and its spin does not vanish soon; else by time.
    const Trig<S> phi = trig(at.angle);
    if (at_edge(hoop, friction, phi)) return PhaseEnd::indeterminate;
    const SlidingMotion<S> start = sliding_motion(hoop, phi, S(at.spin * at.spin), friction);
    Stretch stretch{};
    bool by_angle = at.spin > S(0) || (at.spin == S(0) && start.angular > S(0));
    if (by_angle) {
      const S shortest = S(shortest_angle) * (S(1) + std::abs(at.angle));
      for (;; length *= shrink(panel)) {
        stretch = stretch_of(at.spin, start.angular, length);
        solve_by_angle(hoop, friction, at, stretch, panel);
        by_angle = panel.excess <= S(1);
        if (by_angle || length < (panel.spin_vanishes ? S(vanishing_angle) : shortest)) break;
      }
    }
    if (!by_angle) {
      length = S(vanishing_angle);
      for (;; duration *= shrink(panel)) {
        solve_by_time(hoop, friction, at, duration, panel);
        if (panel.excess <= S(1)) break;
        if (duration < S(shortest_time))
          return panel.indeterminate ? PhaseEnd::indeterminate : PhaseEnd::failed;
      }
    }
    PhaseEnd end = PhaseEnd::failed;
    const S force = free_normal_force(hoop, phi, S(at.spin * at.spin));
    const S place = first_event(force, at, runway, direction, panel, end);
    if (place > S(1)) {
      at = panel.end;
      (by_angle ? length : duration) *=
          std::max(change(panel, S(2)), S(1));  // roundings do not shrink with it
      length = std::min(length, S(longest_angle)), duration = std::min(duration, S(longest_time));
      continue;
    }
    // The panel once more, ending there: its end is better than a value between nodes.
    if (by_angle) {
      stretch.span *= place;
      solve_by_angle(hoop, friction, at, stretch, panel);
    } else {
      solve_by_time(hoop, friction, at, S(duration * place), panel);
    }
    if (!std::isfinite(panel.excess)) return PhaseEnd::failed;
    at = panel.end;
    if (end == PhaseEnd::slip_ends) at.slip = S(0);
    return end;
  }
  return PhaseEnd::too_long;
}

template <class S>
bool SlidingLeg<S>::advance(const Hoop<S>& hoop, const S& mu_kinetic, ContactState<S>& at, const S& duration,
                            int direction) const {
  Panel panel;
  const S end = at.time + duration;
  for (S step = std::min(duration, S(first_time)); at.time < end;) {
    solve_by_time(hoop, S(S(direction) * mu_kinetic), at, std::min(step, S(end - at.time)), panel);
    if (panel.excess <= S(1)) {
      at = panel.end;
    } else if ((step *= S(0.5)) < S(shortest_time)) {
      return false;
    }
  }
  return true;
}

template class SlidingLeg<double>;
template class SlidingLeg<long double>;

}  // namespace leapmap
