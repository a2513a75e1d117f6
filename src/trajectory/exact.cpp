// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/exact.hpp"

#include <bit>
#include <cmath>

#include "physics/flight_search.hpp"

namespace leapmap {
namespace {

template <class S>
constexpr S pi_of = std::numbers::pi_v<S>;

// What the rows of a block hold, number by number.
template <class T>
std::array<T, 8> motion_row(const Roll<T>& roll) {
  const Hoop<T>& h = roll.hoop;
  return {h.sin_slope, h.cos_slope, h.rho, h.clearance, h.Ic, h.J_min, roll.level, h.slope};
}
template <class T>
std::array<T, 8> release_row(const Roll<T>& roll, const Quiet<T>& quiet) {
  const Trig<T>& phi = roll.release_trig;
  return {roll.release,  phi.sin,   phi.cos,        phi.versine,
          roll.released, roll.push, quiet.vis_viva, quiet.distance};
}
/// A time that the quadrature could not tell makes the design failed: no field of it is to be believed.
template <class S>
void note_time(Outcome& outcome, double Outcome::*time, const S& taken) {
  if (std::isfinite(taken)) {
    outcome.*time = static_cast<double>(taken);
  } else {
    outcome = failed_outcome();
  }
}

enum LiftOffRow { angle_of, spin_of, apex_of, last_apex_of, sunk_of, dip_of };

}  // namespace

template <class T>
ExactSolver<T>::ExactSolver(double tolerance, const Wanted& wanted)
    : wanted_(wanted),
      time_(tolerance),
      nodes_(scan_nodes<S>()),
      searches_(block),
      motions_(block),
      releases_(block),
      lift_offs_(block) {
  for (std::size_t k = 0; k < part_length_.size(); ++k) part_length_[k] = S(1) / S(std::uint64_t{1} << k);
}

template <class T>
typename ExactSolver<T>::Index ExactSolver<T>::index_of(const List& designs, std::size_t first) const {
  Index index;
  for (std::size_t i = 0; i < width; ++i) index[i] = designs[first + i < designs.size() ? first + i : first];
  return index;
}

template <class T>
T ExactSolver<T>::gather(const Index& index, S Search::*member) const {
  LaneArray<T> lanes;
  for (std::size_t i = 0; i < width; ++i) lanes[i] = searches_[index[i]].*member;
  return Lanes<T>::load(lanes.data());
}

template <class T>
typename ExactSolver<T>::LoadedIntervals ExactSolver<T>::load_intervals(
    const std::vector<Interval>& intervals, std::size_t first) const {
  Index index;
  LaneArray<T> from, to, turn;
  for (std::size_t i = 0; i < width; ++i) {
    const Interval& interval = intervals[first + i < intervals.size() ? first + i : first];
    index[i] = interval.design, from[i] = interval.from, to[i] = interval.to, turn[i] = interval.turn;
  }
  return {index, Lanes<T>::load(from.data()), Lanes<T>::load(to.data()), Lanes<T>::load(turn.data())};
}

template <class T>
template <class U>
Roll<U> ExactSolver<T>::load_roll(const std::uint32_t* index, bool with_release) const {
  Roll<U> roll;
  Hoop<U>& h = roll.hoop;
  const std::array<U, 8> m = load_rows<U>(motions_.data(), index);
  h.sin_slope = m[0], h.cos_slope = m[1], h.rho = m[2], h.clearance = m[3], h.Ic = m[4], h.J_min = m[5];
  roll.level = m[6], h.slope = m[7];
  if (!with_release) return roll;
  const std::array<U, 8> r = load_rows<U>(releases_.data(), index);
  roll.release = r[0], roll.release_trig = {r[1], r[2], r[3]}, roll.released = r[4], roll.push = r[5];
  return roll;
}

template <class T>
Quiet<T> ExactSolver<T>::load_quiet(const Index& index) const {
  const std::array<T, 8> row = load_rows<T>(releases_.data(), index.data());
  return {row[6], row[7]};
}

template <class T>
void ExactSolver<T>::solve(std::span<const Design> designs, const Scene& scene, std::span<Outcome> outcomes,
                           std::vector<LiftOff<double>>* lift_offs) {
  told_ = lift_offs;
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
    unscanned_.clear(), still_searching_.clear(), intervals_.clear(), falls_.clear();
    for (const std::uint32_t design : searching_) {
      Search& search = searches_[design];
      Interval interval;
      if (next_interval(design, interval)) {
        (interval.falls ? falls_ : intervals_).push_back(interval);
      } else if (search.end > S(2) * pi_of<S> * (search.first_turn + S(turns_a_scan))) {
        search.first_turn += S(turns_a_scan);
        search.turn = 0;
        unscanned_.push_back(design);
        still_searching_.push_back(design);
      } else {
        outcomes[design].status = search.stalls ? Status::stalled : Status::no_jump;
      }
    }
    classify_intervals();
    take_off(designs, scene, outcomes);
    std::swap(searching_, still_searching_);
  }
  lifted_.clear(), jumped_.clear();
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].candidates > 0) lifted_.push_back(static_cast<std::uint32_t>(i));
    if (outcomes[i].status == Status::jumped) jumped_.push_back(static_cast<std::uint32_t>(i));
  }
  if (wanted_.descent) land(outcomes);
  if (wanted_.first_jump_time || wanted_.jump_time) take_times(outcomes);
}

