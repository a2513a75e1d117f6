// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/exact.hpp"

#include <bit>
#include <cmath>
#include <tuple>

#include "physics/flight_search.hpp"

namespace leapmap {
namespace {

/// The members of a Roll, in the order of their columns.
template <class R>
auto members(R& roll) {
  auto& h = roll.hoop;
  return std::tie(h.sin_slope, h.cos_slope, h.rho, h.clearance, h.Ic, h.J_min, roll.release, roll.release_trig.sin,
                  roll.release_trig.cos, roll.release_trig.versine, roll.released, roll.level, roll.push);
}

constexpr std::size_t release_column = 6;
constexpr int most_halvings = 40;  // an interval is then 1e-13 rad long

}  // namespace

template <class T>
ExactSolver<T>::ExactSolver(double tolerance, const Wanted& wanted)
    : wanted_(wanted), time_(tolerance), nodes_(scan_nodes<S>()), stalls_(block), flags_(block), places_(block) {
  for (Column& column : rolls_) column.resize(block);
  for (Column* column : {&end_, &quiet_, &first_turn_, &first_angle_, &jump_angle_}) column->resize(block);
}

template <class T>
typename ExactSolver<T>::Index ExactSolver<T>::index_of(std::span<const std::uint32_t> designs,
                                                        std::size_t first) const {
  Index index;
  for (std::size_t i = 0; i < width; ++i) index[i] = designs[first + i < designs.size() ? first + i : first];
  return index;
}

template <class T>
T ExactSolver<T>::load(const Column& column, const Index& index) const {
  if (index[width - 1] == index[0] + width - 1) return Lanes<T>::load(&column[index[0]]);  // they rise
  return Lanes<T>::gather(column.data(), index.data());
}

template <class T>
void ExactSolver<T>::store(const T& value, Column& column, const Index& index, std::size_t count) const {
  std::array<S, width> lanes;
  Lanes<T>::store(value, lanes.data());
  for (std::size_t i = 0; i < count; ++i) column[index[i]] = lanes[i];
}

template <class T>
Roll<T> ExactSolver<T>::load_roll(const Index& index) const {
  Roll<T> roll;
  std::size_t i = 0;
  std::apply([&](auto&... member) { ((member = load(rolls_[i++], index)), ...); }, members(roll));
  return roll;
}

template <class T>
Roll<ScalarOf<T>> ExactSolver<T>::roll_of(std::uint32_t design) const {
  Roll<S> roll;
  std::size_t i = 0;
  std::apply([&](auto&... member) { ((member = rolls_[i++][design]), ...); }, members(roll));
  return roll;
}

template <class T>
void ExactSolver<T>::solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes) {
  for (std::size_t first = 0; first < designs.size(); first += block) {
    const std::size_t count = std::min(block, designs.size() - first);
    solve_block(designs.subspan(first, count), scene, outcomes.subspan(first, count));
  }
}

template <class T>
void ExactSolver<T>::solve_block(std::span<const Design> designs, const Scene& scene,
                                 std::span<Outcome> outcomes) {
  prepare(designs, scene, outcomes);
  unscanned_ = searching_;
  while (!searching_.empty()) {
    scan(unscanned_);
    unscanned_.clear();
    intervals_.clear();
    std::size_t kept = 0;
    for (const std::uint32_t design : searching_) {
      Interval interval;
      if (next_interval(design, interval)) {
        intervals_.push_back(interval);
      } else if (end_[design] > S(2) * std::numbers::pi_v<S> * (first_turn_[design] + S(turns_a_scan))) {
        first_turn_[design] += S(turns_a_scan);
        places_[design] = {};
        unscanned_.push_back(design);
      } else {
        outcomes[design].status = stalls_[design] ? Status::stalled : Status::no_jump;
        continue;
      }
      searching_[kept++] = design;
    }
    searching_.resize(kept);
    look(designs, scene, outcomes);
    std::erase_if(searching_, [&](std::uint32_t design) { return outcomes[design].status != Status::not_computed; });
  }
  take_times(outcomes);
}

