// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/rolling_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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
  bracketed_.clear();
  while (!waiting_.empty() && bracketed_.size() < width) {
    if (!bracket(waiting_.back(), bracketed_.emplace_back())) {
      bracketed_.pop_back();
      alone(waiting_.back(), ended);
    }
    waiting_.pop_back();
  }
  if (!bracketed_.empty()) polish_ends(ended);
}

template <class T>
void RollingLanes<T>::alone(std::uint32_t place, std::vector<EndedPhase<S>>& ended) const {
  const Phase& phase = phases_[place];
  ContactState<S> at = phase.at;
  const PhaseEnd end = leg_.run(phase.hoop, phase.mu_static, at, phase.runway);
  ended.push_back({place, end, at});
}

/// Where one guard alone falls through zero between two looks, or none up to the runway's end.
template <class T>
bool RollingLanes<T>::bracket(std::uint32_t place, Bracketed& found) const {
  const Phase& phase = phases_[place];
  const Trig<S> phi = trig(phase.at.angle);
  const S sets_out = setting_out(phase.hoop, phase.at.angle, phi, phase.at.spin);
  if (sets_out == S(0)) return false;
  found.place = place;
  found.way = sets_out < S(0) ? S(-1) : S(1);
  found.roll = begin_roll(seen(phase.hoop, found.way), S(found.way * phase.at.angle), seen(phi, found.way),
                          std::abs(phase.at.spin));
  const S last = found.roll.release + (phase.runway - found.way * phase.at.travel);
  found.end = PhaseEnd::runway_ends;
  found.from = found.to = last, found.from_value = S(1), found.to_value = S(-1);
  bool is_plain = true;
  walk_.run({found.roll, found.roll, phase.mu_static}, last, [&](const Look<S>& left, const Look<S>& right) {
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
    found.end = holds_uphill ? PhaseEnd::slips_backwards : PhaseEnd::slips_forwards;
    found.from = left.angle, found.to = right.angle, found.from_value = a.value, found.to_value = b.value;
    return true;
  });
  return is_plain;
}

template <class T>
void RollingLanes<T>::polish_ends(std::vector<EndedPhase<S>>& ended) {
  using std::abs, std::sqrt;
  const std::size_t count = bracketed_.size();
  // Lanes to spare repeat the first.
  const auto bracketed = [&](std::size_t i) -> const Bracketed& { return bracketed_[i < count ? i : 0]; };
  const auto lanes = [&](const auto& number_of) {
    return gathered<T>([&](std::size_t i) { return number_of(bracketed(i)); });
  };
  const auto of_bracket = [&](S Bracketed::*member) {
    return lanes([&](const Bracketed& b) { return b.*member; });
  };
  const auto phase_of = [&](const Bracketed& b) -> const Phase& { return phases_[b.place]; };
  const Roll<T> roll = gathered_roll<T>([&](std::size_t i) -> const Roll<S>& { return bracketed(i).roll; });
  const T way = of_bracket(&Bracketed::way), from = of_bracket(&Bracketed::from),
          to = of_bracket(&Bracketed::to), from_value = of_bracket(&Bracketed::from_value),
          to_value = of_bracket(&Bracketed::to_value),
          mu = lanes([&](const Bracketed&b) { return phase_of(b).mu_static; }),
          travel = lanes([&](const Bracketed&b) { return phase_of(b).at.travel; }),
          forwards = lanes([](const Bracketed&b) { return S(b.end == PhaseEnd::slips_forwards); });

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

  // Where it slips at once there is no way to go.
  const unsigned moves = Lanes<T>::bits((x > zero) & (spin - spin == zero)) & ((1u << count) - 1u);
  if (with_times_) {
    typename TimedRolls<T>::Places places;
    for (std::size_t i = 0; i < width; ++i) places[i] = bracketed(i).place;
    timed_rolls_.begin(roll, x, places, moves);
  }
  const auto travels = lanes_of(travel + way * x), angles = lanes_of(way * angle), spins = lanes_of(spin);
  for (std::size_t i = 0; i < count; ++i) {
    const Bracketed& now = bracketed_[i];
    if (!(moves >> i & 1u)) {
      alone(now.place, ended);
      continue;
    }
    const PhaseEnd end = now.way < S(0) ? turned_over(now.end) : now.end;
    const ContactState<S> at{phase_of(now).at.time, travels[i], angles[i], spins[i]};
    if (with_times_)
      untimed_[now.place] = {end, at};
    else
      ended.push_back({now.place, end, at});
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