/// Derives every design's roll, and settles those that do not set out.
template <class T>
void ExactSolver<T>::prepare(std::span<const Design> designs, const Scene& scene,
                             std::span<Outcome> outcomes) {
  using std::abs, std::asin, std::atan2, std::floor;
  const T pi(pi_of<S>), two_pi = T(2) * pi;
  searching_.clear();
  for (std::size_t first = 0; first < designs.size(); first += width) {
    const std::size_t count = std::min(width, designs.size() - first);
    Index index;
    for (std::size_t i = 0; i < width; ++i)
      index[i] = static_cast<std::uint32_t>(first + (i < count ? i : 0));
    const auto parameter = [&](double Design::*member) {
      LaneArray<T> lanes;
      for (std::size_t i = 0; i < width; ++i) lanes[i] = S(designs[index[i]].*member);
      return Lanes<T>::load(lanes.data());
    };
    const Hoop<T> hoop = derive(parameter(&Design::slope), parameter(&Design::mass_ratio),
                                parameter(&Design::offset_ratio), parameter(&Design::inertia_factor));
    const T spin = parameter(&Design::release_spin);
    // A release many turns from 0 is taken back to the first, so that angles have digits to spare.
    const T release_angle = parameter(&Design::release_angle);
    const Trig<T> direction = trig(release_angle);
    const T nearest =
        select(abs(release_angle) > T(S(4) * pi_of<S>), atan2(direction.sin, direction.cos), release_angle);
    const Roll<T> roll = begin_roll(hoop, nearest, spin);

    const T force =
        normal_force(hoop, roll.release_trig, spin, angular_acceleration(hoop, roll.release_trig, spin));
    const MaskOf<T> airborne = !(force > T(0));
    const MaskOf<T> uphill = (spin < T(0)) | ((spin == T(0)) & !(roll.push > T(0)));
    // E has minima only if rho > sin(theta), where theta + phi = pi - asin(sin(theta) / rho); they rise from
    // one revolution to the next, so that the first one after the release tells whether the hoop stalls.
    // Otherwise E rises always, and least where theta + phi = pi / 2.
    const MaskOf<T> uneven = hoop.rho > hoop.sin_slope;
    const T crest = asin(select(uneven, hoop.sin_slope / hoop.rho, T(1)));
    const T phase = pi - crest - hoop.slope;
    const T minimum = phase + two_pi * (floor((roll.release - phase) / two_pi) + T(1));
    const T least = vis_viva_past_release(roll, minimum - roll.release);
    const T at_edge = vis_viva_past_release(roll, RollingTime<T>::first_panel(roll) * pi - roll.release);
    store_rows(motion_row(roll), motions_.data(), index.data(), count);
    store_rows(release_row(roll, Quiet<T>{smaller(least, at_edge), minimum - roll.release}), releases_.data(),
               index.data(), count);

    const unsigned in_the_air = Lanes<T>::bits(airborne), not_off = Lanes<T>::bits(uphill),
                   stalling = Lanes<T>::bits(uneven & !(least > T(0)));
    const auto release = lanes_of(roll.release), end = lanes_of(roll.release + two_pi * T(S(scene.runway))),
               first_turn = lanes_of(floor(roll.release / two_pi)),
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
        Search& search = searches_[design];
        search.release = release[i], search.end = end[i], search.first_turn = first_turn[i];
        search.turned_back = turns_back[i];
        search.turn = search.node = search.halvings = 0, search.part = 0;
        search.stalls = false;
        searching_.push_back(design);
        if (stalling >> i & 1u) find_stall(search, load_roll<S>(&design, true), minima[i], crests[i]);
      }
    }
  }
}

