// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/sliding_leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numerics/panel_fall.hpp"
#include "support/stop.hpp"

namespace leapmap {

using namespace panel_lengths;

namespace {

constexpr double near_edge = 0.3;        // the edge matters for rounding from here on [rad]
constexpr double share_of_edge = 0.6;    // a panel goes over so much of the way to the edge
constexpr double at_edge = 1e-13;        // what is left changes nothing that is bounded [rad]
constexpr double nearest_edge = 1e-290;  // nor anything else
constexpr int most_shortened = 40;
constexpr int most_panels = 100'000;  // some slides rock against the edge, some 1e-100 deep

/// The edges on either side of a slide, and how far they are; NaN: none within a turn.
template <class S>
struct EdgesAround {
  struct Side {
    bool known = false;
    PainleveEdge<S> edge{};
    S left{};
  };
  Side behind, ahead;  // at lesser and at greater angles

  Side& on(const S& way) { return way > S(0) ? ahead : behind; }
  /// Looks where nobody has yet.
  void find(const Hoop<S>& hoop, const S& friction, const S& angle, const S& way) {
    Side& side = on(way);
    if (side.known) return;
    side.known = true;
    side.left = left_to_edge(hoop, friction, angle, way);
    const S there = angle + way * side.left;
    side.edge = {trig(there), trig(S(S(2) * there)), way};
  }
  void turn(const S& by) {
    ahead.left -= by;
    behind.left += by;
  }
  /// The nearer of those known, or nothing if it is far.
  const Side* near() const {
    const Side* nearest = nullptr;
    for (const Side* side : {&ahead, &behind})
      if (side->known && side->left < S(near_edge) && !(nearest && nearest->left < side->left))
        nearest = side;
    return nearest;
  }
};

}  // namespace

template <class S>
SlidingLeg<S>::SlidingLeg(double tolerance)
    : panels_(std::max(S(tolerance) * S(0.5), S(100) * std::numeric_limits<S>::epsilon())) {}

template <class S>
auto SlidingLeg<S>::first_event(const ContactState<S>& from, const S& runway, int direction,
                                const Panel& panel) const -> Event {
  using Course = typename Panels::Course;
  const auto extent = [](const Course& course) {
    return extent_of<S, Panels::nodes>(course.value, course.rate, course.start, course.end);
  };
  Event event{S(2), PhaseEnd::failed, false};
  // Where offset + factor times the course falls through zero; of_course: its extent.
  const auto look = [&](PhaseEnd end, const S& offset, const S& factor, const Course& course,
                        const PanelExtent<S>& of_course) {
    if (is_clear_of_zero(panels_.grid(), of_course.of(offset, factor))) return;
    typename Panels::Values values, rates;
    S largest(0);
    for (std::size_t i = 0; i < Panels::nodes; ++i) {
      values[i] = offset + factor * course.value[i];
      rates[i] = factor * course.rate[i];
      largest = std::max(largest, std::abs(values[i]));
    }
    const auto sample = [&](const Sample<S>& at) {
      return Sample<S>{offset + factor * at.value, factor * at.rate};
    };
    const S slack = S(4) * panels_.grid().tail(values) + S(64) * std::numeric_limits<S>::epsilon() * largest;
    const PanelFall<S> fall =
        first_fall(panels_.grid(), values, rates, sample(course.start), sample(course.end), slack);
    event.unsure = event.unsure || fall.unsure;
    if (fall.place < event.place) event.place = fall.place, event.end = end;
  };
  look(PhaseEnd::lifts_off, S(0), S(1), panel.free_force, extent(panel.free_force));
  const PanelExtent<S> slip = extent(panel.slip);
  look(PhaseEnd::slip_ends, S(0), S(direction), panel.slip, slip);
  if (panels_.keeps_within(runway, from, panel, slip)) return event;
  const Course travel = panels_.travel_on(panel);
  const PanelExtent<S> along = extent(travel);
  for (const S downhill : {S(1), S(-1)}) look(PhaseEnd::runway_ends, runway, -downhill, travel, along);
  return event;
}

template <class S>
std::optional<PhaseEnd> SlidingLeg<S>::end_at_edge(const Slide& slide, const ContactState<S>& at,
                                                   const SlidingMotion<S>& motion) {
  if (!(slide.left < S(at_edge))) return {};
  if (slide.left < S(nearest_edge)) return PhaseEnd::indeterminate;
  const Trig<S> phi = trig(at.angle);
  if (phi.cos >= S(0)) return {};  // its spin will be used up before
  const S power = power_at_edge(slide.hoop, phi, slide.friction);
  if (power > S(1) && slide.free_force < S(1e-3) * slide.hoop.cos_slope) return PhaseEnd::lifts_off;
  // The forces grow as left^(power - 1): the slip that they take away until the edge is bounded if power > 0.
  const S taken = std::abs(motion.slip / at.spin) * slide.left / power;
  if (power > S(0) && std::abs(at.slip) > S(2) * taken) return PhaseEnd::indeterminate;
  return {};
}

template <class S>
auto SlidingLeg<S>::Step::part(const S& share) const -> typename Panels::Taken {
  if (!by_angle) return {std::nullopt, duration * share};
  typename Panels::Stretch some = stretch;
  some.span *= share;
  return {some, S(0)};
}

template <class S>
std::optional<PhaseEnd> SlidingLeg<S>::take_panel(const Slide& slide, const ContactState<S>& at, const S& way,
                                                  const S& acceleration, const Bounds& bounds,
                                                  Step& step) const {
  Panel& panel = step.panel;
  const auto shrink = [&] {
    return std::isfinite(panel.excess) ? change(panel.excess, Panels::nodes, S(0.85)) : S(0.5);
  };
  step.by_angle = at.spin != S(0) || acceleration != S(0);
  if (step.by_angle) {
    step.length = std::min(step.length, bounds.longest);
    for (;; step.length *= shrink()) {
      step.stretch = Panels::stretch_of(at.spin, S(way * acceleration), step.length);
      panels_.solve_by_angle(slide, at, step.stretch, panel);
      if (panel.excess <= S(1)) return {};
      const S least =
          panel.spin_vanishes ? std::min(S(vanishing_angle), bounds.longest * S(0.1)) : bounds.shortest;
      if (!(step.length > least)) break;
    }
  }
  step.by_angle = false;
  step.length = S(vanishing_angle);
  for (;; step.duration *= shrink()) {
    panels_.solve_by_time(slide, at, step.duration, panel);
    if (panel.excess <= S(1)) return {};
    if (!(step.duration > bounds.briefest))
      return panel.indeterminate ? PhaseEnd::indeterminate : PhaseEnd::failed;
  }
}

template <class S>
bool SlidingLeg<S>::end_within(const S& place, Slide& slide, ContactState<S>& at, Step& step) const {
  Panel& panel = step.panel;
  if (step.by_angle) {
    const typename Panels::Inside inside = panels_.state_at(slide, at, step.stretch, panel, place);
    if (inside.is_sharp) {
      at = inside.state;
      return true;
    }
    step.stretch.span *= place;  // the panel once more, ending there
    panels_.solve_by_angle(slide, at, step.stretch, panel);
  } else {
    panels_.solve_by_time(slide, at, S(step.duration * place), panel);
  }
  if (!std::isfinite(panel.excess)) return false;
  at = panel.end;
  return true;
}

template <class S>
PhaseEnd SlidingLeg<S>::run(const Hoop<S>& hoop, const S& mu_kinetic, ContactState<S>& at, const S& runway,
                            int direction, std::vector<typename Panels::Taken>* taken) const {
  Slide slide{hoop, direction > 0 ? mu_kinetic : -mu_kinetic, {}, {}, {}};
  const S& friction = slide.friction;
  const bool has_edges = !keeps_off_painleve(hoop, friction);
  const Trig<S> released = trig(at.angle);
  if (!(sliding_coefficients(hoop, released, friction).pivot > S(0))) return PhaseEnd::indeterminate;
  slide.free_force = free_normal_force(hoop, released, S(at.spin * at.spin));
  EdgesAround<S> edges;
  Step step;
  const Panel& panel = step.panel;
  int refined = 0, shortened = 0;
  for (int tried = 0; tried < most_panels; ++tried) {
    throw_if_stopped();
    slide.edge.reset();
    if (const auto* near = edges.near()) slide.edge = near->edge, slide.left = near->left;
    const Trig<S> phi = trig(at.angle);
    const SlidingMotion<S> start = sliding_motion(hoop, phi, S(at.spin * at.spin), friction,
                                                  slide.coefficients(hoop, phi, S(0)), slide.free_force);
    const S way = at.spin < S(0) || (at.spin == S(0) && start.angular < S(0)) ? S(-1) : S(1);
    if (way * hoop.resistance < S(0)) return PhaseEnd::reverses;
    // Near the edge panels are as short as what is left, to which all that happens there is in proportion.
    Bounds bounds{S(longest_angle), S(shortest_angle) * (slide.edge ? slide.left : S(1) + std::abs(at.angle)),
                  S(shortest_time) * (slide.edge ? std::min(slide.left, S(1)) : S(1))};
    if (has_edges) {
      edges.find(hoop, friction, at.angle, way);
      if (slide.edge && slide.edge->way == way)
        if (const auto end = end_at_edge(slide, at, start)) return *end;
      const S left = edges.on(way).left;
      if (!std::isnan(left)) bounds.longest = std::min(bounds.longest, S(share_of_edge) * left);
    }
    if (const auto end = take_panel(slide, at, way, start.angular, bounds, step)) return *end;
    const Event event = first_event(at, runway, direction, panel);
    if (event.unsure && refined < 2) {  // the polynomials of shorter panels are right to rounding
      step.extent() *= S(0.5);
      ++refined;
      continue;
    }
    const S to = std::max(S(2) * event.place, S(0.5 * least_place));
    const S shorter = step.by_angle ? step.stretch.angle(to) : step.duration * to;
    if (comes_too_soon(event.place, at.time, S(panel.end.time - at.time)) &&
        shorter > (step.by_angle ? bounds.shortest : bounds.briefest) && ++shortened < most_shortened) {
      step.extent() = shorter;
      continue;
    }
    refined = shortened = 0;
    if (taken) taken->push_back(step.part(std::min(event.place, S(1))));
    if (event.place > S(1)) {
      edges.turn(panel.turned);
      at = panel.end;
      slide.free_force = panel.free_force.end.value;
      // Roundings do not shrink with it.
      step.extent() *= std::max(change(panel.excess, Panels::nodes, S(2)), S(1));
      step.length = std::min(step.length, S(longest_angle));
      step.duration = std::min(step.duration, S(longest_time));
      continue;
    }
    if (!end_within(event.place, slide, at, step)) return PhaseEnd::failed;
    if (event.end == PhaseEnd::slip_ends) at.slip = S(0);
    return event.end;
  }
  return PhaseEnd::too_long;
}

template <class S>
bool SlidingLeg<S>::advance(const Hoop<S>& hoop, const S& mu_kinetic, ContactState<S>& at, const S& duration,
                            int direction) const {
  const Slide slide{hoop, S(S(direction) * mu_kinetic), {}, {}, {}};
  Panel panel;
  const S end = at.time + duration;
  for (S step = std::min(duration, S(first_time)); at.time < end;) {
    panels_.solve_by_time(slide, at, std::min(step, S(end - at.time)), panel);
    if (panel.excess <= S(1)) {
      at = panel.end;
    } else if ((step *= S(0.5)) < S(shortest_time)) {
      return false;
    }
  }
  return true;
}

#ifdef LEAPMAP_KERNELS
template class SlidingLeg<double>;
#endif
#ifdef LEAPMAP_SCALARS
template class SlidingLeg<long double>;
#endif

}  // namespace leapmap
