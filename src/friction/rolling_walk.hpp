// SPDX-License-Identifier: GPL-3.0-or-later
/// A rolling leg seen from angle to angle: between which two of them friction, or the spin, may be used up.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "friction/contact_phases.hpp"
#include "hoop/stick.hpp"
#include "numerics/first_fall.hpp"

namespace leapmap {

/// How a leg ends, and at what angle.
template <class S>
struct LegEnd {
  PhaseEnd end;
  S angle;  ///< NaN: it goes on
};

/// The leg's end as it is, when it was seen from the other side.
inline PhaseEnd turned_over(PhaseEnd end) {
  return end == PhaseEnd::slips_backwards  ? PhaseEnd::slips_forwards
         : end == PhaseEnd::slips_forwards ? PhaseEnd::slips_backwards
                                           : end;
}

/// E and the guards of sticking at an angle of a leg.
template <class S>
struct Look {
  S angle;
  Sample<S> vis_viva;
  StickGuards<S> guards;
};

/// Looks at as many neighbouring angles as there are lanes, and at the one before them, one after the other.
template <class T>
class LooksInARow {
 public:
  using S = ScalarOf<T>;

  /// before: with that one in its last lane.
  LooksInARow(const Look<T>& before, const Look<T>& now) {
    const auto numbers_of_look = [](const Look<T>& look) {
      return std::array{look.angle,
                        look.vis_viva.value,
                        look.vis_viva.rate,
                        look.guards.downhill.value,
                        look.guards.downhill.rate,
                        look.guards.uphill.value,
                        look.guards.uphill.rate};
    };
    const auto a = numbers_of_look(before), b = numbers_of_look(now);
    for (std::size_t k = 0; k < a.size(); ++k) {
      Lanes<T>::store(a[k], numbers_[k].data());
      Lanes<T>::store(b[k], numbers_[k].data() + width);
    }
  }
  /// From 0, the one before the lanes, to their number.
  Look<S> at(std::size_t k) const {
    const auto number = [&](std::size_t of) { return numbers_[of][width - 1 + k]; };
    return {number(0), {number(1), number(2)}, {{number(3), number(4)}, {number(5), number(6)}}};
  }

 private:
  static constexpr std::size_t width = Lanes<T>::count;
  std::array<std::array<S, 2 * width>, 7> numbers_;
};

/// Between which of such neighbours neither spin nor friction is used up, a bit for each two.
template <class T>
unsigned clear_between(const Look<T>& before, const Look<T>& now) {
  const T apart = now.angle - moved_up(before.angle, now.angle);
  const auto stays = [&](const Sample<T>& a, const Sample<T>& b) {
    const Sample<T> left{moved_up(a.value, b.value), moved_up(a.rate, b.rate)};
    return (smaller(left.value, b.value) > T(ScalarOf<T>(0))) & stays_above(left, b, apart);
  };
  return Lanes<T>::bits(stays(before.vis_viva, now.vis_viva) &
                        stays(before.guards.downhill, now.guards.downhill) &
                        stays(before.guards.uphill, now.guards.uphill));
}

/// What a leg looks like at its angles. roll: of the phase's beginning, near which E is known best, as seen
/// on the leg; begin: of the leg's.
template <class S>
class LegView {
 public:
  LegView(const Roll<S>& roll, const Roll<S>& begin, const S& mu_static)
      : roll_(roll), begin_(begin), mu_static_(mu_static) {}

  Look<S> at(const S& angle) const { return at(angle, trig(angle)); }
  /// phi: trig(angle).
  Look<S> at(const S& angle, const Trig<S>& phi) const {
    const S E = vis_viva(roll_, angle, phi);
    return {angle, {E, S(2) * torque(roll_.hoop, phi)}, stick_guards(roll_.hoop, phi, E, mu_static_)};
  }

  /// From rest E's first zero is the beginning itself, known by its push.
  Look<S> at_begin() const {
    Look<S> look = at(begin_.release, begin_.release_trig);
    look.vis_viva = {begin_.released, S(2) * begin_.push};
    return look;
  }