/// E falls from its maximum, or from the release if that is later, to a minimum below zero.
template <class T>
void ExactSolver<T>::find_stall(Search& search, const Roll<S>& roll, const S& minimum, const S& crest) const {
  const auto vis_viva_at = [&](const S& angle) {
    return Sample<S>{vis_viva_past_release(roll, angle - roll.release),
                     S(2) * torque(roll.hoop, trig(angle))};
  };
  const S from = std::max(roll.release, minimum - pi_of<S> + S(2) * crest);
  const S resolution = S(4) * std::numeric_limits<S>::epsilon() * std::max(S(1), std::abs(minimum));
  const S stall = polish_root(vis_viva_at, from, minimum, S(0.5L) * (from + minimum), false, resolution);
  if (stall < search.end) search.end = stall, search.stalls = true;
}

template <class T>
void ExactSolver<T>::scan(const List& designs) {
  for (std::size_t first = 0; first < designs.size(); first += width) {
    const Index index = index_of(designs, first);
    int turns = 1;
    for (const std::uint32_t design : index) {
      const Search& search = searches_[design];
      while (turns < turns_a_scan && search.end > S(2) * pi_of<S> * (search.first_turn + S(turns))) ++turns;
    }
    std::array<ScanFlags, 8> flags;
    scan_turns(nodes_, load_roll<T>(index.data(), false), gather(index, &Search::first_turn), turns,
               flags.data());
    for (std::size_t i = 0; i < width; ++i) searches_[index[i]].flags = flags[i];
  }
}

/// The next interval of a design to look at; false if none of its scan is left.
template <class T>
bool ExactSolver<T>::next_interval(std::uint32_t design, Interval& interval) {
  const S step = S(2) * pi_of<S> / S(nodes_a_turn);
  Search& search = searches_[design];
  while (search.turn < turns_a_scan) {
    const std::uint64_t left = search.flags.looks[static_cast<std::size_t>(search.turn)];
    if (left == 0) {
      ++search.turn;
      continue;
    }
    search.node = std::countr_zero(left);
    const S turn = search.first_turn + S(search.turn);
    const S node = turn * S(nodes_a_turn) + S(search.node);
    const S part = part_length_[static_cast<std::size_t>(search.halvings)], at = node + S(search.part) * part;
    const S from = std::max(at * step, search.release), to = std::min((at + part) * step, search.end);
    if (from < to) {
      const bool falls = search.flags.falls[static_cast<std::size_t>(search.turn)] >> search.node & 1u;
      interval = {design,
                  turn,
                  from,
                  to,
                  (from + to) * S(0.5),
                  falls && from == at * step && to == (at + part) * step};
      return true;
    }
    if (from >= search.end) {
      search.turn = turns_a_scan;
    } else {
      advance(search);
    }
  }
  return false;
}

/// On to the part after this one.
template <class T>
void ExactSolver<T>::advance(Search& search) const {
  ++search.part;
  while (search.halvings > 0 && search.part % 2 == 0) search.part /= 2, --search.halvings;
  if (search.halvings > 0) return;
  search.part = 0;
  search.flags.looks[static_cast<std::size_t>(search.turn)] &= ~(std::uint64_t{1} << search.node);
}

