// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/sliding_panel.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "numerics/exponential.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {
namespace {

constexpr int most_iterations = 60;

/// The largest, and infinity if any is no number: such a panel is not resolved.
template <class Value>
Value largest(std::initializer_list<Value> values) {
  using Number = ScalarOf<Value>;
  Value most(Number(0));
  for (const Value& value : values)
    most = select(value - value == Value(Number(0)), larger(most, value), Value(Number(HUGE_VAL)));
  return most;
}

/// The least of the nodes that a T holds of an S, or of the one node that it holds of each of its lanes.
template <class S, class T>
ValueOf<S> least_node(const T& values) {
  if constexpr (std::is_same_v<S, T>) {
    return value_of(values);
  } else {
    const auto lanes = lanes_of(values);
    return *std::min_element(lanes.begin(), lanes.end());
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
  const S shift = select(rise > S(0), larger(S(-spin * spin / (S(2) * rise)), S(-length)), S(-length));
  const S begin = sqrt(-shift);
  return {shift, begin, sqrt(length - shift) - begin};
}

template <class S>
auto SlidingPanels<S>::at_nodes(const Slide& slide, const ContactState<S>& from, const Stretch& stretch,
                                const S& way, bool by_force, Values& turning) const -> AtNodes {
  constexpr std::size_t width = Grid::width;
  const auto put = [](const T& value, Values& values, std::size_t i) { Grid::put(value, values, i); };
  const Hoop<T> hoop = widened<T>(slide.hoop);
  AtNodes nodes_at;
  Values angle;  // past the start
  // Two short loops, as the processor looks only so many operations ahead: the next nodes' are then among
  // them, while those of one node wait for each other.
  for (std::size_t i = 0; i < nodes; i += width) {
    const T q = T(stretch.begin) + T(stretch.span) * Grid::shared(grid_.node, i);
    const T x = T(stretch.shift) + T(stretch.curve) * q * q;
    put(q * T(S(2) * way * stretch.curve * stretch.span), turning, i);
    put(x, angle, i);
    nodes_at.phi[i / width] = trig(T(from.angle) + T(way) * x);
  }
  T least(std::numeric_limits<Number>::max());
  const T torque = hoop.drive / hoop.Ic, raised = hoop.rho * torque;
  for (std::size_t i = 0; i < nodes; i += width) {
    const Trig<T>& phi = nodes_at.phi[i / width];
    const SlidingCoefficients<T> at = slide.coefficients(hoop, phi, T(way) * Grid::at(angle, i));
    nodes_at.sliding[i / width] = at;
    least = smaller(least, at.pivot);
    const T idle = hoop.cos_slope + raised * phi.sin;  // n0 at no spin
    // w^2 gains per_force n0 + twice torque by the panel's coordinate.
    const T turned = Grid::at(turning, i), twice = T(S(2)) * turned, per_force = twice * at.turn;
    const T lever = hoop.rho * phi.cos;
    if (by_force) {
      const T tangent = phi.sin / phi.cos;
      put(per_force * lever - turned * tangent, nodes_at.grows, i);
      put(turned * (tangent * idle + T(S(3)) * lever * torque), nodes_at.drives, i);
    } else {
      put(per_force * lever, nodes_at.grows, i);
      put(per_force * idle + twice * torque, nodes_at.drives, i);
    }
  }
  nodes_at.least_pivot = least;
  return nodes_at;
}

// One panel from end to end: its steps share some twenty arrays of nodes.
// NOLINTBEGIN(readability-function-size)
template <class S>
void SlidingPanels<S>::solve_by_angle(const Slide& slide, const ContactState<S>& from, const Stretch& stretch,
                                      Panel& panel) const {
  using std::sqrt;
  constexpr std::size_t width = Grid::width;
  const auto get = [](const Values& values, std::size_t i) { return Grid::at(values, i); };
  const auto put = [](const T& value, Values& values, std::size_t i) { Grid::put(value, values, i); };
  const Hoop<S>& hoop = slide.hoop;
  const Hoop<T> hoops = widened<T>(hoop);
  AtEnd start, end;
  start.phi = trig(from.angle);
  start.sliding = slide.coefficients(hoop, start.phi, S(0));
  const S start_angular = start.sliding.turn * slide.free_force + hoop.drive / hoop.Ic;
  const S way = select((from.spin < S(0)) | ((from.spin == S(0)) & (start_angular < S(0))), S(-1), S(1));
  const S length = stretch.length();
  const Mask rests = stretch.begin + stretch.span == S(0);  // at its end
  panel.spin_vanishes = Mask(false);
  const Value unsolved(std::numeric_limits<Number>::infinity());
  panel.excess = panel.end_excess = unsolved;
  panel.turned = way * length;
  panel.end.angle = from.angle + panel.turned;
  end.phi = trig(panel.end.angle);
  end.sliding = slide.coefficients(hoop, end.phi, S(way * length));
  // With n0 in place of u, where it is the one that vanishes, and the cosine stays away from zero.
  const S farthest = S(-0.2);
  const bool by_force = panel.by_force = has_edges && slide.edge &&
                                         all((slide.free_force < S(0.5) * hoop.cos_slope) &
                                             (start.phi.cos < farthest) & (end.phi.cos < farthest));
  const AtNodes at = at_nodes(slide, from, stretch, way, by_force, panel.turning);
  panel.least_pivot =
      smaller(least_node<S, T>(at.least_pivot), value_of(S(smaller(start.sliding.pivot, end.sliding.pivot))));
  panel.indeterminate = !(panel.least_pivot > Value(Number(0)));
  if (all(panel.indeterminate)) return;

  const typename Grid::Integrated growth = grid_.integrated(at.grows);
  panel.growth = growth.running;
  Values grown_by;
  Values& driven = panel.driven_rate;
  for (std::size_t i = 0; i < nodes; i += width) put(exponential(get(panel.growth, i)), grown_by, i);
  for (std::size_t i = 0; i < nodes; i += width)
    put(get(at.drives, i) * reciprocal(get(grown_by, i)), driven, i);
  const typename Grid::Integrated drives = grid_.integrated(driven);
  panel.driven = drives.running;
  start.u = from.spin * from.spin, start.force = slide.free_force;
  const S start_y = panel.start_y = by_force ? start.force : start.u;
  const S end_growth = exponential(growth.whole), end_driven = drives.whole;
  const S end_y = end_growth * (start_y + end_driven);
  const auto force = [&]<class R>(const Hoop<R>& hoop_at, const Trig<R>& phi, const R& y) {
    return by_force ? y : free_normal_force(hoop_at, phi, y);
  };
  end.u = select(rests, S(0), spin_squared(hoop, end.phi, end_y, by_force));
  end.force = force(hoop, end.phi, end_y);
  // Where it is at rest at an end, the nodes tell.
  const S fast(std::numeric_limits<Number>::max());
  T least_u(smaller(select(start.u > S(0), start.u, fast), select(rests, fast, end.u)));
  Values& time_rate = panel.time_rate;
  Values squared;  // w^2
  for (std::size_t i = 0; i < nodes; i += width) {
    const Trig<T>& phi = at.phi[i / width];
    const T y = get(grown_by, i) * (T(start_y) + get(panel.driven, i));
    const T u = spin_squared(hoops, phi, y, by_force), inverse = T(way) * reciprocal_sqrt(u);
    least_u = smaller(least_u, u);
    put(u, squared, i);
    put(force(hoops, phi, y), panel.free_force.value, i);
    put(get(panel.turning, i) * inverse, time_rate, i);
  }
  const Value slowest = least_node<S, T>(least_u);
  panel.spin_vanishes = !(slowest > Value(Number(0)));
  end.turning = S(2) * way * stretch.curve * stretch.span * (stretch.begin + stretch.span);
  start.turning = S(2) * way * stretch.curve * stretch.span * stretch.begin;
  const Value of_one = by_force ? Value(Number(1)) : largest_part(S(S(1) + start.u));
  const Value spin_error = Value(error_over_tail) * largest<Value>({growth.tail, drives.tail / of_one});
  const Value roundings = slide.rounding_at_end(end.sliding.pivot);
  panel.spin_excess =
      select(panel.indeterminate, panel.excess, Value(spin_error / (Value(tolerance_) + roundings)));
  const auto driven_by = [&](const AtEnd& edge) {
    return edge.turning * S(2) *
           (edge.sliding.turn * free_normal_force(hoop, edge.phi, S(0)) + hoop.drive / hoop.Ic);
  };
  panel.driven_start = {S(0), driven_by(start)};
  panel.driven_end = {end_driven, driven_by(end) / end_growth};
  if (all(panel.spin_vanishes)) return;

  // At rest turning and spin are zero, and their ratio has a limit.
  panel.end.spin = way * sqrt(end.u);
  end.time_rate = select(rests, time_rate[nodes - 1], S(end.turning / panel.end.spin));
  start.time_rate = select(start.u > S(0), S(start.turning / from.spin), time_rate[0]);
  const S duration = grid_.integral(time_rate);
  panel.end.time = from.time + duration;
  panel.sweep = length;
  const Value time_tail = grid_.tail(time_rate) / largest_part(duration);
  const Errors slip = slip_at_nodes(slide, from, at, squared, duration, time_tail, panel);
  fill_ends(slide, from, start, end, duration, panel);
  // Beside the end at rest w^2 has few digits, and little effect.
  const Value lost =
      select(rests, Value(Number(1)), smaller(Value(value_of(start.u) / slowest), Value(Number(1e6))));
  const Value noise = roundings + Value(Number(16) * std::numeric_limits<Number>::epsilon()) * lost;
  const auto excess_of = [&](const Value& error) {
    return select(panel.indeterminate | panel.spin_vanishes, unsolved,
                  Value(error / (Value(tolerance_) + noise)));
  };
  panel.excess = excess_of(largest<Value>({spin_error, Value(error_over_tail) * time_tail, slip.between}));
  panel.end_excess =
      excess_of(largest<Value>({spin_error, integral_error(time_tail, Value(Number(1))), slip.at_end}));
}
// NOLINTEND(readability-function-size)

template <class S>
void SlidingPanels<S>::fill_ends(const Slide& slide, const ContactState<S>& from, const AtEnd& start,
                                 const AtEnd& end, const S& duration, Panel& panel) const {
  const Hoop<S>& hoop = slide.hoop;
  const SlidingMomentum<S> momentum(hoop, slide.friction, start.phi, from.spin);
  if constexpr (has_derivatives<S>)  // else it is integrated
    panel.end.slip = from.slip + momentum.slip_gained(end.phi, panel.end.spin, duration);
  panel.end.travel = from.travel + momentum.travelled(end.phi, duration, from.slip);
  const auto force_at = [&](const AtEnd& edge) {
    const S angular = edge.sliding.turn * edge.force + hoop.drive / hoop.Ic;
    return Sample<S>{edge.force, edge.turning * free_normal_force_rate(hoop, edge.phi, edge.u, angular)};
  };
  const auto slip_rate_at = [&](const AtEnd& edge) {
    return edge.time_rate *
           sliding_motion(hoop, edge.phi, edge.u, slide.friction, edge.sliding, edge.force).slip;
  };
  panel.free_force.start = force_at(start), panel.free_force.end = force_at(end);
  panel.slip.start = {from.slip, slip_rate_at(start)};
  panel.slip.end = {panel.end.slip, slip_rate_at(end)};
  panel.travel_start = {from.travel, start.turning + from.slip * start.time_rate};
  panel.travel_end = {panel.end.travel, end.turning + panel.end.slip * end.time_rate};
}

template <class S>
auto SlidingPanels<S>::slip_at_nodes(const Slide& slide, const ContactState<S>& from, const AtNodes& at,
                                     const Values& squared, const S& duration, const Value& time_tail,
                                     Panel& panel) const -> Errors {
  using std::abs;
  const Value size = largest_part(S(S(1) + abs(from.slip)));
  if constexpr (has_derivatives<S>) {  // asked for at a panel's end, where slip has so much of time's error
    const S gained = momentum_gain(slide.hoop, slide.friction) * duration;
    const Value error = largest_part(gained) / size * time_tail;
    return {Value(error_over_tail) * error, error};
  } else {
    constexpr std::size_t width = Grid::width;
    const auto get = [](const Values& values, std::size_t i) { return Grid::at(values, i); };
    const auto put = [](const T& value, Values& values, std::size_t i) { Grid::put(value, values, i); };
    const Hoop<T> hoop = widened<T>(slide.hoop);
    const T m(slide.friction);
    for (std::size_t i = 0; i < nodes; i += width) {
      const Trig<T>& phi = at.phi[i / width];
      const T u = get(squared, i);
      const SlidingMotion<T> motion =
          sliding_motion(hoop, phi, u, m, at.sliding[i / width], get(panel.free_force.value, i));
      put(get(panel.turning, i) * free_normal_force_rate(hoop, phi, u, motion.angular), panel.free_force.rate,
          i);
      put(motion.slip * get(panel.time_rate, i), panel.slip.rate, i);
    }
    const typename Grid::Integrated slips = grid_.integrated(panel.slip.rate);
    for (std::size_t i = 0; i < nodes; ++i) panel.slip.value[i] = from.slip + slips.running[i];
    panel.end.slip = from.slip + slips.whole;
    return {Value(error_over_tail) * slips.tail / size,
            integral_error(slips.tail, Value(abs(value_of(slips.whole)))) / size};
  }
}

template <class S>
auto SlidingPanels<S>::travel_on(const Panel& panel) const -> Course requires(!has_derivatives<S>) {
  Course travel{panel.travel_start, {}, {}, panel.travel_end};
  for (std::size_t i = 0; i < nodes; ++i)
    travel.rate[i] = panel.turning[i] + panel.slip.value[i] * panel.time_rate[i];
  travel.value = grid_.integrals(travel.rate);
  for (S& value : travel.value) value += panel.travel_start.value;
  return travel;
}

template <class S>
auto SlidingPanels<S>::keeps_within(const S& runway, const ContactState<S>& from, const Panel& panel,
                                    const PanelExtent<S>& slip) const -> Mask requires(!has_derivatives<S>) {
  using std::abs;
  const S fastest = larger(S(abs(slip.least)), S(abs(slip.most))) + slip.steepest * grid_.longest_spacing();
  return abs(from.travel) + panel.sweep + fastest * (panel.end.time - from.time) < runway;
}

template <class S>
auto SlidingPanels<S>::state_at(const Slide& slide, const ContactState<S>& from, const Stretch& stretch,
                                const Panel& panel, const S& place) const -> Inside {
  using std::sqrt;
  const S beside(0.1), small(0.01);
  // The panel's tolerance is one of its whole duration, and times count from the release.
  const Mask is_late = from.time > beside * (panel.end.time - from.time);
  Inside inside{from, Mask((place > beside) | is_late)};
  if (!any(inside.is_sharp)) return inside;
  ContactState<S>& at = inside.state;
  const S way = select(panel.turned < S(0), S(-1), S(1));
  at.angle += way * stretch.angle(place);
  const Values times = grid_.integrals(panel.time_rate);
  // Duals hold no slip at the nodes: theirs follows from spin and time.
  constexpr std::size_t count = has_derivatives<S> ? 3 : 4;
  std::array<const Values*, count> functions{&panel.growth, &panel.driven, &times};
  if constexpr (!has_derivatives<S>) functions[3] = &panel.slip.value;
  const std::array<S, count> there = grid_.template values<count>(functions, place);
  const auto &growth = there[0], &driven = there[1], &elapsed = there[2];
  const S y = exponential(growth) * (panel.start_y + driven);
  const Trig<S> phi = trig(at.angle);
  const S u = spin_squared(slide.hoop, phi, y, panel.by_force);
  inside.is_sharp =
      inside.is_sharp & (u > small * larger(S(from.spin * from.spin), S(panel.end.spin * panel.end.spin)));
  at.spin = way * sqrt(u);
  at.time += elapsed;
  const SlidingMomentum<S> momentum(slide.hoop, slide.friction, trig(from.angle), from.spin);
  if constexpr (has_derivatives<S>)
    at.slip += momentum.slip_gained(phi, at.spin, elapsed);
  else
    at.slip = there[3];
  at.travel += momentum.travelled(phi, elapsed, from.slip);
  return inside;
}

/// In a panel by time.
template <class S>
ContactState<S> SlidingPanels<S>::state_in_time(const Slide& slide, const ContactState<S>& from,
                                                const Panel& panel, const S& place) const {
  const S duration = panel.time_rate[0], elapsed = duration * place;
  const Values turned = grid_.integrals(panel.turning);
  const auto [angle, turning, slip] =
      grid_.template values<3>({&turned, &panel.turning, &panel.slip.value}, place);
  ContactState<S> at = from;
  at.time += elapsed, at.angle += angle, at.spin = turning / duration, at.slip = slip;
  const SlidingMomentum<S> momentum(slide.hoop, slide.friction, trig(from.angle), from.spin);
  at.travel += momentum.travelled(trig(at.angle), elapsed, from.slip);
  return at;
}

template <class S>
ContactState<S> SlidingPanels<S>::state_within(const Slide& slide, const ContactState<S>& from,
                                               const Taken& taken, const Panel& panel, const S& place) const {
  if (place == S(0)) return from;
  if (place == S(1)) return panel.end;
  if (!taken.stretch) return state_in_time(slide, from, panel, place);
  const Inside inside = state_at(slide, from, *taken.stretch, panel, place);
  if (inside.is_sharp) return inside.state;
  Taken part = taken;
  part.stretch->span *= place;
  Panel of_part;
  solve(slide, from, part, of_part);
  return std::isfinite(of_part.excess) ? of_part.end : inside.state;
}

// NOLINTBEGIN(readability-function-size)
template <class S>
void SlidingPanels<S>::solve_by_time(const Slide& slide, const ContactState<S>& from, const S& duration,
                                     Panel& panel) const {
  constexpr std::size_t width = Grid::width;
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
  const Hoop<T> hoops = widened<T>(hoop);
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
  panel.time_rate.fill(duration);
  S fastest = larger(S(abs(from.spin)), S(abs(panel.end.spin)));
  for (const S& one : spin) fastest = larger(fastest, S(abs(one)));
  panel.sweep = duration * fastest;
  const typename Grid::Integrated slipped = grid_.integrated(panel.slip.rate);
  for (std::size_t i = 0; i < nodes; ++i) {
    panel.slip.value[i] = from.slip + slipped.running[i];
    panel.turning[i] = duration * spin[i];
  }
  panel.end.time = from.time + duration;
  panel.end.slip = from.slip + slipped.whole;
  panel.end.travel = from.travel + panel.turned + duration * grid_.integral(panel.slip.value);
  panel.slip.end = {panel.end.slip, duration * end.slip};
  panel.travel_start = {from.travel, duration * (from.slip + from.spin)};
  panel.travel_end = {panel.end.travel, duration * (panel.end.slip + panel.end.spin)};
  if (settled)
    panel.excess = error_over_tail *
                   largest<Number>({grid_.tail(angular) / largest_part(S(S(1) + abs(from.spin))),
                                    slipped.tail / largest_part(S(S(1) + abs(from.slip)))}) /
                   (tolerance_ + slide.rounding_at_end(at_end.pivot));
}
// NOLINTEND(readability-function-size)

#ifdef LEAPMAP_KERNELS
template class SlidingPanels<double>;
template auto SlidingPanels<Batch>::stretch_of(const Batch&, const Batch&, const Batch&) -> Stretch;
template void SlidingPanels<Batch>::solve_by_angle(const Slide&, const ContactState<Batch>&, const Stretch&,
                                                   Panel&) const;
template auto SlidingPanels<Batch>::state_at(const Slide&, const ContactState<Batch>&, const Stretch&,
                                             const Panel&, const Batch&) const -> Inside;
template auto SlidingPanels<Batch>::travel_on(const Panel&) const -> Course;
template auto SlidingPanels<Batch>::keeps_within(const Batch&, const ContactState<Batch>&, const Panel&,
                                                 const PanelExtent<Batch>&) const -> Mask;
template class SlidingPanels<DesignDual>;
template class SlidingPanels<StateDual>;
#endif
#ifdef LEAPMAP_SCALARS
template class SlidingPanels<long double>;
#endif

}  // namespace leapmap
