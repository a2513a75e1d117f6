// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/sliding_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numerics/panel_fall.hpp"

namespace leapmap {

using namespace panel_lengths;

namespace {

constexpr int most_panels = 1'000;           // of a slide in lanes: beyond, it goes on by itself
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
}

template <class T>
void SlidingLanes<T>::begin(std::uint32_t place, const Hoop<S>& hoop, const S& mu_kinetic, const Pivot& pivot,
                            const ContactState<S>& at, const S& runway, int direction) {
  const S friction = direction > 0 ? mu_kinetic : -mu_kinetic;
  slides_[place] = {runway, mu_kinetic, pivot.least, direction, false, false, PhaseEnd::failed, 0};
  hoops_.template store<S>(numbers_of(hoop), &place, 1);
  states_.template store<S>(
      {at.time, at.travel, at.angle, at.spin, at.slip,
       free_normal_force(hoop, trig(at.angle), S(at.spin * at.spin)), friction, S(longest_angle)},
      &place, 1);
  const S side = S(direction);
  const auto& [angle, height] = pivot.zeros;
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
  const Slide& slide = slides_[place];
  ContactState<S> at = state_of(place);
  const PhaseEnd end =
      leg_.run(hoop_of(hoops_.template load<S>(&place)), slide.mu_kinetic, at, slide.runway, slide.direction);
  ended.push_back({place, end, at});
}

template <class T>
auto SlidingLanes<T>::first_events(const InLanes& slides, const MaskOf<T>& asked) const -> Events {
  using std::abs;
  using Course = typename Panels::Course;
  constexpr std::size_t nodes = Panels::nodes;
  const typename Panels::Grid& grid = panels_.grid();
  const auto extent = [](const Course& course) {
    return extent_of<T, nodes>(course.value, course.rate, course.start, course.end);
  };
  Events events{T(S(2)), {}, MaskOf<T>(true)};
  // In the order in which SlidingLeg looks, as of two at the same place the first counts.
  const auto find_fall = [&](PhaseEnd end, const Course& guard, const PanelExtent<T>& of_guard,
                             const MaskOf<T>& near) {
    const auto [bend, tail] = grid.roughness(guard.value);
    const T slack = T(S(4)) * tail + T(S(64) * std::numeric_limits<S>::epsilon()) *
                                         larger(T(abs(of_guard.least)), T(abs(of_guard.most)));
    const PlainFall<T> fall =
        plain_fall(grid, guard.value, guard.rate, guard.start, guard.end, bend, slack, near);
    events.plain = events.plain & (fall.is_plain | !near);
    const MaskOf<T> first = near & fall.is_plain & (fall.place < events.place);
    events.place = select(first, fall.place, events.place);
    const unsigned bits = Lanes<T>::bits(first);
    for (std::size_t i = 0; i < width; ++i)
      if (bits >> i & 1u) events.end[i] = end;
  };
  // Where offset + factor times a course falls through zero, factor 1 or -1.
  const auto look = [&](PhaseEnd end, const T& offset, const T& factor, const Course& course,
                        const PanelExtent<T>& of_course, const MaskOf<T>& of_lanes) {
    const PanelExtent<T> of_guard = of_course.of(offset, factor);
    const MaskOf<T> near = of_lanes & !is_clear_of_zero(grid, of_guard);
    if (!any(near)) return;
    if (all((offset == T(S(0))) & (factor == T(S(1))))) return find_fall(end, course, of_guard, near);
    const auto sample = [&](const Sample<T>& at) {
      return Sample<T>{offset + factor * at.value, factor * at.rate};
    };
    Course guard;
    guard.start = sample(course.start), guard.end = sample(course.end);
    for (std::size_t i = 0; i < nodes; ++i)
      guard.value[i] = offset + factor * course.value[i], guard.rate[i] = factor * course.rate[i];
    find_fall(end, guard, of_guard, near);
  };
  const T zero(S(0)), one(S(1));
  const PanelExtent<T> slip = extent(panel_.slip);
  look(PhaseEnd::lifts_off, zero, one, panel_.free_force, extent(panel_.free_force), asked);
  look(PhaseEnd::slip_ends, zero, slides.direction, panel_.slip, slip, asked);
  const MaskOf<T> may_leave = asked & !panels_.keeps_within(slides.runway, slides.from, panel_, slip);
  if (!any(may_leave)) return events;
  const Course travel = panels_.travel_on(panel_);
  const PanelExtent<T> along = extent(travel);
  for (const T& downhill : {one, -one})
    look(PhaseEnd::runway_ends, slides.runway, -downhill, travel, along, may_leave);
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
  const auto [bend, tail] = panels_.grid().roughness(left);
  const T slack = T(S(4)) * tail + T(S(64) * std::numeric_limits<S>::epsilon()) * most;
  const PlainFall<T> fall =
      plain_fall(panels_.grid(), left, panel.driven_rate, {panel.start_y, panel.driven_start.rate},
                 {panel.start_y + panel.driven_end.value, panel.driven_end.rate}, bend, slack, asked);
  return {asked & fall.is_plain & (fall.place <= T(S(1))), stretch.angle(fall.place)};
}

template <class T>
auto SlidingLanes<T>::take() -> InLanes {
  const std::size_t count = std::min(width, waiting_.size()), first = waiting_.size() - count;
  InLanes slides;
  slides.count = count;
  for (std::size_t i = 0; i < width; ++i) slides.index[i] = waiting_[first + (i < count ? i : 0)];
  waiting_.resize(first);
  const auto of_slide = [&](auto Slide::*member) {
    return gathered<T>([&](std::size_t i) { return slides_[slides.index[i]].*member; });
  };
  const std::uint32_t* index = slides.index.data();
  const auto [time, travel, angle, spin, slip, force, friction, longest] = states_.template load<T>(index);
  slides.slide = {hoop_of(hoops_.template load<T>(index)), friction, {}, {}, force};
  slides.from = {time, travel, angle, spin, slip};
  slides.longest = longest;
  slides.runway = of_slide(&Slide::runway), slides.direction = of_slide(&Slide::direction);
  slides.least_pivot = of_slide(&Slide::least_pivot);
  slides.is_given = of_slide(&Slide::is_given) > T(S(0)), slides.is_last = of_slide(&Slide::ends) > T(S(0));
  const auto [shift, begin, span, curve] = stretches_.template load<T>(index);
  slides.given = {shift, begin, span, curve};
  return slides;
}

template <class T>
auto SlidingLanes<T>::look_ahead(const InLanes& slides) const -> Ahead {
  using std::sqrt;
  const T zero(S(0)), one(S(1));
  const typename Panels::Slide& slide = slides.slide;
  const ContactState<T>& from = slides.from;
  const Trig<T> phi = trig(from.angle);
  const SlidingMotion<T> start = sliding_motion(slide.hoop, phi, T(from.spin * from.spin), slide.friction,
                                                slide.coefficients(slide.hoop, phi, zero), slide.free_force);
  const MaskOf<T> at_rest = from.spin == zero;
  const T way = select((from.spin < zero) | (at_rest & (start.angular < zero)), -one, one);
  Ahead ahead;
  // What reverses against a resisting torque ends by itself.
  ahead.turns = !((at_rest & (start.angular == zero)) | (way * slide.hoop.resistance < zero));
  ahead.rise = way * start.angular;
  auto usual = Panels::stretch_of(from.spin, ahead.rise, slides.longest);
  ahead.shift = usual.shift;

  const auto [zero_0, zero_1, zero_2, zero_3, height_0, height_1, height_2, height_3] =
      zeros_.template load<T>(slides.index.data());
  T length = resolved_length(
      PivotZeros<T>{{zero_0, zero_1, zero_2, zero_3}, {height_0, height_1, height_2, height_3}}, from.angle,
      way, usual.shift, clear_of_zeros_, slides.longest);
  length = larger(length, smaller(slides.longest, T(S(shortest_by_zeros))));
  const MaskOf<T> has_edge = slides.least_pivot > zero;
  if (any(has_edge)) {
    const T clear =
        T(S(0.98)) * way_to_edge(slide.hoop, slide.friction, phi, way, slides.least_pivot, length);
    length = select(has_edge, smaller(larger(clear, T(S(shortest_steep))), length), length);
  }
  ahead.length = length;
  usual.span = sqrt(length - usual.shift) - usual.begin;
  const auto given_or = [&](T Panels::Stretch::*member) {
    return select(slides.is_given, slides.given.*member, usual.*member);
  };
  ahead.stretch = {given_or(&Panels::Stretch::shift), given_or(&Panels::Stretch::begin),
                   given_or(&Panels::Stretch::span), given_or(&Panels::Stretch::curve)};
  return ahead;
}

template <class T>
auto SlidingLanes<T>::look_at_panel(const InLanes& slides, const Ahead& ahead) const -> Seen {
  const T one(S(1));
  Seen seen;
  seen.is_steep = !(panel_.least_pivot > slides.least_pivot);
  const MaskOf<T> finite = panel_.excess < T(std::numeric_limits<S>::infinity());
  const MaskOf<T> sharp = panel_.excess <= one,
                  ends_well = ahead.turns & !seen.is_steep & finite &
                              (slides.is_last | sharp | (panel_.end_excess <= one));
  seen.done = ends_well & slides.is_last;

  const MaskOf<T> looks = ends_well & !slides.is_last;
  seen.events = first_events(slides, looks);
  const MaskOf<T> falls = looks & seen.events.plain & (seen.events.place <= one), comes = falls & sharp;
  seen.goes_on = looks & seen.events.plain & !falls;
  seen.solved = ends_well & (slides.is_last | sharp | seen.goes_on);
  seen.inside = {slides.from, MaskOf<T>(false)};
  if (any(comes))
    seen.inside =
        panels_.state_at(slides.slide, slides.from, ahead.stretch, panel_, smaller(seen.events.place, one));
  const MaskOf<T> too_soon =
      comes_too_soon(seen.events.place, slides.from.time, T(panel_.end.time - slides.from.time));
  seen.ends_inside = comes & seen.inside.is_sharp & !too_soon;
  seen.ends_again = comes & !seen.inside.is_sharp & !too_soon;

  const MaskOf<T> vanishes =
      ahead.turns & !seen.is_steep & !slides.is_given & panel_.spin_vanishes & !(slides.from.spin == T(S(0)));
  seen.unresolved = vanishes & !(panel_.spin_excess <= one);
  seen.rest = {vanishes & !seen.unresolved, T(S(0))};
  if (any(seen.rest.is_known)) seen.rest = rest(ahead.stretch, panel_, seen.rest.is_known);
  seen.hardly_set_out =
      seen.rest.is_known & (ahead.rise > T(S(0))) & (T(S(-2)) * ahead.shift < seen.rest.length);
  return seen;
}

template <class T>
auto SlidingLanes<T>::next_length(const InLanes& slides, const Ahead& ahead, const Seen& seen) const -> Next {
  using std::abs;
  const T one(S(1)), half(S(0.5));
  const auto shrunk_by = [&](const T& excess) {
    return select(excess < T(std::numeric_limits<S>::infinity()), change(excess, Panels::nodes, S(0.85)),
                  half);
  };
  const T shortest_plain = T(S(shortest_angle)) * (one + T(abs(slides.from.angle))),
          least = select(seen.is_steep, T(S(shortest_steep)),
                         select(panel_.spin_vanishes, T(S(shortest_vanishing)), shortest_plain));
  // If a panel is too coarse to locate the event on it, the next panel ends just beyond that event.
  const T beyond_event = ahead.stretch.angle(smaller(T(S(1.1)) * seen.events.place, one));
  const T resolved = ahead.length * select(seen.unresolved, shrunk_by(panel_.spin_excess),
                                           select(seen.is_steep, half, shrunk_by(panel_.excess)));
  const T shrunk = smaller(resolved, beyond_event);
  const T grown = smaller(larger(slides.longest, ahead.length * change(panel_.excess, Panels::nodes, S(2))),
                          T(S(longest_angle)));
  const MaskOf<T> failed = ahead.turns & !seen.solved & !seen.rest.is_known;
  const MaskOf<T> shrinks = failed & !slides.is_given & (ahead.length > least);
  // A panel to where the spin vanishes that its nodes do not resolve: half of the way first.
  const T to_end = ahead.stretch.length();
  const MaskOf<T> falls_back =
      failed & slides.is_given & !slides.is_last & !seen.is_steep & (to_end > T(S(shortest_vanishing)));
  const T halved = half * select(seen.hardly_set_out, seen.rest.length, to_end);
  const MaskOf<T> halves = seen.hardly_set_out | falls_back;
  return {shrinks | halves, select(seen.goes_on & !slides.is_given, grown,
                                   select(halves, halved, select(shrinks, shrunk, slides.longest)))};
}

template <class T>
void SlidingLanes<T>::put(const InLanes& slides, const Ahead& ahead, const Seen& seen, const T& length) {
  const auto next = [&](const T& then, const T& now) { return select(seen.goes_on, then, now); };
  const ContactState<T>&from = slides.from, &end = panel_.end;
  states_.template store<T>(
      {next(end.time, from.time), next(end.travel, from.travel), next(end.angle, from.angle),
       next(end.spin, from.spin), next(end.slip, from.slip),
       next(panel_.free_force.end.value, slides.slide.free_force), slides.slide.friction, length},
      slides.index.data(), slides.count);
  // Where an event comes without digits, the same panel once more, ending there.
  const auto& [shift, begin, span, curve] = ahead.stretch;
  const auto to_rest = Panels::stretch_to_rest(seen.rest.length);
  const auto given = [&](const T& again, const T& rests) { return select(seen.ends_again, again, rests); };
  stretches_.template store<T>({given(shift, to_rest.shift), given(begin, to_rest.begin),
                                given(span * seen.events.place, to_rest.span), given(curve, to_rest.curve)},
                               slides.index.data(), slides.count);
}

template <class T>
void SlidingLanes<T>::pass(std::vector<EndedPhase<S>>& ended) {
  if (waiting_.empty()) return;
  const InLanes slides = take();
  const Ahead ahead = look_ahead(slides);
  panels_.solve_by_angle(slides.slide, slides.from, ahead.stretch, panel_);
  const Seen seen = look_at_panel(slides, ahead);
  const Next next = next_length(slides, ahead, seen);
  put(slides, ahead, seen, next.length);

  // A lane is in one of these at most; what is in none goes on by itself.
  const unsigned done = Lanes<T>::bits(seen.done), ends_inside = Lanes<T>::bits(seen.ends_inside),
                 ends_again = Lanes<T>::bits(seen.ends_again),
                 rests = Lanes<T>::bits(seen.rest.is_known & !seen.hardly_set_out),
                 on = Lanes<T>::bits(seen.goes_on | next.is_shorter);
  const auto lanes_of_state = [](const ContactState<T>& at) {
    return std::array{lanes_of(at.time), lanes_of(at.travel), lanes_of(at.angle), lanes_of(at.spin),
                      lanes_of(at.slip)};
  };
  const auto insides = lanes_of_state(seen.inside.state), last = lanes_of_state(panel_.end);
  const auto end_as = [&](std::size_t i, const std::array<LaneArray<T>, 5>& lanes, PhaseEnd end) {
    ContactState<S> at{lanes[0][i], lanes[1][i], lanes[2][i], lanes[3][i], lanes[4][i]};
    if (end == PhaseEnd::slip_ends) at.slip = S(0);
    ended.push_back({slides.index[i], end, at});
  };
  for (std::size_t i = 0; i < slides.count; ++i) {
    Slide& now = slides_[slides.index[i]];
    const unsigned bit = 1u << i;
    if (++now.panels > most_panels) {
      alone(slides.index[i], ended);
    } else if (ends_inside & bit) {
      end_as(i, insides, seen.events.end[i]);
    } else if (done & bit) {
      end_as(i, last, now.end);
    } else if ((ends_again | rests | on) & bit) {
      now.is_given = (ends_again | rests) & bit, now.ends = ends_again & bit;
      now.end = seen.events.end[i];
      waiting_.push_back(slides.index[i]);
    } else {
      alone(slides.index[i], ended);
    }
  }
}

#ifdef LEAPMAP_KERNELS
template class SlidingLanes<Batch>;
#endif

}  // namespace leapmap