/// Tells what the intervals hold; those with a lift-off become falls.
template <class T>
void ExactSolver<T>::classify_intervals() {
  for (std::size_t first = 0; first < intervals_.size(); first += width) {
    const std::size_t count = std::min(width, intervals_.size() - first);
    const auto [index, a, b, turn] = load_intervals(intervals_, first);
    const Roll<T> roll = load_roll<T>(index.data(), false);
    const CurvedSample<T> at_a = lift(roll, a), at_b = lift(roll, b);
    const IntervalKind<T> kind = classify(at_a, at_b, lift_bounds(roll, turn), b - a);
    const MaskOf<T> falls_through = (at_b.value < T(0)) | ((at_b.value == T(0)) & (at_b.rate < T(0)));
    const unsigned falls = Lanes<T>::bits(kind.fall), unclear = Lanes<T>::bits(kind.unclear),
                   sinking = Lanes<T>::bits((at_a.value > T(0)) & falls_through);
    const auto guess = lanes_of(a + (b - a) * at_a.value / (at_a.value - at_b.value));
    for (std::size_t i = 0; i < count; ++i) {
      Search& search = searches_[index[i]];
      Interval interval = intervals_[first + i];
      const bool short_of_digits =
          interval.to - interval.from <= S(16) * std::numeric_limits<S>::epsilon() * std::abs(interval.to);
      const bool at_last = (unclear >> i & 1u) && (search.halvings == most_halvings || short_of_digits);
      if ((falls >> i & 1u) || (at_last && (sinking >> i & 1u))) {
        interval.guess = guess[i];
        falls_.push_back(interval);
        continue;
      }
      if ((unclear >> i & 1u) && !at_last) {
        ++search.halvings;
        search.part *= 2;
      } else {
        advance(search);
      }
      still_searching_.push_back(index[i]);
    }
  }
}

/// Polishes the falls and flies from them up to the apex.
template <class T>
void ExactSolver<T>::take_off(std::span<const Design> designs, const Scene& scene,
                              std::span<Outcome> outcomes) {
  using std::abs, std::sqrt;
  const T epsilon(std::numeric_limits<S>::epsilon());
  for (std::size_t first = 0; first < falls_.size(); first += width) {
    const std::size_t count = std::min(width, falls_.size() - first);
    const auto [index, a, b, turn] = load_intervals(falls_, first);
    LaneArray<T> guess;
    for (std::size_t i = 0; i < width; ++i) guess[i] = falls_[first + (i < count ? i : 0)].guess;
    const Roll<T> roll = load_roll<T>(index.data(), false);
    const MaskOf<T> all_lanes = a == a;
    const T angle = polish_root([&](const T& x) { return lift(roll, x); }, a, b, Lanes<T>::load(guess.data()),
                                !all_lanes, T(2) * epsilon * larger(T(1), abs(b)), all_lanes);
    const Trig<T> phi = trig(angle);
    const T spin = sqrt(vis_viva(roll, angle, phi) / contact_inertia(roll.hoop, phi));
    const Ascent<T> ascent = ascend(toss_of(roll.hoop, angle, phi, spin), all_lanes);
    const T height = T(0.5) * roll.hoop.rho * ascent.height, apex_time = ascent.apex / spin;
    const auto angles = lanes_of(angle), spins = lanes_of(spin), heights = lanes_of(height),
               apexes = lanes_of(apex_time);
    store_rows<T>({angle, spin, ascent.apex, ascent.last_apex, ascent.sunk, ascent.dip, T(0), T(0)},
                  lift_offs_.data(), index.data(), count);
    for (std::size_t i = 0; i < count; ++i) {
      Search& search = searches_[index[i]];
      Outcome& outcome = outcomes[index[i]];
      if (!std::isfinite(angles[i]) || !std::isfinite(spins[i]) || !std::isfinite(heights[i])) {
        outcome = failed_outcome();
        continue;
      }
      if (outcome.candidates == 0) search.first_angle = angles[i];
      search.jump_angle = angles[i];
      const LiftOff<double> lift_off{Outcome::none, static_cast<double>(angles[i] + search.turned_back),
                                     static_cast<double>(spins[i])};
      if (told_) told_->push_back(lift_off);
      const Flight<double> flight{static_cast<double>(heights[i]), static_cast<double>(apexes[i]),
                                  Outcome::none, Outcome::none};
      if (consider(outcome, scene, designs[index[i]], lift_off, flight)) continue;
      advance(search);
      still_searching_.push_back(index[i]);
    }
  }
}

