// SPDX-License-Identifier: GPL-3.0-or-later
#include "coulomb/rolling_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap {
namespace {

constexpr double longest_panel = 2.8, shortest_panel = 0.1;  // [rad]; a phase with shorter ones rolls alone

}  // namespace

template <class T>
RollingLanes<T>::RollingLanes(double tolerance, std::size_t most)
    : tolerance_(std::max(S(tolerance) * S(0.1), S(1000) * std::numeric_limits<S>::epsilon())),
      leg_(tolerance),
      timed_(most),
      motions_(most),
      clocks_(most) {}

template <class T>
void RollingLanes<T>::begin(std::uint32_t place, const Hoop<S>& hoop, const S& mu_static,
                            const ContactState<S>& at, const S& runway) {
  waiting_.push_back({place, hoop, mu_static, at, runway});
}

template <class T>
void RollingLanes<T>::pass(std::vector<EndedPhase<S>>& ended) {
  if (timing_.size() >= width || waiting_.empty())
    time_panels(ended);
  else
    find_ends(ended);
}

template <class T>
void RollingLanes<T>::find_ends(std::vector<EndedPhase<S>>& ended) {
  bracketed_.clear();
  while (!waiting_.empty() && bracketed_.size() < width) {
    Bracketed found;
    if (bracket(waiting_.back(), found))
      bracketed_.push_back(found);
    else
      alone(waiting_.back(), ended);
    waiting_.pop_back();
  }
  if (!bracketed_.empty()) polish_ends(bracketed_, ended);
}

template <class T>
void RollingLanes<T>::alone(const Phase& phase, std::vector<EndedPhase<S>>& ended) const {
  ContactState<S> at = phase.at;
  const PhaseEnd end = leg_.run(phase.hoop, phase.mu_static, at, phase.runway);
  ended.push_back({phase.place, end, at});
}

/// Where one guard alone falls through zero between two looks, or none up to the runway's end.
template <class T>
bool RollingLanes<T>::bracket(const Phase& phase, Bracketed& found) const {
  const S sets_out = setting_out(phase.hoop, trig(phase.at.angle), phase.at.spin);
  if (sets_out == S(0)) return false;
  found.phase = phase;
  found.way = sets_out < S(0) ? S(-1) : S(1);
  found.roll =
      begin_roll(seen(phase.hoop, found.way), S(found.way * phase.at.angle), std::abs(phase.at.spin));
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
void RollingLanes<T>::polish_ends(std::span<const Bracketed> phases, std::vector<EndedPhase<S>>& ended) {
  using std::sqrt;
  const auto lanes = [&](const auto& number_of) {
    LaneArray<T> numbers;
    for (std::size_t i = 0; i < width; ++i) numbers[i] = number_of(phases[i < phases.size() ? i : 0]);
    return Lanes<T>::load(numbers.data());
  };
  const auto of_hoop = [&](S Hoop<S>::*member) {
    return lanes([&](const Bracketed& b) { return b.roll.hoop.*member; });
  };
  const auto of_roll = [&](S Roll<S>::*member) {
    return lanes([&](const Bracketed& b) { return b.roll.*member; });
  };
  const auto of_trig = [&](S Trig<S>::*member) {
    return lanes([&](const Bracketed& b) { return b.roll.release_trig.*member; });
  };
  const auto of_bracket = [&](S Bracketed::*member) {
    return lanes([&](const Bracketed& b) { return b.*member; });
  };
  const auto of_state = [&](S ContactState<S>::*member) {
    return lanes([&](const Bracketed& b) { return b.phase.at.*member; });
  };
  Roll<T> roll;
  roll.hoop = {of_hoop(&Hoop<S>::sin_slope), of_hoop(&Hoop<S>::cos_slope), of_hoop(&Hoop<S>::rho),
               of_hoop(&Hoop<S>::clearance), of_hoop(&Hoop<S>::Ic),        of_hoop(&Hoop<S>::J_min),
               of_hoop(&Hoop<S>::drive),     of_hoop(&Hoop<S>::thrust)};
  roll.release = of_roll(&Roll<S>::release);
  roll.release_trig = {of_trig(&Trig<S>::sin), of_trig(&Trig<S>::cos), of_trig(&Trig<S>::versine)};
  roll.released = of_roll(&Roll<S>::released), roll.level = of_roll(&Roll<S>::level);
  roll.push = of_roll(&Roll<S>::push);
  const T way = of_bracket(&Bracketed::way), from = of_bracket(&Bracketed::from),
          to = of_bracket(&Bracketed::to), from_value = of_bracket(&Bracketed::from_value),
          to_value = of_bracket(&Bracketed::to_value),
          mu = lanes([](const Bracketed&b) { return b.phase.mu_static; }),
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

  // x = shift + q^2 takes out E's zero before the start, where the spin is small and grows.
  const T two(S(2)), half(S(0.5)), longest = T(S(longest_panel));
  T shift = select(roll.push > zero, T(-roll.released / (two * roll.push)), T(-x));
  MaskOf<T> nearing = (shift > -x) & (shift < zero);
  for (int k = 0; k < 4 && any(nearing); ++k) {
    const T push = torque(roll.hoop, trig(T(roll.release + shift)));
    nearing = nearing & (push > zero);
    shift = select(nearing, T(shift - vis_viva_past_release(roll, shift) / (two * push)), shift);
    nearing = nearing & (shift > -x) & (shift < zero);
  }
  shift = larger(T(-x), smaller(shift, zero));
  // J has a needle at phi = 0, half as wide as d, cosh d = 1 + J_min / (2 rho). A narrow one may hide between
  // nodes, so that the tail itself is asked for, and not its square.
  const MaskOf<T> has_needle = !(roll.hoop.J_min > T(S(0.04)) * roll.hoop.rho);

  std::array<std::uint32_t, width> index;
  for (std::size_t i = 0; i < width; ++i) index[i] = phases[i < phases.size() ? i : 0].phase.place;
  const Trig<T>& phi = roll.release_trig;
  const T rho2 = two * roll.hoop.rho;
  motions_.template store<T>(
      {roll.released, two * roll.push, rho2 * sin_from_vertical(roll.hoop, phi),
       -rho2 * cos_from_vertical(roll.hoop, phi), roll.hoop.J_min, rho2, rho2 * phi.versine, rho2 * phi.sin},
      index.data(), phases.size());
  clocks_.template store<T>(
      {shift, sqrt(x - shift), sqrt(-shift), zero, select(has_needle, half * longest, longest),
       select(has_needle, T(tolerance_), T(S(0.03 * std::sqrt(tolerance_)))), abs(roll.hoop.thrust)},
      index.data(), phases.size());
  const auto travels = lanes_of(of_state(&ContactState<S>::travel) + way * x), angles = lanes_of(way * angle),
             spins = lanes_of(spin), ways_on = lanes_of(x);
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const Bracketed& now = phases[i];
    // Where it slips at once there is no way to time.
    if (!(ways_on[i] > S(0)) || !std::isfinite(spins[i])) {
      alone(now.phase, ended);
      continue;
    }
    timed_[now.phase.place] = {now.phase,
                               now.way < S(0) ? turned_over(now.end) : now.end,
                               {now.phase.at.time, travels[i], angles[i], spins[i]}};
    timing_.push_back(now.phase.place);
  }
}

