// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/rolling_leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "numerics/first_fall.hpp"

namespace leapmap {
template <class S>
RollingLeg<S>::RollingLeg(double tolerance)
    : tolerance_(std::max(S(tolerance) * S(0.1), S(1000) * std::numeric_limits<S>::epsilon())) {
  for (std::size_t k = 0; k < grid_.sin.size(); ++k) {
    const Trig<S> phi = trig(S(2) * std::numbers::pi_v<S> * S(k % nodes_a_turn) / S(nodes_a_turn));
    grid_.sin[k] = phi.sin, grid_.cos[k] = phi.cos, grid_.versine[k] = phi.versine;
  }
}

template <class S>
PhaseEnd RollingLeg<S>::run(const Hoop<S>& hoop, const S& mu_static, ContactState<S>& at,
                            const S& runway) const {
  const Roll<S> roll = begin_roll(hoop, at.angle, at.spin);
  const S start = at.angle, last = at.angle + (runway - at.travel);
  const S step = S(2) * std::numbers::pi_v<S> / S(nodes_a_turn);

  struct Look {
    S angle;
    Sample<S> vis_viva;
    StickGuards<S> guards;
  };
  const auto guards_at = [&](const S& angle) {
    const Trig<S> phi = trig(angle);
    return stick_guards(hoop, phi, vis_viva(roll, angle, phi), mu_static);
  };
  const auto look_at = [&](const S& angle) {
    const Trig<S> phi = trig(angle);
    const S E = vis_viva(roll, angle, phi);
    return Look{angle, {E, S(2) * torque(hoop, phi)}, stick_guards(hoop, phi, E, mu_static)};
  };
  const auto end_at = [&](const S& angle, PhaseEnd end) {
    const S x = angle - start;
    at.travel += x;
    at.angle = angle;
    at.spin = S(0);
    if (end == PhaseEnd::stalls) return end;  // when nobody asks, and the integral is hard
    const S taken = x > S(0) ? duration(roll, x) : S(0);
    at.time += taken;
    at.spin = std::sqrt(std::max(vis_viva_past_release(roll, x), S(0)) / contact_inertia(hoop, trig(angle)));
    return taken >= S(0) ? end : PhaseEnd::failed;
  };

  // From rest E's first zero is the release itself, known by its push.
  if (at.spin < S(0) || (at.spin == S(0) && !(roll.push > S(0)))) return PhaseEnd::stalls;
  Look left = look_at(start);
  left.vis_viva = {roll.released, S(2) * roll.push};

  // The grid in lanes, so many nodes at once; the end of the runway comes as a node of its own.
  using T = typename SpectralPanel<S, nodes>::T;
  constexpr std::size_t width = Lanes<T>::count;
  const Roll<T> rolls = widened<T>(roll);
  for (long node = static_cast<long>(std::floor(start / step)) + 1;; node += long{width}) {
    const auto first =
        static_cast<std::size_t>(((node % long{nodes_a_turn}) + long{nodes_a_turn}) % long{nodes_a_turn});
    const Trig<T> phi{Lanes<T>::load(grid_.sin.data() + first), Lanes<T>::load(grid_.cos.data() + first),
                      Lanes<T>::load(grid_.versine.data() + first)};
    LaneArray<T> angles;
    for (std::size_t k = 0; k < width; ++k) angles[k] = S(node + static_cast<long>(k)) * step;
    const T E = vis_viva(rolls, Lanes<T>::load(angles.data()), phi);
    const StickGuards<T> guards = stick_guards(rolls.hoop, phi, E, T(mu_static));
    const auto Es = lanes_of(E), pushes = lanes_of(torque(rolls.hoop, phi)),
               back = lanes_of(guards.downhill.value), back_rate = lanes_of(guards.downhill.rate),
               forth = lanes_of(guards.uphill.value), forth_rate = lanes_of(guards.uphill.rate);
    for (std::size_t k = 0; k < width; ++k) {
      const bool ends = !(angles[k] < last);
      if (!ends && angles[k] <= left.angle) continue;
      const Look right = ends ? look_at(last)
                              : Look{angles[k],
                                     {Es[k], S(2) * pushes[k]},
                                     {{back[k], back_rate[k]}, {forth[k], forth_rate[k]}}};
      const S backwards = first_fall([&](const S& x) { return guards_at(x).downhill; }, left.angle,
                                     right.angle, left.guards.downhill, right.guards.downhill);
      const S forwards = first_fall([&](const S& x) { return guards_at(x).uphill; }, left.angle, right.angle,
                                    left.guards.uphill, right.guards.uphill);
      const S stall = first_fall(
          [&](const S& x) {
            return Sample<S>{vis_viva_past_release(roll, S(x - start)), S(2) * torque(hoop, trig(x))};
          },
          left.angle, right.angle, left.vis_viva, right.vis_viva);
      // Whichever comes first; NaN never does.
      if (!std::isnan(stall) && !(backwards <= stall) && !(forwards <= stall))
        return end_at(stall, PhaseEnd::stalls);
      if (!std::isnan(backwards) && !(forwards < backwards))
        return end_at(backwards, PhaseEnd::slips_backwards);
      if (!std::isnan(forwards)) return end_at(forwards, PhaseEnd::slips_forwards);
      if (ends) return end_at(last, PhaseEnd::runway_ends);
      left = right;
    }
  }
}

template <class S>
S RollingLeg<S>::duration(const Roll<S>& roll, const S& length) const {
  // x = shift + q^2 takes out E's zero before the start, where the spin is small and grows. Newton's method
  // from the start comes to it from above where E is convex; where it does not, any shift will do.
  S shift = roll.push > S(0) ? -roll.released / (S(2) * roll.push) : -length;
  for (int k = 0; k < 4 && shift > -length && shift < S(0); ++k) {
    const S push = torque(roll.hoop, trig(S(roll.release + shift)));
    if (!(push > S(0))) break;
    shift -= vis_viva_past_release(roll, shift) / (S(2) * push);
  }
  shift = std::clamp(shift, -length, S(0));
  const S begin = std::sqrt(-shift);
  S sum(0), from = begin;
  const S end = std::sqrt(length - shift);
  int panels = 0;
  // Panels of some two thirds of a radian.
  while (from < end) {
    S to = std::sqrt(from * from + S(0.7));
    if (to > end || S(1.15) * to > end) to = end;
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
  using std::sin, std::sqrt;
  const Roll<T> rolls = widened<T>(roll);
  typename SpectralPanel<S, nodes>::Values f;
  T least_E(std::numeric_limits<S>::max());
  for (std::size_t i = 0; i < nodes; i += Lanes<T>::count) {
    const T q = T(from) + T(to - from) * Lanes<T>::load(panel_.node.data() + i), x = T(shift) + q * q;
    const Trig<T> turned = trig(x);
    const T E = vis_viva_past_release(rolls, x, turned, x_minus_sin(x, turned.sin));
    // 1 - cos(release + x) by the half angle, accurate near multiples of 2 pi
    const T half = sin((rolls.release + x) * T(0.5)),
            J = rolls.hoop.J_min + T(4) * rolls.hoop.rho * half * half;
    Lanes<T>::store(T(2) * q * sqrt(J / E), f.data() + i);
    least_E = smaller(least_E, E);
  }
  const S whole = (to - from) * panel_.integral(f), tail = (to - from) * panel_.tail(f);
  // The tail itself, and not its square, which the error goes as where f is smooth: a narrow needle of little
  // weight between the nodes shows in the tail alone.
  // Beside a stall E is a difference of near equals: what its roundings make of the time no panel resolves.
  const auto least = lanes_of(least_E);
  const S rounding = S(16) * std::numeric_limits<S>::epsilon() *
                     (S(4) + roll.released + S(2) * to * to * roll.hoop.sin_slope) /
                     *std::min_element(least.begin(), least.end());
  if (tail <= std::max(std::max(tolerance_, std::min(rounding, S(1e-4))) * whole, enough)) return whole;
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
