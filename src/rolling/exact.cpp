// SPDX-License-Identifier: GPL-3.0-or-later
#include "rolling/exact.hpp"

#include <bit>
#include <cmath>

#include "physics/flight_search.hpp"
#include "trajectory/jump_rule.hpp"
#include "trajectory/units.hpp"

namespace leapmap {
template <class T>
ExactSolver<T>::ExactSolver(double tolerance, const Wanted& wanted)
    : wanted_(wanted), time_(tolerance), nodes_(scan_nodes<S>()), searches_(block), rows_(block) {
  for (std::size_t k = 0; k < part_length_.size(); ++k) part_length_[k] = S(1) / S(std::uint64_t{1} << k);
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
  const double second = time_unit(scene);
  for (Outcome& outcome : outcomes) to_seconds(outcome, second);
}

/// Derives every design's roll, and settles those that do not set out.
template <class T>
void ExactSolver<T>::prepare(std::span<const Design> designs, const Scene& scene,
                             std::span<Outcome> outcomes) {
  using std::abs, std::atan2, std::floor;
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
    rows_.store(roll, Quiet<T>{smaller(least, at_edge), minimum - roll.release}, index.data(), count);

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
        Search& search = searches_[design];
        search.release = release[i], search.end = end[i], search.first_turn = first_turn[i];
        search.turned_back = turns_back[i];
        search.turn = search.node = search.halvings = 0, search.part = 0;
        search.stalls = false;
        search.node_past_release = static_cast<std::uint32_t>(past_release[i]);
        search.released_on_node = on_node >> i & 1u;
        searching_.push_back(design);
        if (stalling >> i & 1u) {
          const S stall = stall_angle(rows_.template load_roll<S>(&design), minima[i], crests[i]);
          if (stall < search.end) search.end = stall, search.stalls = true;
        }
      }
    }
  }
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
    NodeSigns signs;
    scan_turns(nodes_, rows_.template load_motion<T>(index.data()), gather(index, &Search::first_turn), turns,
               flags.data(), signs);
    const std::size_t count = std::min(width, designs.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      searches_[index[i]].flags = flags[i];
      hand_on_signs(searches_[index[i]], signs, i, turns);
    }
  }
}

/// At the release the hoop is on the plane, or it would not have set out; at a scan's first node G has the
/// sign that the scan before found there. Where this scan's sign differs by rounding, the interval from there
/// on is looked at.
template <class T>
void ExactSolver<T>::hand_on_signs(Search& search, const NodeSigns& signs, std::size_t lane,
                                   int turns) const {
  constexpr auto nodes = static_cast<std::size_t>(nodes_a_turn);
  const auto scanned = static_cast<std::size_t>(turns) * nodes;  // of all turns, the last node not counted
  const auto above_at = [&](std::size_t k) {
    return k < scanned ? is_above(signs, k / nodes, k % nodes, lane)
                       : is_above(signs, static_cast<std::size_t>(turns) - 1, nodes, lane);
  };
  const auto look_at = [&](std::size_t k, bool left) {
    const auto put = [&](IntervalBits& bits, bool value) {
      const std::uint64_t bit = std::uint64_t{1} << k % nodes;
      bits[k / nodes] = value ? bits[k / nodes] | bit : bits[k / nodes] & ~bit;
    };
    put(search.flags.looks, true), put(search.flags.falls, false);
    put(search.flags.above_left, left), put(search.flags.above_right, above_at(k + 1));
  };
  const bool first_above = search.last_above;
  search.last_above = above_at(scanned);
  const std::size_t k = search.node_past_release;
  search.node_past_release = 0;
  if (k == 0) {
    if (first_above != above_at(0)) look_at(0, first_above);
  } else if (!search.released_on_node) {
    if (!above_at(k)) look_at(k - 1, above_at(k - 1));
  } else if (k == scanned) {
    search.last_above = true;
  } else {
    search.flags.looks[(k - 1) / nodes] &= ~(std::uint64_t{1} << (k - 1) % nodes);
    if (!above_at(k)) look_at(k, true);
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
      const auto flagged = [&](const IntervalBits& bits) -> bool {
        return bits[static_cast<std::size_t>(search.turn)] >> search.node & 1u;
      };
      const S left_node = node * step, right_node = (node + S(1)) * step;
      const auto side = [](bool is_above) { return is_above ? Side::above : Side::below; };
      const bool falls = flagged(search.flags.falls) && from == left_node && to == right_node;
      interval = {design, turn, from, to, (from + to) * S(0.5), falls, Side::asked, Side::asked};
      if (falls) return true;
      if (from == search.release) {
        interval.from_side = Side::above;
      } else if (from == left_node) {
        interval.from_side = side(flagged(search.flags.above_left) || flagged(search.flags.falls));
      }
      if (to == right_node) interval.to_side = side(flagged(search.flags.above_right));
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
    const Roll<T> roll = rows_.template load_motion<T>(index.data());
    const CurvedSample<T> at_a = lift(roll, a), at_b = lift(roll, b);
    const auto is_up = [&](Side Interval::*side, const T& value) {
      LaneArray<T> sides;
      for (std::size_t i = 0; i < width; ++i)
        sides[i] = S(static_cast<int>(intervals_[first + (i < count ? i : 0)].*side));
      const T decided = Lanes<T>::load(sides.data());
      return (decided > T(0)) | ((decided == T(0)) & (value > T(0)));
    };
    const MaskOf<T> up_a = is_up(&Interval::from_side, at_a.value),
                    up_b = is_up(&Interval::to_side, at_b.value);
    const IntervalKind<T> kind = classify(at_a, at_b, up_a, up_b, lift_bounds(roll, turn), b - a);
    const unsigned falls = Lanes<T>::bits(kind.fall), unclear = Lanes<T>::bits(kind.unclear),
                   sinking = Lanes<T>::bits(up_a & !up_b);
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
    const Roll<T> roll = rows_.template load_motion<T>(index.data());
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
                  rows_.lift_offs.data(), index.data(), count);
    for (std::size_t i = 0; i < count; ++i) {
      Search& search = searches_[index[i]];
      Outcome& outcome = outcomes[index[i]];
      if (!std::isfinite(angles[i]) || !std::isfinite(spins[i]) || !std::isfinite(heights[i])) {
        outcome = failed_outcome("a lift-off could not be solved");
        continue;
      }
      // Between two falls so near each other the normal force rises by less than rounding: they are one.
      constexpr S one_fall = S(1e-6);
      if (outcome.candidates > 0 &&
          angles[i] - search.jump_angle < one_fall * std::max(S(1), std::abs(angles[i]))) {
        advance(search);
        still_searching_.push_back(index[i]);
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
    const Roll<T> roll = rows_.template load_motion<T>(index.data());
    const std::array<T, 8> row = load_rows<T>(rows_.lift_offs.data(), index.data());
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

#ifdef LEAPMAP_KERNELS
template class ExactSolver<Batch>;
#endif
#ifdef LEAPMAP_SCALARS
template class ExactSolver<double>;
template class ExactSolver<long double>;
#endif

}  // namespace leapmap
