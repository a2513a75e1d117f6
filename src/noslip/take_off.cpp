// SPDX-License-Identifier: GPL-3.0-or-later
#include "noslip/take_off.hpp"

#include <cmath>
#include <limits>

#include "hoop/flight_search.hpp"
#include "hoop/jump_rule.hpp"
#include "hoop/landing.hpp"
#include "noslip/find.hpp"
#include "trajectory/jump_measures.hpp"

namespace leapmap {

template <class T>
void TakeOff<T>::run(Block<T>& block, const Scene& scene, std::span<Outcome> outcomes, DesignList& going_on) {
  using std::abs, std::sqrt;
  using S = ScalarOf<T>;
  using W = WideOf<T>;
  const W epsilon(std::numeric_limits<S>::epsilon());
  for (std::size_t first = 0; first < falls.size(); first += Lanes<W>::count) {
    const std::size_t count = std::min(Lanes<W>::count, falls.size() - first);
    const IntervalLanes<W> lanes = lanes_from<W>(falls, first);
    const W &a = lanes.from, &b = lanes.to;
    const W guess = lanes_from<W>(falls, first, [](const SureFall<S>& fall) { return fall.guess; });
    const Roll<W> roll = block.template load_path<W>(lanes.index.data());
    const MaskOf<W> all_lanes = a == a;
    const W angle = polish_root([&](const W& x) { return lift(roll, x); }, a, b, guess, !all_lanes,
                                W(2) * epsilon * larger(W(1), abs(b)), all_lanes);
    const Trig<W> phi = trig(angle);
    // Beside a turn E may round to nothing.
    const W spin = sqrt(larger(vis_viva(roll, angle, phi), W(1e-290)) / contact_inertia(roll.hoop, phi));
    fly(block, lanes.index, count, roll, angle, phi, spin, scene, outcomes, [&](std::uint32_t design) {
      block.searches[design].advance();
      going_on.push_back(design);
    });
  }
}

template <class T>
void TakeOff<T>::bounce(Block<T>& block, const Scene& scene, std::span<Outcome> outcomes,
                        DesignList& going_on) {
  using std::sqrt;
  using W = WideOf<T>;
  if (told && !block.bouncing.empty()) told->bounces = true;
  for (std::size_t first = 0; first < block.bouncing.size(); first += Lanes<W>::count) {
    const std::size_t count = std::min(Lanes<W>::count, block.bouncing.size() - first);
    const DesignLanes<W> index = lanes_from<W>(block.bouncing, first);
    const Roll<W> roll = block.template load_roll<W>(index.data());
    const W spin = sqrt(roll.released / contact_inertia(roll.hoop, roll.release_trig));
    fly(block, index, count, roll, roll.release, roll.release_trig, spin, scene, outcomes,
        [&](std::uint32_t design) { going_on.push_back(design); });
  }
}

template <class T>
template <class Low>
void TakeOff<T>::fly(Block<T>& block, const DesignLanes<WideOf<T>>& index, std::size_t count,
                     const Roll<WideOf<T>>& roll, const WideOf<T>& angle, const Trig<WideOf<T>>& phi,
                     const WideOf<T>& spin, const Scene& scene, std::span<Outcome> outcomes, const Low& low) {
  using S = ScalarOf<T>;
  using W = WideOf<T>;
  const Ascent<W> ascent = ascend(toss_of(roll.hoop, angle, phi, spin), angle == angle);
  W height = W(0.5) * roll.hoop.rho * ascent.height, apex_time = ascent.apex / spin;
  if (const Hoop<W> hoop = in_flight(roll.hoop, scene); any(hoop.aloft != W(0))) {
    const MaskOf<W> driven = hoop.aloft != W(0);
    const Flight<W> flight = fly_driven(hoop, angle, spin, W(0), driven).flight;
    height = select(driven, flight.height, height);
    apex_time = select(driven, flight.apex_time, apex_time);
  }
  const auto angles = lanes_of(angle), spins = lanes_of(spin), heights = lanes_of(height),
             apexes = lanes_of(apex_time);
  if (keeps_flights) block.store(TakenOff<W>{angle, spin, ascent}, index.data(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t design = index[i];
    auto& found = block.found[design];
    Outcome& outcome = outcomes[design];
    if (!std::isfinite(angles[i]) || !std::isfinite(spins[i]) || !std::isfinite(heights[i])) {
      outcome = failed_outcome("a lift-off could not be solved");
      continue;
    }
    // Between two falls so near each other the normal force rises by less than rounding: they are one.
    constexpr S one_fall = S(1e-6);
    const bool again = outcome.candidates > 0 && !std::isnan(found.jump_angle) &&
                       angles[i] - found.jump_angle < one_fall * std::max(S(1), std::abs(angles[i]));
    if (!again) {
      if (outcome.candidates == 0) found.first_angle = angles[i];
      found.jump_angle = angles[i];
      const LiftOff<double> lift_off{Outcome::none,
                                     static_cast<double>(found.way * angles[i] + found.turned_back),
                                     static_cast<double>(found.way * spins[i])};
      if (told) {
        told->lift_offs.push_back(lift_off);
        told->legs.push_back(static_cast<std::size_t>(found.leg - 1));
      }
      const Flight<double> flight{static_cast<double>(heights[i]), static_cast<double>(apexes[i]),
                                  Outcome::none, Outcome::none};
      const S origin = found.release - found.travelled;  // as seen on the first leg
      const auto distance =
          static_cast<double>(found.way * (found.leg == 2 ? angles[i] + origin : angles[i] - origin));
      if (consider(outcome, scene, lift_off, flight, distance)) continue;
    }
    low(design);
  }
}

template <class T>
void land(const Block<T>& block, const DesignList& jumped, const Scene& scene, std::span<Outcome> outcomes,
          std::span<ContactState<ScalarOf<T>>> states, bool measures) {
  using W = WideOf<T>;
  for (std::size_t first = 0; first < jumped.size(); first += Lanes<W>::count) {
    const std::size_t count = std::min(Lanes<W>::count, jumped.size() - first);
    const DesignLanes<W> index = lanes_from<W>(jumped, first);
    Roll<W> roll = block.template load_path<W>(index.data());
    roll.hoop = in_flight(roll.hoop, scene);
    const TakenOff<W> off = block.template load_lift_off<W>(index.data());
    const Trig<W> phi = trig(off.angle);
    const Toss<W> toss = toss_of(roll.hoop, off.angle, phi, off.spin);
    Flight<W> flight = scaled(descend(toss, off.ascent, off.spin == off.spin), roll.hoop, off.spin);
    if (const MaskOf<W> driven = roll.hoop.aloft != W(0); any(driven))
      flight = of_either(driven, fly_driven(roll.hoop, off.angle, off.spin, W(0), driven).flight, flight);
    const auto landings = lanes_of(flight.flight_time), dips = lanes_of(flight.dip);
    for (std::size_t i = 0; i < count; ++i) {
      outcomes[index[i]].flight_time = static_cast<double>(landings[i]);
      outcomes[index[i]].dip = static_cast<double>(dips[i]);
    }
    if (states.empty() && !measures) continue;
    const ContactState<W> end =
        after_flight(roll.hoop, ContactState<W>{.angle = off.angle, .spin = off.spin}, flight.flight_time);
    const Landing<W> landing =
        hold(roll.hoop, trig(end.angle), ContactVelocity<W>{end.slip, end.normal, end.spin});
    if (measures) {
      const W way = gathered<W>([&](std::size_t i) { return block.found[index[i]].way; });
      put_measures(measures_of(roll.hoop, end.travel, end, landing), way,
                   [&](double Outcome::*kept, const W& value) {
                     const auto numbers = lanes_of(value);
                     for (std::size_t i = 0; i < count; ++i)
                       outcomes[index[i]].*kept = static_cast<double>(numbers[i]);
                   });
    }
    if (states.empty()) continue;
    const auto lift_offs = lanes_of(off.angle), angles = lanes_of(end.angle), travels = lanes_of(end.travel),
               spins = lanes_of(landing.after.spin), turned = lanes_of(end.turned_in_flight);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& found = block.found[index[i]];
      auto& state = states[index[i]];
      state.travel += (found.way * lift_offs[i] + found.turned_back - state.angle) + found.way * travels[i];
      state.angle = found.way * angles[i] + found.turned_back;
      state.spin = found.way * spins[i];
      state.turned_in_flight += found.way * turned[i];
      state.time += landings[i] + (outcomes[index[i]].candidates == 1 ? found.first_time : found.jump_time);
    }
  }
}

#ifdef LEAPMAP_KERNELS
template struct TakeOff<Batch>;
template void land(const Block<Batch>&, const DesignList&, const Scene&, std::span<Outcome>,
                   std::span<ContactState<double>>, bool);
#endif
#ifdef LEAPMAP_SCALARS
template struct TakeOff<double>;
template struct TakeOff<long double>;
template void land(const Block<double>&, const DesignList&, const Scene&, std::span<Outcome>,
                   std::span<ContactState<double>>, bool);
template void land(const Block<long double>&, const DesignList&, const Scene&, std::span<Outcome>,
                   std::span<ContactState<long double>>, bool);
#endif

}  // namespace leapmap
