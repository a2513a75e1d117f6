// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/sliding_panel.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "trajectory/gradient.hpp"

namespace leapmap {
namespace {

constexpr int most_iterations = 60;

/// The largest, and infinity if any is no number: such a panel is not resolved.
template <class Number>
Number largest(std::initializer_list<Number> values) {
  Number most(0);
  for (const Number& value : values) most = std::isfinite(value) ? std::max(most, value) : Number(HUGE_VAL);
  return most;
}

/// The same hoop for the nodes, one or many at once.
template <class T, class S>
Hoop<T> at_nodes(const Hoop<S>& hoop) {
  if constexpr (std::is_same_v<T, S>) {
    return hoop;
  } else {
    return widened<T>(hoop);
  }
}

/// w^2, of which y is the value, or n0 where it is known `by_force`.
template <class T>
T spin_squared(const Hoop<T>& hoop, const Trig<T>& phi, const T& y, bool by_force) {
  return by_force ? (y - free_normal_force(hoop, phi, T(ScalarOf<T>(0)))) / (hoop.rho * phi.cos) : y;
}

}  // namespace

template <class S>
auto SlidingPanels<S>::stretch_of(const S& spin, const S& rise, const S& length) -> Stretch {
  // x = shift + q^2 takes out u's zero just before the start, where the spin is small and grows.
  using std::sqrt;
  const S shift = rise > S(0) ? std::max(-spin * spin / (S(2) * rise), -length) : -length;
  const S begin = sqrt(-shift);
  return {shift, begin, sqrt(length - shift) - begin};
}

template <class S>
void SlidingPanels<S>::solve_by_angle(const Slide& slide, const ContactState<S>& from, const Stretch& stretch,
                                      Panel& panel) const {
  // The nodes in lanes.
  using T = typename Grid::T;
  using std::abs, std::exp, std::sqrt;
  constexpr std::size_t width = Lanes<T>::count;
  const auto get = [](const Values& values, std::size_t i) { return Lanes<T>::load(values.data() + i); };
  const auto put = [](const T& value, Values& values, std::size_t i) {
    Lanes<T>::store(value, values.data() + i);
  };
  const Hoop<S>& hoop = slide.hoop;
  const S& friction = slide.friction;
  const Hoop<T> hoops = at_nodes<T>(hoop);
  const T m(friction);
  const S way = from.spin < S(0) ? S(-1) : S(1), length = stretch.length();
  panel.indeterminate = panel.spin_vanishes = false;
  panel.excess = std::numeric_limits<Number>::infinity();
  panel.turned = way * length;
  panel.end.angle = from.angle + panel.turned;
  const Trig<S> start_phi = trig(from.angle), end_phi = trig(panel.end.angle);

  const SlidingCoefficients<S> end = slide.coefficients(hoop, end_phi, S(way * length));
  panel.indeterminate = !(end.pivot > S(0));
  // With n0 in place of u, where it is the one that vanishes, and the cosine stays away from zero.
  const S farthest = S(-0.2);
  const bool by_force = panel.by_force = slide.edge && slide.free_force < S(0.5) * hoop.cos_slope &&
                                         start_phi.cos < farthest && end_phi.cos < farthest;

  Values a, b, weight, angle;
  std::array<Trig<T>, nodes / width> phi;
  std::array<SlidingCoefficients<T>, nodes / width> coefficients;
  for (std::size_t i = 0; i < nodes; i += width) {
    const T q = T(stretch.begin) + T(stretch.span) * Lanes<T>::load(grid_.node.data() + i);
    const T w = q * T(S(2) * stretch.span), x = T(stretch.shift) + q * q;
    const Trig<T> at_node = phi[i / width] = trig(T(from.angle) + T(way) * x);
    const SlidingCoefficients<T> at = coefficients[i / width] =
        slide.coefficients(hoops, at_node, T(way) * x);
    panel.indeterminate = panel.indeterminate || !all(at.pivot > T(S(0)));
    const T idle = free_normal_force(hoops, at_node, T(S(0))), torque = hoops.drive / hoops.Ic;
    const T turned = T(way) * w, grows = T(S(2)) * at.turn * hoops.rho * at_node.cos;
    if (by_force) {
      const T tangent = at_node.sin / at_node.cos;
      put(turned * (grows - tangent), a, i);
      put(turned * (tangent * idle + T(S(3)) * hoops.rho * at_node.cos * torque), b, i);
    } else {
      put(turned * grows, a, i);
      put(turned * T(S(2)) * (at.turn * idle + torque), b, i);
    }
    put(w, weight, i);
    put(x, angle, i);
  }
  if (panel.indeterminate) return;

  panel.growth = grid_.integrals(a);
  Values grown_by, driven;
  for (std::size_t i = 0; i < nodes; i += width) {
    const T grown = exp(get(panel.growth, i));
    put(grown, grown_by, i);
    put(get(b, i) / grown, driven, i);
  }
  panel.driven = grid_.integrals(driven);
  const S start_u = from.spin * from.spin, start_force = slide.free_force;
  const S start_y = panel.start_y = by_force ? start_force : start_u;
  const S end_y = exp(grid_.integral(a)) * (start_y + grid_.integral(driven));
  const auto force = [&]<class R>(const Hoop<R>& hoop_at, const Trig<R>& at, const R& y) {
    return by_force ? y : free_normal_force(hoop_at, at, y);
  };
  const auto force_rate = [&]<class R>(const Hoop<R>& hoop_at, const Trig<R>& at, const R& u, const R& n0,
                                       const R& turn) {
    return free_normal_force_rate(hoop_at, at, u, R(turn * n0 + hoop_at.drive / hoop_at.Ic));
  };
  const S end_u = spin_squared(hoop, end_phi, end_y, by_force);
  T least_u(std::min(start_u > S(0) ? start_u : end_u, end_u));
  Values& time_rate = panel.time_rate;
  for (std::size_t i = 0; i < nodes; i += width) {
    const Trig<T>& at = phi[i / width];
    const SlidingCoefficients<T>& there = coefficients[i / width];
    const T y = get(grown_by, i) * (T(start_y) + get(panel.driven, i));
    const T u = spin_squared(hoops, at, y, by_force), n0 = force(hoops, at, y);
    least_u = smaller(least_u, u);
    const T w = get(weight, i), rate = w / sqrt(u);
    put(rate, time_rate, i);
    put(sliding_motion(hoops, at, u, m, there, n0).slip * rate, panel.slip.rate, i);
    put(n0, panel.free_force.value, i);
    put(T(way) * w * force_rate(hoops, at, u, n0, there.turn), panel.free_force.rate, i);
  }
  const auto least = lanes_of(least_u);
  const Number slowest = *std::min_element(least.begin(), least.end());
  panel.spin_vanishes = !(slowest > Number(0));
  if (panel.spin_vanishes) return;

  const S end_force = force(hoop, end_phi, end_y);
  const S end_weight = S(2) * stretch.span * (stretch.begin + stretch.span),
          end_rate = end_weight / sqrt(end_u);
  const S start_weight = S(2) * stretch.span * stretch.begin;
  const SlidingCoefficients<S> start = slide.coefficients(hoop, start_phi, S(0));
  panel.end.spin = way * sqrt(end_u);
  panel.free_force.end = {end_force,
                          way * end_weight * force_rate(hoop, end_phi, end_u, end_force, end.turn)};
  panel.free_force.start = {
      start_force, way * start_weight * force_rate(hoop, start_phi, start_u, start_force, start.turn)};
  // At rest weight over spin has a limit.
  const S start_rate = start_u > S(0) ? S(start_weight / sqrt(start_u)) : time_rate[0];
  panel.slip.start = {
      from.slip, start_rate * sliding_motion(hoop, start_phi, start_u, friction, start, start_force).slip};

  const Values slipped = grid_.integrals(panel.slip.rate);
  Values slip_time;
  for (std::size_t i = 0; i < nodes; ++i) {
    panel.slip.value[i] = from.slip + slipped[i];
    slip_time[i] = panel.slip.value[i] * time_rate[i];
    panel.travel.rate[i] = way * weight[i] + slip_time[i];
  }
  panel.travel.start = {from.travel, way * start_weight + from.slip * start_rate};
  const Values carried = grid_.integrals(slip_time);
  for (std::size_t i = 0; i < nodes; ++i) panel.travel.value[i] = from.travel + way * angle[i] + carried[i];
  const S duration = grid_.integral(time_rate);
  panel.end.time = from.time + duration;
  panel.end.slip = from.slip + grid_.integral(panel.slip.rate);
  panel.end.travel = from.travel + way * length + grid_.integral(slip_time);
  panel.slip.end = {panel.end.slip,
                    end_rate * sliding_motion(hoop, end_phi, end_u, friction, end, end_force).slip};
  panel.travel.end = {panel.end.travel, way * end_weight + panel.end.slip * end_rate};
  const Number noise =
      slide.rounding_at_end(end.pivot) + Number(16) * std::numeric_limits<Number>::epsilon() *
                                             std::min(value_of(start_u) / slowest, Number(1e6));
  const Number of_one = by_force ? Number(1) : largest_part(S(S(1) + start_u));
  panel.excess = largest<Number>({grid_.tail(a), grid_.tail(driven) / of_one,
                                  Number(0.1) * grid_.tail(time_rate) / largest_part(duration),
                                  grid_.tail(panel.slip.rate) / largest_part(S(S(1) + abs(from.slip)))}) /
                 (tolerance_ + noise);
}

template <class S>
auto SlidingPanels<S>::state_at(const Slide& slide, const ContactState<S>& from, const Stretch& stretch,
                                const Panel& panel, const S& place) const -> std::optional<ContactState<S>> {
  using std::exp, std::sqrt;
  const S beside(0.1), small(0.01);
  if (!(place > beside)) return {};
  const S way = panel.turned < S(0) ? S(-1) : S(1);
  ContactState<S> at = from;
  at.angle += way * stretch.angle(place);
  const S y = exp(grid_.value(panel.growth, place)) * (panel.start_y + grid_.value(panel.driven, place));
  const S u = spin_squared(slide.hoop, trig(at.angle), y, panel.by_force);
  if (!(u > small * std::max(from.spin * from.spin, panel.end.spin * panel.end.spin))) return {};
  at.spin = way * sqrt(u);
  at.time += grid_.value(grid_.integrals(panel.time_rate), place);
  at.slip = grid_.value(panel.slip.value, place);
  at.travel = grid_.value(panel.travel.value, place);
  return at;
}

template <class S>
void SlidingPanels<S>::solve_by_time(const Slide& slide, const ContactState<S>& from, const S& duration,
                                     Panel& panel) const {
  using T = typename Grid::T;
  constexpr std::size_t width = Lanes<T>::count;
  using std::abs;
  const Hoop<S>& hoop = slide.hoop;
  const S& friction = slide.friction;
  panel.indeterminate = panel.spin_vanishes = false;
  panel.excess = std::numeric_limits<Number>::infinity();
  Values turned, spin, angular;
  for (std::size_t i = 0; i < nodes; ++i)
    spin[i] = from.spin, turned[i] = from.spin * duration * grid_.node[i];
  bool settled = false;
  int left = has_derivatives<S> ? 6 : 0;  // iterations once the values are settled: derivatives come after
  const Hoop<T> hoops = at_nodes<T>(hoop);
  const T m(friction), length(duration);
  for (int iteration = 0; iteration < most_iterations && !(settled && left-- <= 0); ++iteration) {
    Number least_pivot = value_of(hoop.Ic) + Number(2);
    for (std::size_t i = 0; i < nodes; i += width) {
      const T x = Lanes<T>::load(turned.data() + i);
      const Trig<T> phi = trig(T(from.angle) + x);
      const SlidingCoefficients<T> at = slide.coefficients(hoops, phi, x);
      const auto pivots = lanes_of(at.pivot);
      least_pivot = std::min(least_pivot, *std::min_element(pivots.begin(), pivots.end()));
      if (!(least_pivot > Number(0))) {
        panel.indeterminate = true;
        return;
      }
      const T w = Lanes<T>::load(spin.data() + i), u = w * w;
      const T n0 = free_normal_force(hoops, phi, u);
      const SlidingMotion<T> motion = sliding_motion(hoops, phi, u, m, at, n0);
      Lanes<T>::store(length * motion.angular, angular.data() + i);
      Lanes<T>::store(length * motion.slip, panel.slip.rate.data() + i);
      Lanes<T>::store(n0, panel.free_force.value.data() + i);
      Lanes<T>::store(length * w * free_normal_force_rate(hoops, phi, u, motion.angular),
                      panel.free_force.rate.data() + i);
    }
    const Values gained = grid_.integrals(angular);
    Number change(0), most(1);
    for (std::size_t i = 0; i < nodes; ++i) {
      change = largest<Number>({change, std::abs(value_of(from.spin + gained[i] - spin[i]))});
      most = std::max({most, std::abs(value_of(from.spin)), std::abs(value_of(angular[i]))});
      spin[i] = from.spin + gained[i];
    }
    const Values spun = grid_.integrals(spin);
    for (std::size_t i = 0; i < nodes; ++i) turned[i] = duration * spun[i];
    // Near the edge, or a needle of the spin, accelerations are known to some roundings more.
    constexpr Number epsilon = std::numeric_limits<Number>::epsilon();
    const Number noise = std::min(slide.rounding(least_pivot), Number(1e4) * epsilon);
    settled = change <= (Number(8) * epsilon + noise) * most;
  }
  panel.end.spin = from.spin + grid_.integral(angular);
  panel.turned = duration * grid_.integral(spin);
  panel.end.angle = from.angle + panel.turned;
  const Trig<S> start_phi = trig(from.angle), end_phi = trig(panel.end.angle);
  const SlidingCoefficients<S> at_start = slide.coefficients(hoop, start_phi, S(0)),
                               at_end = slide.coefficients(hoop, end_phi, panel.turned);
  panel.indeterminate = !(at_end.pivot > S(0));
  if (panel.indeterminate) return;
  const auto sample_force = [&](const Trig<S>& phi, const S& w, const SlidingMotion<S>& motion) {
    return Sample<S>{free_normal_force(hoop, phi, S(w * w)),
                     duration * w * free_normal_force_rate(hoop, phi, S(w * w), motion.angular)};
  };
  const auto motion_at = [&](const Trig<S>& phi, const S& w, const SlidingCoefficients<S>& at) {
    const S u = w * w;
    return sliding_motion(hoop, phi, u, friction, at, free_normal_force(hoop, phi, u));
  };
  const SlidingMotion<S> start = motion_at(start_phi, from.spin, at_start),
                         end = motion_at(end_phi, panel.end.spin, at_end);
  panel.free_force.start = sample_force(start_phi, from.spin, start);
  panel.free_force.end = sample_force(end_phi, panel.end.spin, end);
  panel.slip.start = {from.slip, duration * start.slip};
  panel.travel.start = {from.travel, duration * (from.slip + from.spin)};
  const Values slipped = grid_.integrals(panel.slip.rate);
  for (std::size_t i = 0; i < nodes; ++i) {
    panel.slip.value[i] = from.slip + slipped[i];
    panel.travel.rate[i] = duration * (panel.slip.value[i] + spin[i]);
  }
  const Values travelled = grid_.integrals(panel.travel.rate);
  for (std::size_t i = 0; i < nodes; ++i) panel.travel.value[i] = from.travel + travelled[i];
  panel.end.time = from.time + duration;
  panel.end.slip = from.slip + grid_.integral(panel.slip.rate);
  panel.end.travel = from.travel + grid_.integral(panel.travel.rate);
  panel.slip.end = {panel.end.slip, duration * end.slip};
  panel.travel.end = {panel.end.travel, duration * (panel.end.slip + panel.end.spin)};
  if (settled)
    panel.excess = largest<Number>({grid_.tail(angular) / largest_part(S(S(1) + abs(from.spin))),
                                    grid_.tail(panel.slip.rate) / largest_part(S(S(1) + abs(from.slip)))}) /
                   (tolerance_ + slide.rounding_at_end(at_end.pivot));
}

#ifdef LEAPMAP_KERNELS
template class SlidingPanels<double>;
template class SlidingPanels<DesignDual>;
#endif
#ifdef LEAPMAP_SCALARS
template class SlidingPanels<long double>;
#endif

}  // namespace leapmap
