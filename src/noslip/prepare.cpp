// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/prepare.hpp"

#include <algorithm>
#include <cmath>

#include "noslip/leg.hpp"

namespace leapmap {

template <class B>
void prepare(std::span<const Design> designs, std::span<const ContactState<ScalarOf<B>>> landed,
             const Scene& scene, Block<B>& block, std::span<Outcome> outcomes) {
  using S = ScalarOf<B>;
  using T = WideOf<B>;
  using std::abs, std::atan2;
  block.make_room(designs.size());
  block.searching.clear(), block.bouncing.clear();
  for (Outcome& outcome : outcomes) outcome = Outcome{};
  for (std::size_t first = 0; first < designs.size(); first += Lanes<T>::count) {
    const std::size_t count = std::min(Lanes<T>::count, designs.size() - first);
    DesignLanes<T> index;
    for (std::size_t i = 0; i < index.size(); ++i)
      index[i] = static_cast<std::uint32_t>(first + (i < count ? i : 0));
    const GatheredDesigns<T> batch =
        gathered_designs<T>([&](std::size_t i) -> const Design& { return designs[index[i]]; });
    const Hoop<T>& hoop = batch.hoop;
    const auto of_landing = [&](S ContactState<S>::*member) {
      return gathered<T>([&](std::size_t i) { return landed[index[i]].*member; });
    };
    // Of where it sets out: of the landing, or of the release.
    const T spin = landed.empty() ? batch.release_spin : of_landing(&ContactState<S>::spin);
    // A release many turns from 0 is taken back to the first, so that angles have digits to spare.
    const T release_angle = landed.empty() ? batch.release_angle : of_landing(&ContactState<S>::angle);
    T nearest = release_angle;
    if (const MaskOf<T> far = abs(release_angle) > T(S(4) * pi_of<S>); any(far)) {
      const Trig<T> direction = trig(release_angle);
      nearest = select(far, atan2(direction.sin, direction.cos), release_angle);
    }
    const Trig<T> phi = trig(nearest);
    const T force = normal_force(hoop, phi, spin, angular_acceleration(hoop, phi, spin)),
            sets_out = setting_out(hoop, release_angle, phi, spin);
    const T way = select(sets_out < T(0), T(-1), T(1));
    const Roll<T> roll = begin_roll(seen(hoop, way), way * nearest, seen(phi, way), way * spin);

    const unsigned in_the_air = Lanes<T>::bits(!(force > T(0))), at_rest = Lanes<T>::bits(sets_out == T(0));
    const auto releases = lanes_of(roll.release), released = lanes_of(roll.released), ways = lanes_of(way),
               turns_back = lanes_of(release_angle - nearest);
    const T travelled = landed.empty() ? T(0) : way * of_landing(&ContactState<S>::travel);
    const auto travels = lanes_of(travelled);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t design = index[i];
      block.found[design] = {.turned_back = turns_back[i],
                             .release = releases[i],
                             .released = released[i],
                             .way = ways[i],
                             .travelled = travels[i]};
      if (in_the_air >> i & 1u) {
        if (landed.empty())
          outcomes[design].status = Status::airborne_at_release;
        else
          block.bouncing.push_back(design);
      } else if (at_rest >> i & 1u) {
        outcomes[design].status = Status::stalled;
      } else {
        block.searching.push_back(design);
      }
    }
    const T end = roll.release + T(S(2) * pi_of<S>) * T(S(scene.runway)) - travelled;
    begin_leg(block, index, count, roll, roll,
              LegStart<T>{way * batch.slope, end, force > T(0), !(end == end)});
  }
}

#define LEAPMAP_INSTANTIATE(T)                                                                  \
  template void prepare<T>(std::span<const Design>, std::span<const ContactState<ScalarOf<T>>>, \
                           const Scene&, Block<T>&, std::span<Outcome>);
#ifdef LEAPMAP_KERNELS
LEAPMAP_INSTANTIATE(Batch)
#endif
#ifdef LEAPMAP_SCALARS
LEAPMAP_INSTANTIATE(double)
LEAPMAP_INSTANTIATE(long double)
#endif
#undef LEAPMAP_INSTANTIATE

}  // namespace leapmap