/// By panels as long as the nodes resolve. The error of an integral goes as the tail's square, which holds
/// where no needle hides between nodes.
template <class T>
void RollingLanes<T>::time_panels(std::vector<EndedPhase<S>>& ended) {
  using std::sqrt;
  const std::size_t count = std::min(width, timing_.size()), first = timing_.size() - count;
  std::array<std::uint32_t, width> index;
  for (std::size_t i = 0; i < width; ++i) index[i] = timing_[first + (i < count ? i : 0)];
  timing_.resize(first);
  const auto [released, push2, by_sine, by_versine, J_min, by_turned, J_cos, J_sin] =
      motions_.template load<T>(index.data());
  const auto [shift, end, from, so_far, length, resolving, thrust] = clocks_.template load<T>(index.data());
  const T two(S(2));
  T to = sqrt(from * from + length);
  to = select(to * to + T(S(0.3)) * length > end * end, end, to);
  const T span = to - from;
  typename SpectralPanel<T, nodes>::Values f;
  T least_E(std::numeric_limits<S>::max());
  for (std::size_t i = 0; i < nodes; ++i) {
    // E and J as vis_viva_past_release and contact_inertia have them, turned on from the start.
    const T q = from + span * T(panel_.node[i]), x = shift + q * q;
    const Trig<T> turned = trig(x);
    const T E = released + push2 * x + by_sine * x_minus_sin(x, turned) + by_versine * turned.versine;
    const T J = J_min + by_turned * turned.versine + J_cos * turned.cos + J_sin * turned.sin;
    f[i] = two * q * slowness(J, E);
    least_E = smaller(least_E, E);
  }
  const T whole = span * panel_.integral(f), tail = span * panel_.tail(f);
  const T rounding =
      T(S(16) * std::numeric_limits<S>::epsilon()) * (T(S(4)) + released + two * to * to * thrust) / least_E;
  const MaskOf<T> resolved = tail <= larger(resolving, smaller(rounding, T(S(1e-4)))) * whole;
  const T sum = select(resolved, so_far + whole, so_far), at = select(resolved, to, from),
          next = select(resolved, length, T(S(0.5)) * length);
  clocks_.template store<T>({shift, end, at, sum, next, resolving, thrust}, index.data(), count);
  const unsigned done = Lanes<T>::bits(resolved & (to >= end)),
                 too_short = Lanes<T>::bits(!(next > T(S(shortest_panel))));
  const auto taken = lanes_of(sum);
  for (std::size_t i = 0; i < count; ++i) {
    const Timed& now = timed_[index[i]];
    if (done >> i & 1u) {
      ended.push_back({index[i], now.end, now.at});
      ended.back().at.time += taken[i];
    } else if (too_short >> i & 1u) {
      alone(now.phase, ended);
    } else {
      timing_.push_back(index[i]);
    }
  }
}

#ifdef LEAPMAP_KERNELS
template class RollingLanes<Batch>;
#endif

}  // namespace leapmap
