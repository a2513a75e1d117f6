// SPDX-License-Identifier: GPL-3.0-or-later
/// A slide once more, over the panels that the exact solver took: to carry derivatives along, or to look
/// between its ends.
#pragma once

#include <algorithm>
#include <cmath>

#include "friction/sliding_panel.hpp"
#include "hoop/sliding.hpp"

namespace leapmap {

/// S: double, or a dual.
template <class S>
class SlideAgain {
 public:
  using Panels = SlidingPanels<S>;
  using Slide = typename Panels::Slide;
  using Taken = typename Panels::Taken;
  using Panel = typename Panels::Panel;

  /// panels: to a tolerance no coarser than that of the slide. They must outlive this.
  SlideAgain(const Panels& panels, const Hoop<S>& hoop, const S& friction)
      : panels_(panels), slide_{hoop, friction, {}, {}, {}} {}

  /// Begins a slide.
  void begin(ContactState<S>& at) {
    slide_.free_force = free_normal_force(slide_.hoop, trig(at.angle), S(at.spin * at.spin));
    if constexpr (has_derivatives<S>)
      if (at.spin == S(0)) set_out_from_rest(at);
  }
  /// Moves a state over the panels, in halves where one resolves the values but not their derivatives.
  /// visit(slide, from, taken, panel): each panel that was solved, in order, and the state that it begins at.
  /// False: one is not resolved.
  template <class Visit>
  bool over(const RecordedSlide<double>& recorded, ContactState<S>& at, const Visit& visit) {
    return std::all_of(recorded.begin(), recorded.end(), [&](const SlidePanel<double>& one) {
      return over_panel(part_of(one, at), HUGE_VAL, at, visit);
    });
  }
  /// The same over a time, by new panels. Whatever would end the slide is ignored, except that a resistance
  /// stops the hoop. False: it stopped, and the spin is zero, or a panel is not resolved.
  template <class Visit>
  bool over_time(double duration, ContactState<S>& at, const Visit& visit) {
    constexpr double longest = 0.25, shortest = 1e-9;  // [sqrt(R/g)]
    constexpr int most_tries = 20'000;
    Panel panel;
    double step = longest;
    for (int tried = 0; duration > 0.0; ++tried) {
      step = std::min(step, duration);
      const Taken taken{{}, S(step)};
      panels_.solve(slide_, at, taken, panel);
      const bool stops = value_of(panel.end.spin) * value_of(slide_.hoop.resistance) < 0.0;
      if (is_resolved(panel.excess) && !stops) {
        duration -= step;
        step = std::min(2.0 * step, longest);
        move(at, taken, panel, visit);
        continue;
      }
      if ((step *= 0.5) >= shortest && tried < most_tries) continue;
      if (stops && is_resolved(panel.excess)) at.spin = S(0);
      return false;
    }
    return true;
  }

 private:
  static constexpr int most_halvings = 2'000;

  /// Derivatives need fewer digits than values.
  static bool is_resolved(double excess) { return excess <= (has_derivatives<S> ? 1e3 : 1.0); }

  template <class Visit>
  void move(ContactState<S>& at, const Taken& taken, const Panel& panel, const Visit& visit) {
    visit(slide_, at, taken, panel);
    at = panel.end;
    slide_.free_force = panel.free_force.end.value;
    if constexpr (has_derivatives<S>) hold_times(at);
  }

  /// Beside a turn derivatives at a given angle are large, and what is lost of them would grow from turn to
  /// turn. Where those at a given time are far smaller they take their place; beside Painleve's edge they are
  /// larger.
  void hold_times(ContactState<S>& at) {
    constexpr double far = 0.1;
    const SlidingMotion<S> motion =
        sliding_motion(slide_.hoop, trig(at.angle), S(at.spin * at.spin), slide_.friction);
    const ContactState<S> held =
        a_little_later(at, motion.angular, motion.slip, S(S(at.time.value) - at.time));
    S later(0.0);
    for (std::size_t k = 0; k < later.by.size(); ++k)
      if (largest_derivative(held, k) < far * largest_derivative(at, k)) later.by[k] = -at.time.by[k];
    if (!(largest_part(later) > 0.0)) return;
    at = a_little_later(at, motion.angular, motion.slip, later);
    slide_.free_force = free_normal_force(slide_.hoop, trig(at.angle), S(at.spin * at.spin));
  }
  static double largest_derivative(const ContactState<S>& at, std::size_t k) {
    return std::max({std::abs(at.time.by[k]), std::abs(at.travel.by[k]), std::abs(at.angle.by[k]),
                     std::abs(at.spin.by[k]), std::abs(at.slip.by[k])});
  }

