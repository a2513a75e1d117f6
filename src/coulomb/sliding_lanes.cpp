// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/sliding_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numerics/panel_fall.hpp"

namespace leapmap {

using namespace panel_lengths;

namespace {

constexpr int most_panels = 1'000;           // of a slide in lanes: beyond, it goes on by itself
constexpr double near_edge = 0.05;           // nearer to Painleve's edge n0 needs care [rad]
constexpr double shortest_steep = 0.05;      // a panel that comes nearer is shortened down to this [rad]
constexpr double shortest_by_zeros = 0.01;   // of a panel for the pivot's zeros, as some are rough [rad]
constexpr double shortest_vanishing = 0.01;  // and one on which the spin vanishes, nobody knows where

/// A panel's tail goes about as grown r^-nodes, r the sum of the half-axes of the ellipse that its functions
/// are smooth in, in half-panels, and `grown` what they come to there. Returns (r + 1 / r) / 2, the distances
/// to the panel's ends summed up there, in panels.
double stretch_for(double tolerance, std::size_t nodes) {
  constexpr double grown = 1500.0;  // with less more panels are refused than longer ones save
  return std::cosh(std::log(grown / tolerance) / static_cast<double>(nodes));
}

/// How much of the way to an angle `length` on a slide's pivot stays above `least`, as some looks tell.
template <class T>
T way_to_edge(const Hoop<T>& hoop, const T& friction, const Trig<T>& phi, const T& way, const T& least,
              const T& length) {
  using S = ScalarOf<T>;
  constexpr int looks = 8;
  const T step = length * T(S(1) / S(looks));
  const SinCos<T> turned = sincos_of(way * step);
  const auto spare_at = [&](const T& s, const T& c) {
    return sliding_coefficients(hoop, Trig<T>{s, c, T(S(1)) - c}, friction).pivot - least;
  };
  T sine = phi.sin, cosine = phi.cos, clear = length, before = spare_at(sine, cosine);
  const MaskOf<T> is_there = before <= T(S(0));
  for (int k = 1; k <= looks; ++k) {
    const T last = sine;
    sine = sine * turned.cos + cosine * turned.sin, cosine = cosine * turned.cos - last * turned.sin;
    const T spare = spare_at(sine, cosine);
    const MaskOf<T> first = (spare <= T(S(0))) & (clear == length);
    clear = select(first, step * (T(S(k)) - spare / (spare - before)), clear);
    before = spare;
  }
  return select(is_there, T(S(0)), clear);
}

/// In the order in which SlidingLeg looks at them, as of two at the same place the first counts.
constexpr std::array guards{PhaseEnd::lifts_off, PhaseEnd::slip_ends, PhaseEnd::runway_ends,
                            PhaseEnd::runway_ends};

}  // namespace

template <class T>
SlidingLanes<T>::SlidingLanes(double tolerance, std::size_t most)
    : panels_(std::max(S(tolerance) * S(0.5), S(100) * std::numeric_limits<S>::epsilon())),
      leg_(tolerance),
      slides_(most),
      hoops_(most),
      states_(most),
      zeros_(most),
      stretches_(most) {
  clear_of_zeros_ = stretch_for(panels_.tolerance(), Panels::nodes);
  for (std::size_t k = 0; k < looks_a_turn; ++k) {
    const Trig<S> phi = trig(S(2) * pi_of<S> * S(k) / S(looks_a_turn));
    sin_[k] = phi.sin, cos_[k] = phi.cos;
  }
}

/// Zero if the pivot is above zero all round; else what it is at least, so near to an edge. It is
/// Ic + (rho s)^2 - m rho s (1 - rho c), and between two looks, h apart, it comes down by at most h^2 / 8
/// times |pivot''| <= 2 rho^2 + |m| rho (1 + 2 rho).
template <class T>
ScalarOf<T> SlidingLanes<T>::least_pivot(const Hoop<S>& hoop, const S& friction) const {
  const T rho(hoop.rho), m(friction), one(S(1));
  T least(std::numeric_limits<S>::max());
  for (std::size_t k = 0; k < looks_a_turn; k += width) {
    const T s = rho * Lanes<T>::load(sin_.data() + k), c = Lanes<T>::load(cos_.data() + k);
    least = smaller(least, s * (s - m * (one - rho * c)));
  }
  const auto lanes = lanes_of(least);
  const S step = S(2) * pi_of<S> / S(looks_a_turn), size = std::abs(friction) * hoop.rho;
  const S off = step * step / S(8) * (S(2) * hoop.rho * hoop.rho + size * (S(1) + S(2) * hoop.rho));
  if (hoop.Ic + *std::min_element(lanes.begin(), lanes.end()) > off) return S(0);
  return S(near_edge) * (hoop.rho * hoop.rho + size * (S(1) + hoop.rho));
}

template <class T>
void SlidingLanes<T>::begin(std::uint32_t place, const Hoop<S>& hoop, const S& mu_kinetic,
                            const PivotZeros<S>& zeros, const ContactState<S>& at, const S& runway,
                            int direction) {
  const S friction = direction > 0 ? mu_kinetic : -mu_kinetic;
  slides_[place] = {runway,           mu_kinetic, least_pivot(hoop, friction), direction, false, false,
                    PhaseEnd::failed, 0};
  hoops_.template store<S>({hoop.sin_slope, hoop.cos_slope, hoop.rho, hoop.clearance, hoop.Ic, hoop.J_min,
                            hoop.drive, hoop.thrust},
                           &place, 1);
  states_.template store<S>(
      {at.time, at.travel, at.angle, at.spin, at.slip,
       free_normal_force(hoop, trig(at.angle), S(at.spin * at.spin)), friction, S(longest_angle)},
      &place, 1);
  const S side = S(direction);
  const auto& [angle, height] = zeros;
  zeros_.template store<S>({side * angle[0], side * angle[1], side * angle[2], side * angle[3], height[0],
                            height[1], height[2], height[3]},
                           &place, 1);
  waiting_.push_back(place);
}

template <class T>
ContactState<ScalarOf<T>> SlidingLanes<T>::state_of(std::uint32_t place) const {
  const auto [time, travel, angle, spin, slip, force, friction, length] = states_.template load<S>(&place);
  return {time, travel, angle, spin, slip};
}

/// The rest of a slide by itself.
template <class T>
void SlidingLanes<T>::alone(std::uint32_t place, std::vector<EndedPhase<S>>& ended) {
  const auto [sin_slope, cos_slope, rho, clearance, Ic, J_min, drive, thrust] =
      hoops_.template load<S>(&place);
  const Slide& slide = slides_[place];
  ContactState<S> at = state_of(place);
  const PhaseEnd end = leg_.run({sin_slope, cos_slope, rho, clearance, Ic, J_min, drive, thrust},
                                slide.mu_kinetic, at, slide.runway, slide.direction);
  ended.push_back({place, end, at});
}

template <class T>
auto SlidingLanes<T>::first_events(const Panel& panel, const T& runway, const T& direction,
                                   const MaskOf<T>& asked) const -> Events {
  using std::abs;
  constexpr std::size_t nodes = Panels::nodes;
  const typename Panels::Grid& grid = panels_.grid();
  Events events{T(S(2)), {}, MaskOf<T>(true)};
  const T zero(S(0)), one(S(1));
  const std::array<const typename Panels::Course*, 4> courses{&panel.free_force, &panel.slip, &panel.travel,
                                                              &panel.travel};
  const std::array<T, 4> offsets{zero, zero, runway, runway}, factors{one, direction, -one, one};
  for (std::size_t g = 0; g < guards.size(); ++g) {
    const auto& course = *courses[g];
    const T &offset = offsets[g], &factor = factors[g];
    const PanelExtent<T> extent =
        extent_of<T, nodes>(course.value, course.rate, course.start, course.end).of(offset, factor);
    const MaskOf<T> near = asked & !is_clear_of_zero(grid, extent);
    if (!any(near)) continue;
    typename Panels::Values values, rates;
    for (std::size_t i = 0; i < nodes; ++i)
      values[i] = offset + factor * course.value[i], rates[i] = factor * course.rate[i];
    const auto sample = [&](const Sample<T>& at) {
      return Sample<T>{offset + factor * at.value, factor * at.rate};
    };
    const T slack = T(S(4)) * grid.tail(values) + T(S(64) * std::numeric_limits<S>::epsilon()) *
                                                      larger(T(abs(extent.least)), T(abs(extent.most)));
    const PlainFall<T> fall =
        plain_fall(grid, values, rates, sample(course.start), sample(course.end), slack, near);
    events.plain = events.plain & (fall.is_plain | !near);
    const MaskOf<T> first = near & fall.is_plain & (fall.place < events.place);
    events.place = select(first, fall.place, events.place);
    const unsigned bits = Lanes<T>::bits(first);
    for (std::size_t i = 0; i < width; ++i)
      if (bits >> i & 1u) events.end[i] = guards[g];
  }
  return events;
}

/// w^2 falls to zero where what it is driven by has used up what it began with.
template <class T>
auto SlidingLanes<T>::rest(const typename Panels::Stretch& stretch, const Panel& panel,
                           const MaskOf<T>& asked) const -> Rest {
  using std::abs;
  typename Panels::Values left;
  T most = panel.start_y;
  for (std::size_t i = 0; i < Panels::nodes; ++i)
    left[i] = panel.start_y + panel.driven[i], most = larger(most, T(abs(left[i])));
  const T slack = T(S(4)) * panels_.grid().tail(left) + T(S(64) * std::numeric_limits<S>::epsilon()) * most;
  const PlainFall<T> fall =
      plain_fall(panels_.grid(), left, panel.driven_rate, {panel.start_y, panel.driven_start.rate},
                 {panel.start_y + panel.driven_end.value, panel.driven_end.rate}, slack, asked);
  return {asked & fall.is_plain & (fall.place <= T(S(1))), stretch.angle(fall.place)};
}

template <class T>
void SlidingLanes<T>::pass(std::vector<EndedPhase<S>>& ended) {
  using std::abs, std::sqrt;
  if (waiting_.empty()) return;
  const std::size_t count = std::min(width, waiting_.size()), first = waiting_.size() - count;
  std::array<std::uint32_t, width> index;
  LaneArray<T> runways, directions, pivots, given_lanes, ending_lanes;
  for (std::size_t i = 0; i < width; ++i) {
    index[i] = waiting_[first + (i < count ? i : 0)];
    const Slide& slide = slides_[index[i]];
    runways[i] = slide.runway, directions[i] = S(slide.direction), pivots[i] = slide.least_pivot;
    given_lanes[i] = S(slide.is_given), ending_lanes[i] = S(slide.ends);
  }
  waiting_.resize(first);
  const T zero(S(0)), one(S(1));
  const MaskOf<T> is_given = Lanes<T>::load(given_lanes.data()) > zero,
                  is_last = Lanes<T>::load(ending_lanes.data()) > zero;

  const auto [sin_slope, cos_slope, rho, clearance, Ic, J_min, drive, thrust] =
      hoops_.template load<T>(index.data());
  const auto [time, travel, angle, spin, slip, force, friction, longest] =
      states_.template load<T>(index.data());
  const auto [zero_0, zero_1, zero_2, zero_3, height_0, height_1, height_2, height_3] =
      zeros_.template load<T>(index.data());
  const auto [shift, begin, span, curve] = stretches_.template load<T>(index.data());
  const typename Panels::Slide slide{
      {sin_slope, cos_slope, rho, clearance, Ic, J_min, drive, thrust}, friction, {}, {}, force};
  const ContactState<T> from{time, travel, angle, spin, slip};

  // By angle while the hoop turns.
  const Trig<T> phi = trig(angle);
  const SlidingMotion<T> start = sliding_motion(slide.hoop, phi, T(spin * spin), friction,
                                                slide.coefficients(slide.hoop, phi, zero), force);
  const MaskOf<T> at_rest = spin == zero, turns = !(at_rest & (start.angular == zero));
  const T way = select((spin < zero) | (at_rest & (start.angular < zero)), -one, one);
  const T rise = way * start.angular;
  auto usual = Panels::stretch_of(spin, rise, longest);
  T length = resolved_length(
      PivotZeros<T>{{zero_0, zero_1, zero_2, zero_3}, {height_0, height_1, height_2, height_3}}, angle, way,
      usual.shift, clear_of_zeros_, longest);
  length = larger(length, smaller(longest, T(S(shortest_by_zeros))));
  const T steepest = Lanes<T>::load(pivots.data());
  if (any(steepest > zero)) {
    const T clear = T(S(0.98)) * way_to_edge(slide.hoop, friction, phi, way, steepest, length);
    length = select(steepest > zero, smaller(larger(clear, T(S(shortest_steep))), length), length);
  }
  usual.span = sqrt(length - usual.shift) - usual.begin;
  const typename Panels::Stretch stretch{select(is_given, shift, usual.shift),
                                         select(is_given, begin, usual.begin),
                                         select(is_given, span, usual.span), select(is_given, curve, one)};
  panels_.solve_by_angle(slide, from, stretch, panel_);

  const MaskOf<T> is_steep = !(panel_.least_pivot > Lanes<T>::load(pivots.data()));
  const MaskOf<T> finite = panel_.excess < T(std::numeric_limits<S>::infinity());
  const MaskOf<T> solved = turns & !is_steep & finite & (is_last | (panel_.excess <= one));
  const MaskOf<T> looks = solved & !is_last;
  const Events events =
      first_events(panel_, Lanes<T>::load(runways.data()), Lanes<T>::load(directions.data()), looks);
  const MaskOf<T> comes = looks & events.plain & (events.place <= one);
  const MaskOf<T> too_long =
      comes & (panel_.end.time - time > T(S(longest_time))) & (events.place < T(S(least_place)));
  const MaskOf<T> goes_on = looks & events.plain & !comes;
  typename Panels::Inside inside{from, MaskOf<T>(false)};
  if (any(comes)) inside = panels_.state_at(slide, from, stretch, panel_, smaller(events.place, one));
  const MaskOf<T> sharp = comes & inside.is_sharp;

  // Where the spin vanishes the next panel ends there, unless the hoop has hardly set out: then halfway.
  MaskOf<T> stops = turns & !is_steep & !is_given & panel_.spin_vanishes & !at_rest;
  const MaskOf<T> unresolved = stops & !(panel_.spin_excess <= one);
  stops = stops & !unresolved;
  Rest there{stops, zero};
  if (any(stops)) there = rest(stretch, panel_, stops);
  stops = there.is_known;
  const MaskOf<T> halfway = stops & (rise > zero) & (T(S(-2)) * usual.shift < there.length);
  const auto to_rest = Panels::stretch_to_rest(there.length);

  const auto shrunk_by = [&](const T& excess) {
    return select(excess < T(std::numeric_limits<S>::infinity()), change(excess, Panels::nodes, S(0.85)),
                  T(S(0.5)));
  };
  const T least = select(
      is_steep, T(S(shortest_steep)),
      select(panel_.spin_vanishes, T(S(shortest_vanishing)), T(S(shortest_angle)) * (one + T(abs(angle)))));
  const MaskOf<T> shrinks = turns & !is_given & !solved & !stops & (length > least);
  // A panel to where the spin vanishes that its nodes do not resolve: half of the way first.
  const MaskOf<T> falls_back =
      turns & is_given & !is_last & !is_steep & !solved & (stretch.length() > T(S(shortest_vanishing)));
  const T shrunk = length * select(unresolved, shrunk_by(panel_.spin_excess),
                                   select(is_steep, T(S(0.5)), shrunk_by(panel_.excess)));
  const T grown =
      smaller(larger(longest, length * change(panel_.excess, Panels::nodes, S(2))), T(S(longest_angle)));
  const MaskOf<T> halves = halfway | falls_back;
  const T half = T(S(0.5)) * select(halfway, there.length, stretch.length());
  const T next_length =
      select(goes_on & !is_given, grown, select(halves, half, select(shrinks, shrunk, longest)));
  const auto next = [&](const T& then, const T& now) { return select(goes_on, then, now); };
  states_.template store<T>(
      {next(panel_.end.time, time), next(panel_.end.travel, travel), next(panel_.end.angle, angle),
       next(panel_.end.spin, spin), next(panel_.end.slip, slip), next(panel_.free_force.end.value, force),
       friction, next_length},
      index.data(), count);
  // Where an event comes without digits, the same panel once more, ending there.
  stretches_.template store<T>(
      {select(comes, stretch.shift, to_rest.shift), select(comes, stretch.begin, to_rest.begin),
       select(comes, stretch.span * events.place, to_rest.span), select(comes, stretch.curve, to_rest.curve)},
      index.data(), count);

  const unsigned done = Lanes<T>::bits(solved & is_last), ends = Lanes<T>::bits(comes),
                 ends_inside = Lanes<T>::bits(sharp), ends_at_rest = Lanes<T>::bits(stops & !halfway),
                 on = Lanes<T>::bits(goes_on | shrinks | halves), lasts = Lanes<T>::bits(too_long);
  const auto lanes_of_state = [](const ContactState<T>& at) {
    return std::array{lanes_of(at.time), lanes_of(at.travel), lanes_of(at.angle), lanes_of(at.spin),
                      lanes_of(at.slip)};
  };
  const auto insides = lanes_of_state(inside.state), last = lanes_of_state(panel_.end);
  const auto end_as = [&](std::size_t i, const std::array<LaneArray<T>, 5>& lanes, PhaseEnd end) {
    ContactState<S> at{lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i], lanes[4][i]};
    if (end == PhaseEnd::slip_ends) at.slip = S(0);
    ended.push_back({index[i], end, at});
  };
  for (std::size_t i = 0; i < count; ++i) {
    Slide& now = slides_[index[i]];
    const unsigned bit = 1u << i;
    if (++now.panels > most_panels || lasts & bit) {
      alone(index[i], ended);
    } else if (ends_inside & bit) {
      end_as(i, insides, events.end[i]);
    } else if (done & bit) {
      end_as(i, last, now.end);
    } else if ((ends | ends_at_rest | on) & bit) {
      now.is_given = (ends | ends_at_rest) & bit, now.ends = ends & bit;
      now.end = events.end[i];
      waiting_.push_back(index[i]);
    } else {
      alone(index[i], ended);
    }
  }
}

#ifdef LEAPMAP_KERNELS
template class SlidingLanes<Batch>;
#endif

}  // namespace leapmap
