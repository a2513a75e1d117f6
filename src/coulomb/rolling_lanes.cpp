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
RollingLanes<T>::RollingLanes(double tolerance)
    : tolerance_(std::max(S(tolerance) * S(0.1), S(1000) * std::numeric_limits<S>::epsilon())),
      leg_(tolerance) {}

template <class T>
void RollingLanes<T>::begin(std::uint32_t place, const Hoop<S>& hoop, const S& mu_static,
                            const ContactState<S>& at, const S& runway) {
  waiting_.push_back({place, hoop, mu_static, at, runway});
}

template <class T>
void RollingLanes<T>::pass(std::vector<EndedPhase<S>>& ended) {
  while (!waiting_.empty() && bracketed_.size() < width) {
    Bracketed found;
    if (bracket(waiting_.back(), found))
      bracketed_.push_back(found);
    else
      alone(waiting_.back(), ended);
    waiting_.pop_back();
  }
  if (bracketed_.empty()) return;
  roll(bracketed_, ended);
  bracketed_.clear();
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
void RollingLanes<T>::roll(std::span<const Bracketed> phases, std::vector<EndedPhase<S>>& ended) {
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
  const T x = angle - roll.release, taken = duration(roll, x);
  const T spin =
      way * sqrt(larger(vis_viva_past_release(roll, x), zero) / contact_inertia(roll.hoop, trig(angle)));
  const auto times = lanes_of(of_state(&ContactState<S>::time) + taken),
             travels = lanes_of(of_state(&ContactState<S>::travel) + way * x), angles = lanes_of(way * angle),
             spins = lanes_of(spin), took = lanes_of(taken);
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const Bracketed& now = phases[i];
    // Where it slips at once there is no way to time.
    if (!(took[i] > S(0)) || !std::isfinite(spins[i])) {
      alone(now.phase, ended);
      continue;
    }
    const PhaseEnd end = now.way < S(0) ? turned_over(now.end) : now.end;
    ended.push_back({now.phase.place, end, {times[i], travels[i], angles[i], spins[i]}});
  }
}

/// In panels as long as the nodes resolve. The error of an integral goes as the tail's square, which holds
/// where no needle hides between nodes: J has one, half as wide as d, cosh d = 1 + J_min / (2 rho), at phi =
/// 0.
template <class T>
T RollingLanes<T>::duration(const Roll<T>& roll, const T& length) const {
  using std::sqrt;
  const T zero(S(0)), two(S(2)), half(S(0.5));
  // E's zero before the start.
  T shift = select(roll.push > zero, T(-roll.released / (two * roll.push)), T(-length));
  MaskOf<T> nearing = (shift > -length) & (shift < zero);
  for (int k = 0; k < 4 && any(nearing); ++k) {
    const T push = torque(roll.hoop, trig(T(roll.release + shift)));
    nearing = nearing & (push > zero);
    shift = select(nearing, T(shift - vis_viva_past_release(roll, shift) / (two * push)), shift);
    nearing = nearing & (shift > -length) & (shift < zero);
  }
  shift = larger(T(-length), smaller(shift, zero));
  const T end = sqrt(length - shift), longest = T(S(longest_panel));
  const MaskOf<T> has_needle = !(roll.hoop.J_min > T(S(0.04)) * roll.hoop.rho);
  const T resolving = select(has_needle, T(tolerance_), T(S(0.03 * std::sqrt(tolerance_))));
  T sum(S(0)), from = sqrt(-shift), panel = select(has_needle, half * longest, longest);
  MaskOf<T> solved = length > zero;
  for (MaskOf<T> under_way = solved & (from < end); any(under_way); under_way = solved & (from < end)) {
    T to = sqrt(from * from + panel);
    to = select(to * to + T(S(0.3)) * panel > end * end, end, to);
    typename SpectralPanel<T, nodes>::Values f;
    T least_E(std::numeric_limits<S>::max());
    for (std::size_t i = 0; i < nodes; ++i) {
      const T q = from + (to - from) * T(panel_.node[i]), x = shift + q * q;
      const Trig<T> turned = trig(x);
      const T E = vis_viva_past_release(roll, x, turned, x_minus_sin(x, turned));
      const T J = contact_inertia(roll.hoop, trig(T(roll.release + x)));
      f[i] = two * q * slowness(J, E);
      least_E = smaller(least_E, E);
    }
    const T whole = (to - from) * panel_.integral(f), tail = (to - from) * panel_.tail(f);
    const T rounding = T(S(16) * std::numeric_limits<S>::epsilon()) *
                       (T(S(4)) + roll.released + two * to * to * T(abs(roll.hoop.thrust))) / least_E;
    const MaskOf<T> resolved = under_way & (tail <= larger(resolving, smaller(rounding, T(S(1e-4)))) * whole);
    sum = select(resolved, sum + whole, sum);
    from = select(resolved, to, from);
    panel = select(under_way & !resolved, half * panel, panel);
    solved = solved & (panel > T(S(shortest_panel)));
  }
  return select(solved, sum, T(std::numeric_limits<S>::quiet_NaN()));
}

#ifdef LEAPMAP_KERNELS
template class RollingLanes<Batch>;
#endif

}  // namespace leapmap