  /// excess: of the panel that this one is half of.
  template <class Visit>
  bool over_panel(const Taken& taken, double excess, ContactState<S>& at, const Visit& visit) {
    Panel panel;
    panels_.solve(slide_, at, taken, panel);
    if (!std::isfinite(panel.excess)) return false;
    if (!has_derivatives<S> || is_resolved(panel.excess) || !(panel.excess < 0.5 * excess)) {
      move(at, taken, panel, visit);
      return true;
    }
    if (++halvings_ > most_halvings) return false;
    Taken first = taken, second = taken;
    if (taken.stretch) {
      const S half = S(0.5) * taken.stretch->span;
      first.stretch->span = second.stretch->span = half;
      second.stretch->shift -= first.stretch->length(), second.stretch->begin += half;
    } else {
      first.duration = second.duration = S(0.5) * taken.duration;
    }
    return over_panel(first, panel.excess, at, visit) && over_panel(second, panel.excess, at, visit);
  }

  /// The plain solver's panel in duals. Where the hoop has just set out, u = w^2 is small, and time's
  /// derivatives go as u^(-3/2): fixed nodes would not resolve them however well they resolve the values. So
  /// the stretch moves with the zero of u just before its start, as SlidingPanels::stretch_of places it, and
  /// all is smooth along it again. Its end keeps its q. A zero that is farther behind needs no such care,
  /// and would move so much that digits are lost.
  Taken part_of(const SlidePanel<double>& taken, const ContactState<S>& at) const {
    if (!taken.stretch) return {{}, S(taken.duration)};
    const SlideStretch<double>& plain = *taken.stretch;
    SlideStretch<S> stretch{S(plain.shift), S(plain.begin), S(plain.span), S(plain.curve)};
    if constexpr (has_derivatives<S>) {
      const SlidingMotion<S> start =
          sliding_motion(slide_.hoop, trig(at.angle), S(at.spin * at.spin), slide_.friction);
      const S rise = at.spin < S(0) ? -start.angular : start.angular;
      if (at.spin == S(0) || !(rise > S(0))) return {stretch, {}};
      const auto moving = Panels::stretch_of(at.spin, rise, S(HUGE_VAL));
      constexpr double near = 0.25;  // of the panel's length
      const bool is_near = -plain.shift < near * plain.length();
      if (!is_near || !(std::abs(moving.shift.value - plain.shift) <= 1e-3 * std::abs(plain.shift)))
        return {stretch, {}};
      stretch.shift.by = moving.shift.by, stretch.begin.by = moving.begin.by;
      stretch.span = S(plain.begin + plain.span) - stretch.begin;
    }
    return {stretch, {}};
  }

  /// From rest u = w^2 does not depend on the spin to first order, and yet time and slip at an angle do: a
  /// hoop with a small spin is one that was at rest spin / phi'' ago, but for the slip gained since.
  void set_out_from_rest(ContactState<S>& at) const {
    const SlidingMotion<S> motion = sliding_motion(slide_.hoop, trig(at.angle), S(0.0), slide_.friction);
    for (std::size_t k = 0; k < at.spin.by.size(); ++k) {
      const double ago = at.spin.by[k] / motion.angular.value;
      at.time.by[k] -= ago, at.slip.by[k] -= ago * motion.slip.value, at.spin.by[k] = 0.0;
    }
  }

  const Panels& panels_;
  Slide slide_;
  int halvings_ = 0;
};

}  // namespace leapmap