  /// Whichever comes first between two angles near each other: friction used up either way, or the spin.
  LegEnd<S> first_end(const Look<S>& left, const Look<S>& right) const {
    const auto fall_of = [&](Sample<S> StickGuards<S>::*guard) {
      return first_fall([&](const S& x) { return at(x).guards.*guard; }, left.angle, right.angle,
                        left.guards.*guard, right.guards.*guard);
    };
    const auto vis_viva_at = [&](const S& x) {
      return Sample<S>{vis_viva_past_release(roll_, S(x - roll_.release)),
                       S(2) * torque(roll_.hoop, trig(x))};
    };
    const S backwards = fall_of(&StickGuards<S>::downhill), forwards = fall_of(&StickGuards<S>::uphill);
    const S stall = first_fall(vis_viva_at, left.angle, right.angle, left.vis_viva, right.vis_viva);
    // NaN is never before anything.
    if (!std::isnan(stall) && !(backwards <= stall) && !(forwards <= stall)) return {PhaseEnd::stalls, stall};
    if (!std::isnan(backwards) && !(forwards < backwards)) return {PhaseEnd::slips_backwards, backwards};
    return {PhaseEnd::slips_forwards, forwards};
  }

  const Roll<S>& roll() const { return roll_; }
  const Roll<S>& begin() const { return begin_; }
  const S& mu_static() const { return mu_static_; }

 private:
  const Roll<S>& roll_;
  const Roll<S>& begin_;
  S mu_static_;
};

/// Walks along a leg from node to node, T as many at once as there are lanes.
template <class S, class T = AbreastOf<S>>
class RollingWalk {
 public:
  RollingWalk() {
    for (std::size_t k = 0; k < sin_.size(); ++k) {
      const Trig<S> phi = trig(S(2) * std::numbers::pi_v<S> * S(k % looks_a_turn) / S(looks_a_turn));
      sin_[k] = phi.sin, cos_[k] = phi.cos, versine_[k] = phi.versine;
    }
    for (std::size_t k = 0; k < counted_.size(); ++k) counted_[k] = S(k);
  }

  /// Calls ends(left, right) where the leg may end between two looks, until that returns true, or up to
  /// `last`, which comes as a node of its own. at_begin: the view's.
  template <class Ends>
  void run(const LegView<S>& view, const Look<S>& at_begin, const S& last, const Ends& ends) const {
    constexpr std::size_t width = Lanes<T>::count;
    constexpr long turn = looks_a_turn;
    const S step = S(2) * std::numbers::pi_v<S> / S(looks_a_turn);
    const Roll<T> rolls = widened<T>(view.roll());
    Look<T> before = in_all_lanes(at_begin);
    S left_at = at_begin.angle;
    for (long node = static_cast<long>(std::floor(view.begin().release / step)) + 1;; node += width) {
      const auto first = static_cast<std::size_t>((node % turn + turn) % turn);
      const Trig<T> phi{Lanes<T>::load(sin_.data() + first), Lanes<T>::load(cos_.data() + first),
                        Lanes<T>::load(versine_.data() + first)};
      Look<T> now;
      now.angle = (T(S(node)) + Lanes<T>::load(counted_.data())) * T(step);
      const T E = vis_viva(rolls, now.angle, phi);
      now.vis_viva = {E, T(S(2)) * torque(rolls.hoop, phi)};
      now.guards = stick_guards(rolls.hoop, phi, E, T(view.mu_static()));
      constexpr unsigned all = (1u << width) - 1u;
      // One bit for each look, and for the way to it.
      const unsigned beyond = Lanes<T>::bits(!(now.angle < T(last)));
      unsigned stops = (~clear_between(before, now) & all) | beyond;
      // Else the leg begins at the first node, but for rounding: that node is left out, and the beginning
      // takes its place as the second one's neighbour.
      const bool in_order = S(node) * step > left_at;
      if (!in_order) stops |= 3u & all;
      if (stops != 0) {
        const LooksInARow<T> looks(before, now);
        for (; stops != 0; stops &= stops - 1) {
          const auto right = static_cast<unsigned>(std::countr_zero(stops)) + 1;
          const bool is_last = beyond >> (right - 1) & 1u;
          if (!in_order && right == 1 && !is_last) continue;
          const unsigned left = !in_order && right == 2 ? 0 : right - 1;
          if (ends(looks.at(left), is_last ? view.at(last) : looks.at(right)) || is_last) return;
        }
      }
      if (in_order || width > 1) before = now, left_at = S(node + static_cast<long>(width) - 1) * step;
    }
  }

 private:
  static Look<T> in_all_lanes(const Look<S>& look) {
    const auto sample = [](const Sample<S>& one) { return Sample<T>{T(one.value), T(one.rate)}; };
    return {T(look.angle), sample(look.vis_viva), {sample(look.guards.downhill), sample(look.guards.uphill)}};
  }

  static constexpr std::size_t looks_a_turn = 48;
  /// One turn, and as many nodes more as there may be lanes.
  std::array<S, looks_a_turn + 16> sin_, cos_, versine_;
  std::array<S, Lanes<T>::count> counted_;  // 0, 1, 2, ...
};

}  // namespace leapmap
