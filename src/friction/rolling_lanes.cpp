// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/rolling_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <type_traits>

namespace leapmap {

template <class T>
RollingLanes<T>::RollingLanes(double tolerance, std::size_t most, bool timed)
    : with_times_(timed), leg_(tolerance), timed_rolls_(tolerance, most), phases_(most), untimed_(most) {}

template <class T>
void RollingLanes<T>::begin(std::uint32_t place, const Hoop<S>& hoop, const S& mu_static,
                            const ContactState<S>& at, const S& runway) {
  phases_[place] = {hoop, mu_static, at, runway};
  waiting_.push_back(place);
}

template <class T>
void RollingLanes<T>::pass(std::vector<EndedPhase<S>>& ended) {
  if (timed_rolls_.waiting() >= width || waiting_.empty())
    time_some(ended);
  else
    find_ends(ended);
}

template <class T>
void RollingLanes<T>::find_ends(std::vector<EndedPhase<S>>& ended) {
  const Begun begun = take();
  std::array<Bracket, width> brackets;
  for (std::uint32_t i = 0; i < width; ++i) brackets[i] = i < begun.count ? bracket(i) : brackets[0];
  polish_ends(begun, brackets, ended);
}

template <class T>
void RollingLanes<T>::alone(std::uint32_t place, std::vector<EndedPhase<S>>& ended) const {
  const Phase& phase = phases_[place];
  ContactState<S> at = phase.at;
  const PhaseEnd end = leg_.run(phase.hoop, phase.mu_static, at, phase.runway);
  ended.push_back({place, end, at});
}

template <class T>
auto RollingLanes<T>::take() -> Begun {
  static_assert(std::is_standard_layout_v<Phase> && offsetof(Hoop<S>, thrust) == 7 * sizeof(S) &&
                offsetof(Hoop<S>, aloft) == 9 * sizeof(S) && offsetof(Phase, mu_static) == 10 * sizeof(S) &&
                offsetof(ContactState<S>, travel) == sizeof(S) &&
                offsetof(ContactState<S>, spin) == 3 * sizeof(S) &&
                offsetof(ContactState<S>, slip) == 4 * sizeof(S));
  using std::abs;
  Begun begun;
  begun.count = std::min(width, waiting_.size());
  const std::size_t first = waiting_.size() - begun.count;
  for (std::size_t i = 0; i < width; ++i) begun.place[i] = waiting_[first + (i < begun.count ? i : 0)];
  waiting_.resize(first);
  const auto numbers_from = [&](std::size_t number) {
    return columns_of<T>([&](std::size_t i) { return &phases_[begun.place[i]].hoop.sin_slope + number; });
  };
  const auto [sin_slope, cos_slope, rho, clearance, Ic, J_min, drive, thrust] = numbers_from(0);
  const auto [resistance, aloft, mu_static, time, travel, angle, spin, slip] = numbers_from(8);
  const T runway = gathered<T>([&](std::size_t i) { return phases_[begun.place[i]].runway; });
  const T zero(S(0)), one(S(1));
  const Hoop<T> hoop{sin_slope, cos_slope, rho, clearance, Ic, J_min, drive, thrust, resistance};
  const Trig<T> phi = trig(angle);
  const T sets_out = setting_out(hoop, angle, phi, spin);
  const T way = select(sets_out < zero, -one, one);
  const Roll<T> roll = begin_roll(seen(hoop, way), T(way * angle), seen(phi, way), T(abs(spin)));
  const auto [at, vis_viva, guards] = LegView<T>(roll, roll, mu_static).at_begin();
  // Where nothing sets it going its runway ends at once.
  const T last = select(sets_out == zero, roll.release, roll.release + (runway - way * travel));
  std::array<std::uint32_t, width> lanes;
  std::iota(lanes.begin(), lanes.end(), 0u);
  hoops_.template store<T>(numbers_of(roll.hoop), lanes.data(), width);
  rolls_.template store<T>({roll.release, roll.release_trig.sin, roll.release_trig.cos,
                            roll.release_trig.versine, roll.released, roll.level, roll.push},
                           lanes.data(), width);
  looks_.template store<T>({vis_viva.value, vis_viva.rate, guards.downhill.value, guards.downhill.rate,
                            guards.uphill.value, guards.uphill.rate, mu_static, last},
                           lanes.data(), width);
  begun.way = way, begun.mu_static = mu_static, begun.travel = travel, begun.roll = roll;
  return begun;
}

/// Where one guard alone falls through zero between two looks, or none up to the runway's end.
template <class T>
auto RollingLanes<T>::bracket(std::uint32_t lane) const -> Bracket {
  const auto [release, sine, cosine, versine, released, level, push] = rolls_.template load<S>(&lane);
  const auto [E, E_rate, downhill, downhill_rate, uphill, uphill_rate, mu_static, last] =
      looks_.template load<S>(&lane);
  const Roll<S> roll{
      hoop_of(hoops_.template load<S>(&lane)), release, {sine, cosine, versine}, released, level, push};
  const Look<S> at_begin{release, {E, E_rate}, {{downhill, downhill_rate}, {uphill, uphill_rate}}};
  Bracket found{PhaseEnd::runway_ends, last, last, S(1), S(-1)};
  bool is_plain = true;
  walk_.run({roll, roll, mu_static}, at_begin, last, [&](const Look<S>& left, const Look<S>& right) {
    const S apart = right.angle - left.angle;
    const auto stays = [&](const Sample<S>& a, const Sample<S>& b) {
      return !has_fallen(a) && !has_fallen(b) && stays_above(a, b, apart);
    };
    const bool spins = stays(left.vis_viva, right.vis_viva),
               holds_downhill = stays(left.guards.downhill, right.guards.downhill),
               holds_uphill = stays(left.guards.uphill, right.guards.uphill);
    if (spins && holds_downhill && holds_uphill) return false;
    const auto& [a, b] = holds_uphill ? std::pair{left.guards.downhill, right.guards.downhill}
                                      : std::pair{left.guards.uphill, right.guards.uphill};
    is_plain = spins && holds_downhill != holds_uphill && a.value > S(0) && b.value < S(0);
    found = {holds_uphill ? PhaseEnd::slips_backwards : PhaseEnd::slips_forwards, left.angle, right.angle,
             a.value, b.value};
    return true;
  });
  if (!is_plain) found.from = found.to = roll.release;
  return found;
}

template <class T>
void RollingLanes<T>::polish_ends(const Begun& begun, const std::array<Bracket, width>& brackets,
                                  std::vector<EndedPhase<S>>& ended) {
  using std::abs, std::sqrt;
  const auto of_bracket = [&](S Bracket::*member) {
    return gathered<T>([&](std::size_t i) { return brackets[i].*member; });
  };
  const std::size_t count = begun.count;
  const typename TimedRolls<T>::Places& place = begun.place;
  const T &way = begun.way, &mu = begun.mu_static, &travel = begun.travel;
  const Roll<T>& roll = begun.roll;
  const T from = of_bracket(&Bracket::from), to = of_bracket(&Bracket::to),
          from_value = of_bracket(&Bracket::from_value), to_value = of_bracket(&Bracket::to_value),
          forwards =
              gathered<T>([&](std::size_t i) { return S(brackets[i].end == PhaseEnd::slips_forwards); });

  const T zero(S(0));
  const MaskOf<T> is_forwards = forwards > zero, falls = from < to;
  const auto guard_at = [&](const T& x) {
    const Trig<T> phi = trig(x);
    const StickGuards<T> guards = stick_guards(roll.hoop, phi, vis_viva(roll, x, phi), mu);
    return Sample<T>{select(is_forwards, guards.uphill.value, guards.downhill.value),
                     select(is_forwards, guards.uphill.rate, guards.downhill.rate)};
  };
  const T resolution = T(S(2) * std::numeric_limits<S>::epsilon()) * (T(abs(from)) + T(abs(to)));
  const T guess = from + (to - from) * from_value / (from_value - to_value);
  const T angle =
      select(falls, polish_root(guard_at, from, to, guess, MaskOf<T>(false), resolution, falls), to);
  const T x = angle - roll.release;
  const T spin =
      way * sqrt(larger(vis_viva_past_release(roll, x), zero) / contact_inertia(roll.hoop, trig(angle)));

  // Where it slips at once, or is to be rolled by itself, there is no way to go.
  const unsigned moves = Lanes<T>::bits((x > zero) & (spin - spin == zero)) & ((1u << count) - 1u);
  if (with_times_) timed_rolls_.begin(roll, x, place, moves);
  const auto travels = lanes_of(travel + way * x), angles = lanes_of(way * angle), spins = lanes_of(spin),
             ways = lanes_of(way);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(moves >> i & 1u)) {
      alone(place[i], ended);
      continue;
    }
    const PhaseEnd end = ways[i] < S(0) ? turned_over(brackets[i].end) : brackets[i].end;
    const ContactState<S> at{phases_[place[i]].at.time, travels[i], angles[i], spins[i]};
    if (with_times_)
      untimed_[place[i]] = {end, at};
    else
      ended.push_back({place[i], end, at});
  }
}

template <class T>
void RollingLanes<T>::time_some(std::vector<EndedPhase<S>>& ended) {
  timed_.clear();
  timed_rolls_.pass(timed_);
  for (const auto& [place, duration] : timed_) {
    const Untimed& phase = untimed_[place];
    if (std::isnan(duration)) {
      alone(place, ended);
    } else {
      ended.push_back({place, phase.end, phase.at});
      ended.back().at.time += duration;
    }
  }
}

#ifdef LEAPMAP_KERNELS
template class RollingLanes<Batch>;
#endif

}  // namespace leapmap