/// Derives every design's roll, and settles those that do not set out.
template <class T>
void ExactSolver<T>::prepare(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes) {
  using std::asin, std::floor, std::sqrt;
  const T pi(std::numbers::pi_v<S>), two_pi = T(2) * pi;
  searching_.clear();
  lifted_.clear();
  for (std::size_t first = 0; first < designs.size(); first += width) {
    const std::size_t count = std::min(width, designs.size() - first);
    const auto parameter = [&](double Design::*member) {
      std::array<S, width> lanes;
      for (std::size_t i = 0; i < width; ++i) lanes[i] = S(designs[first + (i < count ? i : 0)].*member);
      return Lanes<T>::load(lanes.data());
    };
    const Hoop<T> hoop = derive(parameter(&Design::slope), parameter(&Design::mass_ratio),
                                parameter(&Design::offset_ratio), parameter(&Design::inertia_factor));
    const T spin = parameter(&Design::release_spin);
    const Roll<T> roll = begin_roll(hoop, parameter(&Design::release_angle), spin);

    const T force = normal_force(hoop, roll.release_trig, spin, angular_acceleration(hoop, roll.release_trig, spin));
    const MaskOf<T> airborne = !(force > T(0));
    const MaskOf<T> uphill = (spin < T(0)) | ((spin == T(0)) & !(roll.push > T(0)));
    // E has minima only if rho > sin(theta), where theta + phi = pi - asin(sin(theta) / rho); they rise from one
    // revolution to the next, so that the first one after the release tells whether the hoop stalls.
    const MaskOf<T> uneven = hoop.rho > hoop.sin_slope;
    const T crest = asin(select(uneven, hoop.sin_slope / hoop.rho, T(1)));
    const T phase = pi - crest - hoop.slope;
    const T minimum = phase + two_pi * (floor((roll.release - phase) / two_pi) + T(1));
    const T least = vis_viva_past_release(roll, minimum - roll.release);
    const MaskOf<T> stalls = uneven & !(least > T(0));
    const T edge = RollingTime<T>::first_panel(roll) * pi;
    const T at_edge = vis_viva_past_release(roll, edge - roll.release);

    std::size_t c = 0;
    std::apply([&](const auto&... member) { (Lanes<T>::store(member, &rolls_[c++][first]), ...); }, members(roll));
    Lanes<T>::store(roll.release + two_pi * T(S(scene.runway)), &end_[first]);
    Lanes<T>::store(select(uneven, smaller(least, at_edge), at_edge), &quiet_[first]);
    Lanes<T>::store(floor(roll.release / two_pi), &first_turn_[first]);
    const unsigned in_the_air = Lanes<T>::bits(airborne), not_off = Lanes<T>::bits(uphill),
                   stalling = Lanes<T>::bits(stalls);
    std::array<S, width> minima, crests;
    Lanes<T>::store(minimum, minima.data());
    Lanes<T>::store(crest, crests.data());
    for (std::size_t i = 0; i < count; ++i) {
      const auto design = static_cast<std::uint32_t>(first + i);
      outcomes[design] = Outcome{};
      stalls_[design] = 0;
      places_[design] = {};
      if (in_the_air >> i & 1u) {
        outcomes[design].status = Status::airborne_at_release;
      } else if (not_off >> i & 1u) {
        outcomes[design].status = Status::stalled;
      } else {
        searching_.push_back(design);
        if (stalling >> i & 1u) find_stall(design, minima[i], crests[i]);
      }
    }
  }
}

/// E falls from its maximum, or from the release if that is later, to a minimum below zero.
template <class T>
void ExactSolver<T>::find_stall(std::uint32_t design, S minimum, S crest) {
  using std::max;
  const Roll<S> roll = roll_of(design);
  const auto vis_viva_at = [&](const S& angle) {
    return Sample<S>{vis_viva_past_release(roll, angle - roll.release), S(2) * torque(roll.hoop, trig(angle))};
  };
  const S from = max(roll.release, minimum - std::numbers::pi_v<S> + S(2) * crest);
  const S stall = polish_root(vis_viva_at, from, minimum, S(0.5L) * (from + minimum), false,
                              S(4) * std::numeric_limits<S>::epsilon() * max(S(1), minimum));
  if (stall >= end_[design]) return;
  end_[design] = stall;
  stalls_[design] = 1;
}

