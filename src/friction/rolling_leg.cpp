// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/rolling_leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "friction/roll_timing.hpp"

namespace leapmap {
template <class S>
RollingLeg<S>::RollingLeg(double tolerance) : tolerance_(panel_tolerance<S>(tolerance)) {}

template <class S>
PhaseEnd RollingLeg<S>::run(const Hoop<S>& hoop, const S& mu_static, ContactState<S>& at, const S& runway,
                            const Told& turns) const {
  const ContactState<S> from = at;
  const S sets_out = setting_out(hoop, at.angle, trig(at.angle), at.spin);
  if (sets_out == S(0)) return PhaseEnd::stalls;
  S way = sets_out < S(0) ? S(-1) : S(1);
  for (int turned = 0;; way = -way) {
    const Hoop<S> seen_hoop = seen(hoop, way);
    const Roll<S> begin = begin_roll(seen_hoop, S(way * at.angle), std::abs(at.spin));
    const Roll<S> roll = begin_roll(seen_hoop, S(way * from.angle), std::abs(from.spin));
    auto [end, angle] = first_end(roll, begin, mu_static, begin.release + (runway - way * at.travel));
    // From rest the second turn is at the beginning.
    const bool back = turned == 1 && from.spin == S(0) && angle >= roll.release;
    if (back) end = PhaseEnd::stalls, angle = roll.release;
    S x = angle - begin.release, taken(0);
    if (end == PhaseEnd::stalls) {
      if (!back) x = refined_turn(begin, x, S(0), S(x + S(1)));
      angle = begin.release + x;
      // Within a rounding of the angle the motion is uniformly slowed, and panels have nothing to resolve.
      if (turned == 0 && x > S(0))
        taken = angle == begin.release
                    ? contact_inertia(seen_hoop, begin.release_trig) * std::abs(at.spin / begin.push)
                    : duration_to_rest(begin, x);
    } else if (x > S(0)) {
      taken = duration(begin, x);
      if (std::isnan(taken)) taken = duration_near_rest(begin, x);
    }
    at.travel += way * x;
    at.angle = way * angle;
    at.time += taken;
    if (end != PhaseEnd::stalls) {
      at.spin = way * std::sqrt(std::max(vis_viva_past_release(roll, S(angle - roll.release)), S(0)) /
                                contact_inertia(hoop, trig(angle)));
      return !(taken >= S(0)) ? PhaseEnd::failed : way < S(0) ? turned_over(end) : end;
    }
    at.spin = S(0);
    if (hoop.resistance != S(0)) return taken >= S(0) ? end : PhaseEnd::failed;
    if (++turned == 2) return end;  // when nobody asks, and the integral may be hard
    if (!(taken >= S(0))) return PhaseEnd::failed;
    if (turns) turns(at);
  }
}

template <class S>
LegEnd<S> RollingLeg<S>::first_end(const Roll<S>& roll, const Roll<S>& begin, const S& mu_static,
                                   const S& last) const {
  const LegView<S> view(roll, begin, mu_static);
  LegEnd<S> end{PhaseEnd::runway_ends, last};
  walk_.run(view, view.at_begin(), last, [&](const Look<S>& left, const Look<S>& right) {
    const LegEnd<S> found = view.first_end(left, right);
    if (std::isnan(found.angle)) return false;
    end = found;
    return true;
  });
  return end;
}

/// Both halves from the ends, as E vanishes at the far one too.
template <class S>
S RollingLeg<S>::duration_to_rest(const Roll<S>& roll, const S& length) const {
  const Roll<S> back = begin_roll(seen(roll.hoop, S(-1)), S(-(roll.release + length)), S(0));
  return duration(roll, S(length * S(0.5))) + duration(back, S(length * S(0.5)));
}

/// The same to an angle just before the hoop would turn round, where E nearly vanishes. NaN: it would not.
template <class S>
S RollingLeg<S>::duration_near_rest(const Roll<S>& roll, const S& length) const {
  const FirstMinimum<S> ahead = first_minimum(roll, slope_of(roll.hoop));
  const S least = vis_viva_past_release(roll, S(ahead.angle - roll.release));
  if (!ahead.is_real || least > S(0)) return std::numeric_limits<S>::quiet_NaN();
  const S whole = std::max(turning_distance(roll, ahead, true), length);
  const Roll<S> back = begin_roll(seen(roll.hoop, S(-1)), S(-(roll.release + whole)), S(0));
  const S rest = whole - length;
  return duration_to_rest(roll, whole) - (rest > S(0) ? duration(back, rest) : S(0));
}

template <class S>
S RollingLeg<S>::duration(const Roll<S>& roll, const S& length) const {
  const S shift = zero_before_release(roll, length), begin = std::sqrt(-shift);
  S sum(0), from = begin;
  const S end = std::sqrt(length - shift);
  int panels = 0;
  // Panels of 1.4 radians, the last of up to 1.8.
  while (from < end) {
    S to = std::sqrt(from * from + S(1.4));
    if (to * to + S(0.4) > end * end) to = end;
    sum += duration(roll, shift, from, to, S(0), 0, panels);
    from = to;
  }
  return sum;
}

template <class S>
S RollingLeg<S>::duration(const Roll<S>& roll, const S& shift, const S& from, const S& to, const S& enough,
                          int halvings, int& panels) const {
  constexpr int most_halvings = 50, most_panels = 10'000;
  // The nodes in lanes.
  using T = typename SpectralPanel<S, nodes>::T;
  const Roll<T> rolls = widened<T>(roll);
  typename SpectralPanel<S, nodes>::Values f;
  T least_E(std::numeric_limits<S>::max());
  for (std::size_t i = 0; i < nodes; i += Lanes<T>::count) {
    const T q = T(from) + T(to - from) * Lanes<T>::load(panel_.node.data() + i), x = T(shift) + q * q;
    const Trig<T> turned = trig(x);
    const T E = vis_viva_past_release(rolls, x, turned, x_minus_sin(x, turned));
    const T J = contact_inertia(rolls.hoop, trig(T(rolls.release + x)));
    Lanes<T>::store(T(2) * q * slowness(J, E), f.data() + i);
    least_E = smaller(least_E, E);
  }
  const S whole = (to - from) * panel_.integral(f), tail = (to - from) * panel_.tail(f);
  // The tail itself, and not its square, which the error goes as where f is smooth: a narrow needle of little
  // weight between the nodes shows in the tail alone.
  const auto least = lanes_of(least_E);
  const S rounding = time_rounding(roll.released, S(std::abs(roll.hoop.thrust)), to,
                                   *std::min_element(least.begin(), least.end()));
  if (tail <= std::max(std::max(tolerance_, rounding) * whole, enough)) return whole;
  if (halvings == most_halvings || ++panels > most_panels || !(whole > S(0)))
    return std::numeric_limits<S>::quiet_NaN();
  // Parts need be no better than a tenth of that of the whole, so that roundings are not halved for ever.
  const S allowed = halvings == 0 ? S(0.1) * tolerance_ * whole : enough,
          middle = from + (to - from) * S(0.5);
  const S first = duration(roll, shift, from, middle, allowed, halvings + 1, panels);
  return std::isnan(first) ? first : first + duration(roll, shift, middle, to, allowed, halvings + 1, panels);
}

#ifdef LEAPMAP_KERNELS
template class RollingLeg<double>;
#endif
#ifdef LEAPMAP_SCALARS
template class RollingLeg<long double>;
#endif

}  // namespace leapmap
