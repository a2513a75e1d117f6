// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/roll_at_times.hpp"

#include <cmath>
#include <limits>

#include "noslip/rolling_motion.hpp"
#include "trajectory/motion_at.hpp"

namespace leapmap {

template <class S>
RollAtTimes<S>::RollAtTimes(const Hoop<S>& hoop, const ContactState<S>& from, std::span<const double> turns,
                            double end, double accuracy)
    : hoop_(hoop), turns_(turns), end_(end), accuracy_(accuracy), from_(from) {
  if constexpr (has_derivatives<S>) {
    // From rest E does not depend on the spin to first order, and yet the time does: a hoop with a small spin
    // is one that was at rest spin / phi'' ago.
    const double acceleration =
        from.spin.value == 0.0 ? angular_acceleration(hoop, trig(from.angle), from.spin).value : 0.0;
    if (acceleration != 0.0)
      for (std::size_t k = 0; k < from.spin.by.size(); ++k)
        from_.time.by[k] -= from.spin.by[k] / acceleration;
    if (from.spin.value == 0.0) from_.spin = S(0.0);
  }
  begin_leg();
}

template <class S>
std::optional<double> RollAtTimes<S>::next_turn(const Roll<S>& roll) const {
  const Roll<double> plain_roll = plain(roll);
  const FirstMinimum<double> first = first_minimum(plain_roll, slope_of(plain_roll.hoop));
  if (!first.is_real || vis_viva_past_release(plain_roll, first.angle - plain_roll.release) > 0.0) return {};
  return way_ * (plain_roll.release + turning_distance(plain_roll, first, true));
}

template <class S>
void RollAtTimes<S>::begin_leg() {
  const double angle = value_of(from_.angle), spin = value_of(from_.spin);
  const Hoop<double> hoop = mapped<double>(hoop_, [](const S& number) { return value_of(number); });
  const bool comes_from_rest = ahead_.has_value();
  if (comes_from_rest && hoop.resistance != 0.0) rests_ = true;  // what it would do else is not followed
  way_ = way_of(hoop, angle, spin);
  if (way_ == 0.0) rests_ = true;
  if (rests_) return;
  const Roll<S> roll = begin_roll(seen(hoop_, S(way_)), S(way_ * from_.angle), S(way_ * from_.spin));
  std::optional<double> turn;
  if (!turns_.empty()) {
    turn = turns_.front();
    turns_ = turns_.subspan(1);
  } else if (!std::isfinite(end_)) {
    turn = next_turn(roll);
  }
  ahead_.emplace(roll, accuracy_);
  back_.reset();
  constexpr double unbounded = std::numeric_limits<double>::max();
  length_ = S(std::isfinite(end_) ? way_ * (end_ - angle) : unbounded);
  if (!turn) return;
  const S to_rest = length_to_rest(roll, way_ * (*turn - angle));
  rest_angle_ = from_.angle + way_ * to_rest, length_ = 0.5 * to_rest;
  back_.emplace(begin_roll(seen(hoop_, S(-way_)), S(-way_ * rest_angle_), S(0.0)), accuracy_);
}

template <class S>
auto RollAtTimes<S>::seen_back(const typename RollPanels<S>::At& on_roll, const S& angle, double way,
                               double time) const -> At {
  ContactState<S> state = from_;
  state.time = S(time);
  state.angle = angle + way * on_roll.past;
  state.travel += state.angle - from_.angle;
  state.spin = way_ * on_roll.spin;
  return {state, way * on_roll.acceleration};
}

template <class S>
auto RollAtTimes<S>::at(double time) -> At {
  constexpr double ever = std::numeric_limits<double>::infinity();
  for (; !rests_ && is_known_; begin_leg()) {
    const S since = S(time) - from_.time;
    if (!(since > S(0.0))) {  // at the leg's begin, or before it by a rounding
      const double acceleration = value_of(angular_acceleration(hoop_, trig(from_.angle), from_.spin));
      return seen_back(
          {way_ * from_.spin * since, way_ * (from_.spin + acceleration * since), way_ * acceleration},
          from_.angle, way_, time);
    }
    is_known_ = ahead_->reach(value_of(since), length_);
    if (is_known_ && !(back_ && since > ahead_->time()))
      return seen_back(ahead_->at(since), from_.angle, way_, time);
    // E vanishes at the leg's end, too: its second half is timed from there.
    is_known_ = is_known_ && back_->reach(ever, length_);
    const S rests_at = from_.time + ahead_->time() + back_->time(), left = rests_at - S(time);
    if (is_known_ && left > S(0.0)) return seen_back(back_->at(left), rest_angle_, -way_, time);
    from_.travel += rest_angle_ - from_.angle;
    from_.angle = rest_angle_, from_.time = rests_at, from_.spin = S(0.0);
  }
  if (rests_) return {from_, 0.0};
  return {{.angle = S(std::numeric_limits<double>::quiet_NaN())}, 0.0};
}

#ifdef LEAPMAP_KERNELS
template class RollAtTimes<double>;
template class RollAtTimes<FewDual>;
template class RollAtTimes<DesignDual>;
#endif

}  // namespace leapmap