template <class T>
void ExactSolver<T>::scan(std::span<const std::uint32_t> designs) {
  const S two_pi = S(2) * std::numbers::pi_v<S>;
  for (std::size_t first = 0; first < designs.size(); first += width) {
    const std::size_t count = std::min(width, designs.size() - first);
    const Index index = index_of(designs, first);
    int turns = 1;
    for (std::size_t i = 0; i < count; ++i)
      while (turns < turns_a_scan && end_[index[i]] > two_pi * (first_turn_[index[i]] + S(turns))) ++turns;
    std::array<ScanFlags, 8> flags{};
    scan_turns(nodes_, load_roll(index), load(first_turn_, index), turns, flags.data());
    for (std::size_t i = 0; i < count; ++i) flags_[index[i]] = flags[i];
  }
}

/// The next interval of a design to look at, in order of angle; false if none of its scan is left.
template <class T>
bool ExactSolver<T>::next_interval(std::uint32_t design, Interval& interval) {
  const S step = S(2) * std::numbers::pi_v<S> / S(nodes_a_turn);
  Place& place = places_[design];
  ScanFlags& flags = flags_[design];
  while (place.turn < turns_a_scan) {
    const std::uint64_t left = flags[static_cast<std::size_t>(place.turn)];
    if (left == 0) {
      ++place.turn;
      continue;
    }
    place.node = std::countr_zero(left);
    const S node = (first_turn_[design] + S(place.turn)) * S(nodes_a_turn) + S(place.node);
    const S part = std::ldexp(S(1), -place.halvings), at = S(place.part) * part;
    const S from = std::max((node + at) * step, rolls_[release_column][design]);
    const S to = std::min((node + at + part) * step, end_[design]);
    if (from < to) {
      interval = {design, from, to};
      return true;
    }
    if (from >= end_[design]) flags.fill(0);
    else advance(design);
  }
  return false;
}

/// On to the part after this one.
template <class T>
void ExactSolver<T>::advance(std::uint32_t design) {
  Place& place = places_[design];
  ++place.part;
  while (place.halvings > 0 && place.part % 2 == 0) place.part /= 2, --place.halvings;
  if (place.halvings > 0) return;
  place.part = 0;
  flags_[design][static_cast<std::size_t>(place.turn)] &= ~(std::uint64_t{1} << place.node);
}

