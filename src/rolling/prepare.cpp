// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/prepare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap {

template <class T>
void prepare(std::span<const Design> designs, const Scene& scene, Block<T>& block,
             std::span<Outcome> outcomes) {
  using S = ScalarOf<T>;
  using std::abs, std::atan2, std::floor;
  const T pi(pi_of<S>), two_pi = T(2) * pi;
  block.searching.clear();
  for (std::size_t first = 0; first < designs.size(); first += Lanes<T>::count) {
    const std::size_t count = std::min(Lanes<T>::count, designs.size() - first);
    DesignLanes<T> index;
    for (std::size_t i = 0; i < index.size(); ++i)
      index[i] = static_cast<std::uint32_t>(first + (i < count ? i : 0));
    const auto parameter = [&](double Design::*member) {
      LaneArray<T> lanes;
      for (std::size_t i = 0; i < lanes.size(); ++i) lanes[i] = S(designs[index[i]].*member);
      return Lanes<T>::load(lanes.data());
    };
    const Hoop<T> hoop = derive(parameter(&Design::slope), parameter(&Design::mass_ratio),
                                parameter(&Design::offset_ratio), parameter(&Design::inertia_factor));
    const T spin = parameter(&Design::release_spin);
    // A release many turns from 0 is taken back to the first, so that angles have digits to spare.
    const T release_angle = parameter(&Design::release_angle);
    T nearest = release_angle;
    if (const MaskOf<T> far = abs(release_angle) > T(S(4) * pi_of<S>); any(far)) {
      const Trig<T> direction = trig(release_angle);
      nearest = select(far, atan2(direction.sin, direction.cos), release_angle);
    }
    const Roll<T> roll = begin_roll(hoop, nearest, spin);

    const T force =
        normal_force(hoop, roll.release_trig, spin, angular_acceleration(hoop, roll.release_trig, spin));
    const MaskOf<T> airborne = !(force > T(0));
    const MaskOf<T> uphill = (spin < T(0)) | ((spin == T(0)) & !(roll.push > T(0)));
    const auto [minimum, crest, is_real] = first_minimum(roll);
    const T least = vis_viva_past_release(roll, minimum - roll.release);
    const T at_edge = vis_viva_past_release(roll, RollingTime<T>::first_panel(roll) * pi - roll.release);
    block.store(roll, Quiet<T>{smaller(least, at_edge), minimum - roll.release}, index.data(), count);

    // The scan's first node past the release. One no farther than rounding is the same place, and has its
    // sign.
    const T release_turn = floor(roll.release / two_pi), step = two_pi / T(S(nodes_a_turn));
    const auto angle_of_node = [&](const T& k) { return (release_turn * T(S(nodes_a_turn)) + k) * step; };
    T past = floor((roll.release - two_pi * release_turn) / step) + T(1);
    past = select((past > T(1)) & (angle_of_node(past - T(1)) > roll.release), past - T(1), past);
    const T same_place = T(S(8) * std::numeric_limits<S>::epsilon()) * larger(T(1), abs(roll.release));

    const unsigned on_node = Lanes<T>::bits(angle_of_node(past) - roll.release <= same_place),
                   in_the_air = Lanes<T>::bits(airborne), not_off = Lanes<T>::bits(uphill),
                   stalling = Lanes<T>::bits(is_real & !(least > T(0)));
    const auto release = lanes_of(roll.release), end = lanes_of(roll.release + two_pi * T(S(scene.runway))),
               first_turn = lanes_of(release_turn), past_release = lanes_of(past),
               turns_back = lanes_of(release_angle - nearest), minima = lanes_of(minimum),
               crests = lanes_of(crest);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t design = index[i];
      outcomes[design] = Outcome{};
      if (in_the_air >> i & 1u) {
        outcomes[design].status = Status::airborne_at_release;
      } else if (not_off >> i & 1u) {
        outcomes[design].status = Status::stalled;
      } else {
        IntervalSearch<S>& search = block.searches[design];
        search.begin(release[i], end[i], first_turn[i], static_cast<std::uint32_t>(past_release[i]),
                     on_node >> i & 1u);
        block.found[design] = {
            .turned_back = turns_back[i], .stalls = false, .first_angle = 0, .jump_angle = 0};
        block.searching.push_back(design);
        if (stalling >> i & 1u) {
          const S stall = stall_angle(block.template load_roll<S>(&design), minima[i], crests[i]);
          if (stall < search.end) search.end = stall, block.found[design].stalls = true;
        }
      }
    }
  }
}

#define LEAPMAP_INSTANTIATE(T) \
  template void prepare<T>(std::span<const Design>, const Scene&, Block<T>&, std::span<Outcome>);
#ifdef LEAPMAP_KERNELS
LEAPMAP_INSTANTIATE(Batch)
#endif
#ifdef LEAPMAP_SCALARS
LEAPMAP_INSTANTIATE(double)
LEAPMAP_INSTANTIATE(long double)
#endif
#undef LEAPMAP_INSTANTIATE

}  // namespace leapmap
