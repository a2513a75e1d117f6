// SPDX-License-Identifier: GPL-3.0-or-later
/// A rolling leg seen from angle to angle: between which two of them friction, or the spin, may be used up.
#pragma once

#include <array>
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

/// Looks at neighbouring angles, one after the other: the last one of the lanes before, then one a lane.
template <class T>
struct Looks {
  using S = ScalarOf<T>;
  using Numbers = std::array<S, Lanes<T>::count + 1>;
  struct Samples {
    Numbers value, rate;

    /// Stores the lanes. Returns between which neighbours, `apart` from each other, the function surely stays
    /// above zero.
    MaskOf<T> put_lanes(const Sample<T>& lanes, const T& apart) {
      Lanes<T>::store(lanes.value, value.data() + 1), Lanes<T>::store(lanes.rate, rate.data() + 1);
      const Sample<T> before{moved_up(value[0], lanes.value), moved_up(rate[0], lanes.rate)};
      return (smaller(before.value, lanes.value) > T(S(0))) & stays_above(before, lanes, apart);
    }
    void put(std::size_t k, const Sample<S>& sample) { value[k] = sample.value, rate[k] = sample.rate; }
    Sample<S> at(std::size_t k) const { return {value[k], rate[k]}; }
  };
  Numbers angle;
  Samples vis_viva, downhill, uphill;

  void put(std::size_t k, const Look<S>& look) {
    angle[k] = look.angle, vis_viva.put(k, look.vis_viva);
    downhill.put(k, look.guards.downhill), uphill.put(k, look.guards.uphill);
  }
  /// Stores the lanes. Returns between which neighbours neither spin nor friction is used up, a bit for each
  /// two.
  unsigned put_lanes(const T& angles, const Sample<T>& E, const StickGuards<T>& guards) {
    Lanes<T>::store(angles, angle.data() + 1);
    const T apart = angles - moved_up(angle[0], angles);
    return Lanes<T>::bits(vis_viva.put_lanes(E, apart) & downhill.put_lanes(guards.downhill, apart) &
                          uphill.put_lanes(guards.uphill, apart));
  }
  Look<S> at(std::size_t k) const { return {angle[k], vis_viva.at(k), {downhill.at(k), uphill.at(k)}}; }
};

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
    Looks<T> looks;
    looks.put(0, at_begin);
    for (long node = static_cast<long>(std::floor(view.begin().release / step)) + 1;; node += width) {
      const auto first = static_cast<std::size_t>((node % turn + turn) % turn);
      const Trig<T> phi{Lanes<T>::load(sin_.data() + first), Lanes<T>::load(cos_.data() + first),
                        Lanes<T>::load(versine_.data() + first)};
      const T angles = (T(S(node)) + Lanes<T>::load(counted_.data())) * T(step);
      const T E = vis_viva(rolls, angles, phi);
      const unsigned clear = looks.put_lanes(angles, {E, T(S(2)) * torque(rolls.hoop, phi)},
                                             stick_guards(rolls.hoop, phi, E, T(view.mu_static())));
      constexpr unsigned all_clear = (1u << width) - 1u;
      if (clear == all_clear && looks.angle[1] > looks.angle[0] && looks.angle[width] < last) {
        looks.put(0, looks.at(width));
        continue;
      }
      std::size_t left = 0;
      for (std::size_t k = 1; k <= width; ++k) {
        const bool is_last = !(looks.angle[k] < last);
        if (!is_last && looks.angle[k] <= looks.angle[left]) continue;
        const bool is_clear = !is_last && left == k - 1 && (clear >> left & 1u);
        if (!is_clear && ends(looks.at(left), is_last ? view.at(last) : looks.at(k))) return;
        if (is_last) return;
        left = k;
      }
      looks.put(0, looks.at(left));
    }
  }

 private:
  static constexpr std::size_t looks_a_turn = 48;
  /// One turn, and as many nodes more as there may be lanes.
  std::array<S, looks_a_turn + 16> sin_, cos_, versine_;
  std::array<S, Lanes<T>::count> counted_;  // 0, 1, 2, ...
};

}  // namespace leapmap