/// Tells what the intervals hold; where it is a lift-off, flies from it.
template <class T>
void ExactSolver<T>::look(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes) {
  using std::floor, std::sqrt;
  const T two_pi(S(2) * std::numbers::pi_v<S>);
  for (std::size_t first = 0; first < intervals_.size(); first += width) {
    const std::size_t count = std::min(width, intervals_.size() - first);
    Index index;
    std::array<S, width> from, to;
    for (std::size_t i = 0; i < width; ++i) {
      const Interval& interval = intervals_[first + (i < count ? i : 0)];
      index[i] = interval.design, from[i] = interval.from, to[i] = interval.to;
    }
    const Roll<T> roll = load_roll(index);
    const T a = Lanes<T>::load(from.data()), b = Lanes<T>::load(to.data());
    const CurvedSample<T> at_a = lift(roll, a), at_b = lift(roll, b);
    const IntervalKind<T> kind = classify(at_a, at_b, lift_bounds(roll, floor(a / two_pi)), b - a);
    unsigned falls = Lanes<T>::bits(kind.fall);
    const unsigned unclear = Lanes<T>::bits(kind.unclear), sinks = Lanes<T>::bits((at_a.value > T(0)) & (at_b.value < T(0)));
    for (std::size_t i = 0; i < count; ++i) {
      Place& place = places_[index[i]];
      if (!(unclear >> i & 1u)) {
        if (!(falls >> i & 1u)) advance(index[i]);
      } else if (place.halvings < most_halvings) {
        ++place.halvings;
        place.part *= 2;
      } else if (sinks >> i & 1u) {
        falls |= 1u << i;
      } else {
        advance(index[i]);
      }
    }
    if (!(falls & ((2u << (count - 1)) - 1u))) continue;

    const MaskOf<T> fall = kind.fall | (kind.unclear & (at_a.value > T(0)) & (at_b.value < T(0)));
    const T guess = a + (b - a) * at_a.value / (at_a.value - at_b.value);
    const T epsilon(std::numeric_limits<S>::epsilon());
    const T angle = polish_root([&](const T& x) { return lift(roll, x); }, a, b, guess, fall & !fall,
                                epsilon * larger(T(1), b), fall);
    const Trig<T> phi = trig(angle);
    const T spin = sqrt(vis_viva(roll, angle, phi) / contact_inertia(roll.hoop, phi));
    const Flight<T> flight = fly(roll.hoop, LiftOff<T>{T(0), angle, spin}, fall);

    std::array<S, width> angles, spins, heights, apexes, landings, dips;
    Lanes<T>::store(angle, angles.data()), Lanes<T>::store(spin, spins.data());
    Lanes<T>::store(flight.height, heights.data()), Lanes<T>::store(flight.apex_time, apexes.data());
    Lanes<T>::store(flight.flight_time, landings.data()), Lanes<T>::store(flight.dip, dips.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (!(falls >> i & 1u)) continue;
      const std::uint32_t design = index[i];
      Outcome& outcome = outcomes[design];
      if (!std::isfinite(angles[i]) || !std::isfinite(heights[i])) {
        outcome = failed_outcome();
        continue;
      }
      if (outcome.candidates == 0) {
        first_angle_[design] = angles[i];
        lifted_.push_back(design);
      }
      jump_angle_[design] = angles[i];
      const LiftOff<double> lift_off{Outcome::none, static_cast<double>(angles[i]), static_cast<double>(spins[i])};
      const Flight<double> flown{static_cast<double>(heights[i]), static_cast<double>(apexes[i]),
                                 static_cast<double>(landings[i]), static_cast<double>(dips[i])};
      if (!consider(outcome, scene, designs[design], lift_off, flown)) advance(design);
    }
  }
}

template <class T>
void ExactSolver<T>::take_times(std::span<Outcome> outcomes) {
  for (std::size_t first = 0; first < lifted_.size(); first += width) {
    const std::size_t count = std::min(width, lifted_.size() - first);
    const Index index = index_of(lifted_, first);
    const Roll<T> roll = load_roll(index);
    const T quiet = load(quiet_, index), first_angle = load(first_angle_, index), jump_angle = load(jump_angle_, index);
    Clock<T> clock;
    MaskOf<T> hard = first_angle != first_angle;
    const T first_time = time_.from_release(roll, quiet, first_angle, clock, hard);
    T jump_time = first_time;
    const MaskOf<T> later = jump_angle > first_angle;
    if (any(later)) jump_time = select(later, time_.from_release(roll, quiet, jump_angle, clock, hard), first_time);
    std::array<S, width> firsts, jumps;
    Lanes<T>::store(first_time, firsts.data());
    Lanes<T>::store(jump_time, jumps.data());
    const unsigned by_halving = Lanes<T>::bits(hard);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t design = index[i];
      Outcome& outcome = outcomes[design];
      if (by_halving >> i & 1u) {
        const Roll<S> one = roll_of(design);
        firsts[i] = time_.halving(one, one.release, first_angle_[design]);
        jumps[i] = firsts[i];
        if (jump_angle_[design] > first_angle_[design])
          jumps[i] += time_.halving(one, first_angle_[design], jump_angle_[design]);
      }
      if (outcome.status == Status::failed) continue;
      outcome.first_jump_time = static_cast<double>(firsts[i]);
      if (outcome.status == Status::jumped) outcome.jump_time = static_cast<double>(jumps[i]);
    }
  }
}

template class ExactSolver<double>;
template class ExactSolver<long double>;
template class ExactSolver<Batch>;

}  // namespace leapmap