/// Landing and dip of the jumps.
template <class T>
void ExactSolver<T>::land(std::span<Outcome> outcomes) const {
  for (std::size_t first = 0; first < jumped_.size(); first += width) {
    const std::size_t count = std::min(width, jumped_.size() - first);
    const Index index = index_of(jumped_, first);
    const Roll<T> roll = load_roll<T>(index.data(), false);
    const std::array<T, 8> row = load_rows<T>(lift_offs_.data(), index.data());
    const T spin = row[spin_of];
    const Toss<T> toss = toss_of(roll.hoop, row[angle_of], trig(row[angle_of]), spin);
    const Ascent<T> ascent{T(0), row[apex_of], row[last_apex_of], row[sunk_of], row[dip_of]};
    const Flight<T> flight = scaled(descend(toss, ascent, spin == spin), roll.hoop, spin);
    const auto landings = lanes_of(flight.flight_time), dips = lanes_of(flight.dip);
    for (std::size_t i = 0; i < count; ++i) {
      outcomes[index[i]].flight_time = static_cast<double>(landings[i]);
      outcomes[index[i]].dip = static_cast<double>(dips[i]);
    }
  }
}

/// The times of all first lift-offs and jumps.
template <class T>
void ExactSolver<T>::take_times(std::span<Outcome> outcomes) {
  start_clocks();
  const auto is_later = [&](std::uint32_t design) {
    return searches_[design].jump_angle > searches_[design].first_angle;
  };
  if (!wanted_.first_jump_time)
    std::erase_if(lifted_, [&](std::uint32_t design) {
      return outcomes[design].status != Status::jumped || is_later(design);
    });
  take_times(lifted_, &Search::first_angle, &Outcome::first_jump_time, outcomes);
  later_.clear();
  for (const std::uint32_t design : jumped_) {
    if (outcomes[design].status == Status::failed) continue;
    if (is_later(design)) {
      later_.push_back(design);
    } else {
      outcomes[design].jump_time = outcomes[design].first_jump_time;
    }
  }
  if (wanted_.jump_time) take_times(later_, &Search::jump_angle, &Outcome::jump_time, outcomes);
}

template <class T>
void ExactSolver<T>::start_clocks() {
  for (std::size_t first = 0; first < lifted_.size(); first += width) {
    const std::size_t count = std::min(width, lifted_.size() - first);
    const Index index = index_of(lifted_, first);
    const Roll<T> roll = load_roll<T>(index.data(), true);
    const Quiet<T> quiet = load_quiet(index);
    MaskOf<T> hard = roll.push != roll.push;
    const NodesNeeded<T> needed = time_.needed(roll, quiet, hard);
    const T panel = time_.first_panel(roll),
            time = time_.stretch(roll, quiet, needed, panel * T(pi_of<S>), hard);
    const unsigned by_halving = Lanes<T>::bits(hard);
    const auto panels = lanes_of(panel), times = lanes_of(time), panel_nodes = lanes_of(needed.panel),
               rest_nodes = lanes_of(needed.rest);
    for (std::size_t i = 0; i < count; ++i) {
      Search& search = searches_[index[i]];
      search.panel = static_cast<long>(panels[i]), search.panel_time = times[i];
      search.panel_nodes = by_halving >> i & 1u ? 0 : static_cast<int>(panel_nodes[i]);
      search.rest_nodes = static_cast<int>(rest_nodes[i]);
    }
  }
}

/// Sorts parts by part, by counting where they are few.
template <class T>
void ExactSolver<T>::sort_parts(std::vector<Part>& parts) {
  if (parts.empty()) return;
  const auto [least, most] = std::ranges::minmax(parts, {}, &Part::number);
  const auto range = static_cast<std::size_t>(most.number - least.number) + 1;
  if (range > block) {
    std::ranges::sort(parts, {}, &Part::number);
    return;
  }
  places_.assign(range + 1, 0);
  const long base = least.number;
  for (const Part& part : parts) ++places_[static_cast<std::size_t>(part.number - base) + 1];
  for (std::size_t i = 1; i < range; ++i) places_[i] += places_[i - 1];
  sorted_parts_.resize(parts.size());
  for (const Part& part : parts)
    sorted_parts_[places_[static_cast<std::size_t>(part.number - base)]++] = part;
  std::swap(parts, sorted_parts_);
}

