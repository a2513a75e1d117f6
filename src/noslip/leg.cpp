// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/leg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap {
namespace {

/// E at the first minimum: from the level, which costs little; where that cancels, from the release.
template <class T>
T least_vis_viva(const Roll<T>& roll, const FirstMinimum<T>& first) {
  using std::abs, std::sqrt;
  const Hoop<T>& h = roll.hoop;
  const T depth = h.rho * h.rho - h.thrust * h.thrust;
  const T least = roll.level + T(2) * (h.thrust * first.angle - sqrt(larger(depth, T(0))));
  const MaskOf<T> near_zero = !(abs(least) > T(1e-9) * (abs(roll.level) + T(1)));
  if (!any(near_zero | (h.thrust < T(0)))) return least;
  return vis_viva_past_release(roll, first.angle - roll.release);
}

/// The same at a multiple of pi, where that multiple's parity is all the trigonometry.
template <class T>
T vis_viva_at_panel(const Roll<T>& roll, const T& panel) {
  using std::floor;
  const T odd = panel - T(2) * floor(panel * T(0.5));
  return vis_viva(roll, panel * T(pi_of<T>), Trig<T>{T(0), T(1) - T(2) * odd, T(2) * odd});
}

}  // namespace

template <class B, class T>
void begin_leg(Block<B>& block, const DesignLanes<T>& index, std::size_t count, const Roll<T>& roll,
               const Roll<T>& release, const LegStart<T>& leg) {
  using S = ScalarOf<T>;
  using std::abs, std::floor;
  const T two_pi(S(2) * pi_of<S>);

  // Energy that is used up ends a leg; it rises or falls from turn to turn, so that one minimum decides.
  const FirstMinimum<T> ahead = first_minimum(release, leg.slope);
  const T least = least_vis_viva(release, ahead);
  const MaskOf<T> runs_down = ahead.is_real & !leg.last & ((least <= T(0)) | (roll.hoop.thrust < T(0)));
  T reach(0), end = leg.end;
  MaskOf<T> turns = !(end == end);
  if (any(runs_down)) {
    reach = turning_distance(release, ahead, runs_down);
    const T turn = release.release + reach;
    // At the runway's end but for rounding it turns, too.
    turns = runs_down & (turn - end <= T(S(8) * std::numeric_limits<S>::epsilon()) * larger(T(1), abs(end)));
    end = select(turns, turn, end);
  }
  // How near E comes to zero on the way, for the clock.
  T lowest = smaller(least, vis_viva_at_panel(roll, RollingTime<T>::first_panel(roll))),
    minimum = ahead.angle;
  if (any(roll.release < release.release)) {
    minimum = first_minimum(roll, leg.slope).angle;
    lowest = smaller(lowest, vis_viva_past_release(roll, minimum - roll.release));
  }
  block.store(roll, Quiet<T>{select(runs_down | leg.last, T(-1), lowest), minimum - roll.release},
              index.data(), count);

  // The scan's first node past the start. One no farther than rounding is the same place, and has its sign.
  const T first_turn = floor(roll.release / two_pi), step = two_pi / T(S(nodes_a_turn));
  const auto angle_of_node = [&](const T& k) { return (first_turn * T(S(nodes_a_turn)) + k) * step; };
  T past = floor((roll.release - two_pi * first_turn) / step) + T(1);
  past = select((past > T(1)) & (angle_of_node(past - T(1)) > roll.release), past - T(1), past);
  const T same_place = T(S(8) * std::numeric_limits<S>::epsilon()) * larger(T(1), abs(roll.release));

  const unsigned on_node = Lanes<T>::bits(angle_of_node(past) - roll.release <= same_place),
                 is_above = Lanes<T>::bits(leg.above), turning = Lanes<T>::bits(turns);
  const auto starts = lanes_of(roll.release), ends = lanes_of(end), first_turns = lanes_of(first_turn),
             past_start = lanes_of(past), reaches = lanes_of(reach);
  for (std::size_t i = 0; i < count; ++i) {
    auto& found = block.found[index[i]];
    found.turns = turning >> i & 1u;
    found.turn = ends[i];
    if (found.leg == 1) found.reach = reaches[i];
    block.searches[index[i]].begin(starts[i], ends[i], first_turns[i],
                                   static_cast<std::uint32_t>(past_start[i]), on_node >> i & 1u,
                                   is_above >> i & 1u, found.returns());
  }
}

template <class T>
void turn_round(Block<T>& block, const DesignList& designs, const Scene& scene) {
  using S = ScalarOf<T>;
  using Found = typename Block<T>::Found;
  for (std::size_t first = 0; first < designs.size(); first += Lanes<T>::count) {
    const std::size_t count = std::min(Lanes<T>::count, designs.size() - first);
    const DesignLanes<T> index = lanes_from<T>(designs, first);
    const auto of_found = [&](auto Found::*member) {
      return gathered<T>([&](std::size_t i) { return block.found[index[i]].*member; });
    };
    const MaskOf<T> third = of_found(&Found::leg) > T(1);  // the next one
    const Roll<T> before = block.template load_path<T>(index.data());
    const T released_at = of_found(&Found::release);

    // At rest where it turned, and at the same level, so that G has the same signs as before.
    const Hoop<T> hoop = seen(before.hoop, T(-1));
    Roll<T> roll = begin_roll(hoop, T(-of_found(&Found::turn)), T(0)),
            release = begin_roll(hoop, T(-released_at), T(0));
    roll.level = release.level = before.level;
    release.released = of_found(&Found::released);
    const T runway_end = T(S(2) * pi_of<S>) * T(S(scene.runway)) + of_found(&Found::travelled) - released_at;
    const LegStart<T> leg{slope_of(hoop), select(third, released_at, runway_end),
                          lift(roll, roll.release).value > T(0), third};
    for (std::size_t i = 0; i < count; ++i) {
      auto& found = block.found[index[i]];
      ++found.leg, found.way = -found.way;
    }
    begin_leg(block, index, count, roll, release, leg);
  }
}

#define LEAPMAP_INSTANTIATE(T)                                                                              \
  template void begin_leg<T>(Block<T>&, const DesignLanes<WideOf<T>>&, std::size_t, const Roll<WideOf<T>>&, \
                             const Roll<WideOf<T>>&, const LegStart<WideOf<T>>&);                           \
  template void turn_round<T>(Block<T>&, const DesignList&, const Scene&);
#ifdef LEAPMAP_KERNELS
LEAPMAP_INSTANTIATE(Batch)
#endif
#ifdef LEAPMAP_SCALARS
LEAPMAP_INSTANTIATE(double)
LEAPMAP_INSTANTIATE(long double)
#endif
#undef LEAPMAP_INSTANTIATE

}  // namespace leapmap