/// One of the outcome's times. Designs are taken in order of angle, so that those in the lanes have panels in
/// common.
template <class T>
void ExactSolver<T>::take_times(const List& designs, S Search::*angle, double Outcome::*time,
                                std::span<Outcome> outcomes) {
  early_.clear(), due_.clear();
  for (const std::uint32_t design : designs) {
    const Search& search = searches_[design];
    if (search.panel_nodes == 0) {
      note_time(outcomes[design], time, halve_time(design, angle));
      continue;
    }
    const long part = static_cast<long>(std::floor(search.*angle * (S(parts_a_panel) / pi_of<S>)));
    (part < search.panel * parts_a_panel ? early_ : due_).push_back({part, design});
  }
  sort_parts(early_);
  sort_parts(due_);
  for (std::size_t first = 0, count = 0; first < early_.size(); first += count) {
    const Index index = index_of_part(early_, first, count);
    int rest_nodes = time_.rest_nodes_near_release();
    for (const std::uint32_t design : index) rest_nodes = std::max(rest_nodes, searches_[design].rest_nodes);
    const Roll<T> roll = load_roll<T>(index.data(), true);
    const T to = gather(index, angle), edge(S(early_[first].number) * (pi_of<S> / S(parts_a_panel)));
    const Quiet<T> quiet = load_quiet(index);
    MaskOf<T> hard = to != to;
    const NodesNeeded<T> needed = time_.needed(roll, quiet, hard);
    const bool with_rest = all(edge > roll.release + T(0.4));
    T taken = time_.stretch(roll, quiet, needed, with_rest ? edge : to, hard);
    if (with_rest) taken = taken + time_.rest(roll, lanes_of(edge)[0], to - edge, rest_nodes);
    auto times = lanes_of(taken);
    const unsigned by_halving = Lanes<T>::bits(hard);
    for (std::size_t i = 0; i < count; ++i) {
      if (by_halving >> i & 1u) times[i] = halve_time(index[i], angle);
      note_time(outcomes[index[i]], time, times[i]);
    }
  }
  for (std::size_t first = 0, count = 0; first < due_.size(); first += count) {
    const Index index = index_of_part(due_, first, count);
    int panel_nodes = 0, rest_nodes = 0;
    long begin = std::numeric_limits<long>::max();
    LaneArray<T> panels;
    for (std::size_t i = 0; i < width; ++i) {
      const Search& search = searches_[index[i]];
      panels[i] = S(search.panel);
      begin = std::min(begin, search.panel);
      panel_nodes = std::max(panel_nodes, search.panel_nodes);
      rest_nodes = std::max(rest_nodes, search.rest_nodes);
    }
    const Roll<T> roll = load_roll<T>(index.data(), false);
    const T to = gather(index, angle), first_panel = Lanes<T>::load(panels.data());
    T taken = gather(index, &Search::panel_time);
    const long part = due_[first].number;
    const long end = (part - (part % parts_a_panel + parts_a_panel) % parts_a_panel) / parts_a_panel;
    for (long panel = begin; panel < end; ++panel)
      taken = taken +
              select(T(S(panel)) >= first_panel, time_.panel(roll, panel, parts_a_panel, panel_nodes), T(0));
    auto times = lanes_of(taken);
    for (std::size_t i = 0; i < count; ++i)
      searches_[index[i]].panel = end, searches_[index[i]].panel_time = times[i];
    if (const int parts = static_cast<int>(part - end * parts_a_panel); parts > 0)
      taken = taken + time_.panel(roll, end, parts, panel_nodes);
    const S edge = S(part) * (pi_of<S> / S(parts_a_panel));
    times = lanes_of(taken + time_.rest(roll, edge, to - T(edge), rest_nodes));
    for (std::size_t i = 0; i < count; ++i) note_time(outcomes[index[i]], time, times[i]);
  }
}

template <class T>
ScalarOf<T> ExactSolver<T>::halve_time(std::uint32_t design, S Search::*angle) const {
  return time_.halving(load_roll<S>(&design, true), searches_[design].*angle);
}

/// As many designs of one part as there are lanes.
template <class T>
typename ExactSolver<T>::Index ExactSolver<T>::index_of_part(const std::vector<Part>& parts,
                                                             std::size_t first, std::size_t& count) const {
  Index index;
  index.fill(parts[first].design);
  for (count = 1; count < width && first + count < parts.size(); ++count) {
    if (parts[first + count].number != parts[first].number) break;
    index[count] = parts[first + count].design;
  }
  return index;
}

template class ExactSolver<double>;
template class ExactSolver<long double>;
template class ExactSolver<Batch>;

}  // namespace leapmap
