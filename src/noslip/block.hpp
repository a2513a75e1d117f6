// SPDX-License-Identifier: GPL-3.0-or-later
/// What the stages of the exact solver pass on: of each design of a block its roll, its search and its last
/// lift-off.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "hoop/flight_search.hpp"
#include "hoop/rolling_by_angle.hpp"
#include "noslip/interval_search.hpp"
#include "noslip/rolling_time.hpp"
#include "numerics/rows.hpp"

namespace leapmap {

/// Designs of the block, by their place in it.
using DesignList = std::vector<std::uint32_t>;

/// The designs in the lanes of a batch; lanes to spare repeat the first.
template <class T>
using DesignLanes = std::array<std::uint32_t, Lanes<T>::count>;

template <class T>
DesignLanes<T> lanes_from(const DesignList& designs, std::size_t first) {
  DesignLanes<T> lanes;
  for (std::size_t i = 0; i < lanes.size(); ++i)
    lanes[i] = designs[first + i < designs.size() ? first + i : first];
  return lanes;
}

/// A lift-off and the flight from it, up to the apex.
template <class T>
struct TakenOff {
  T angle, spin;
  Ascent<T> ascent;  ///< its height is not kept
};

template <class T>
struct Block {
  using S = ScalarOf<T>;
  static constexpr std::size_t most_designs = 1024;
  static constexpr S none = std::numeric_limits<S>::quiet_NaN();

  /// The way of a design so far. Its first leg ends where it turns round, its second where it does again, its
  /// third where it set out: that is all there is to see. On each leg it is seen from the side where it rolls
  /// downhill (hoop/parameters.hpp), so that angles grow and the spin is above zero.
  struct Found {
    S turned_back;             ///< whole turns removed from the release angle; added back on output
    S release, released;       ///< angle, as seen on the first leg, and vis viva of the release
    S way;                     ///< 1, or -1 where the leg is uphill
    S travelled;               ///< before it set out, as seen on the first leg
    int leg = 1;               ///< 1 to 3
    bool turns = false;        ///< the leg ends in a turn, rather than at the runway's end
    S turn = S(0);             ///< the angle of the leg's end, if it turns
    S reach = S(0);            ///< from the release to where it turned first
    S first_angle = S(0);      ///< of the first lift-off
    S jump_angle = none;       ///< of the last one on this leg; NaN: there is none
    bool first_on_leg = true;  ///< the first one is on this leg, or there is none yet
    S first_time = S(0);       ///< else its time
    S jump_time = none;        ///< of the jump, from where the design set out, if it was asked for

    /// Whether the leg ends where the design set out: from rest it turns there a second time.
    bool returns() const { return leg == 3 || (leg == 2 && turns && released == S(0)); }
  };

  std::vector<IntervalSearch<S>> searches;
  std::vector<Found> found;
  DesignList searching;  ///< designs whose search is not over
  DesignList bouncing;   ///< designs that leave the plane at once after a landing

  /// Makes room for so many designs, where there is less.
  void make_room(std::size_t designs) {
    if (designs <= found.size()) return;
    searches.resize(designs);
    paths_.resize(designs), releases_.resize(designs), lift_offs_.resize(designs);
    found.resize(designs);  // last, as it tells that there is room
  }

  /// The lanes of U, T or WideOf<T>, here and below.
  template <class U>
  void store(const Roll<U>& roll, const Quiet<U>& quiet, const std::uint32_t* index, std::size_t count) {
    const Trig<U>& phi = roll.release_trig;
    std::array<U, 9> path = numbers_of(roll.hoop);
    path[drive] = roll.level;
    paths_.template store<U>(path, index, count);
    releases_.template store<U>({roll.release, phi.sin, phi.cos, phi.versine, roll.released, roll.push,
                                 quiet.vis_viva, quiet.distance},
                                index, count);
  }

  /// Hoop and level only, which all that depends on the angle alone is made of. U may also be S: one design.
  template <class U>
  Roll<U> load_path(const std::uint32_t* index) const {
    Roll<U> roll;
    roll.hoop = hoop_of(paths_.template load<U>(index));
    roll.level = std::exchange(roll.hoop.drive, roll.hoop.thrust - roll.hoop.sin_slope);
    return roll;
  }
  template <class U>
  Roll<U> load_roll(const std::uint32_t* index) const {
    Roll<U> roll = load_path<U>(index);
    const std::array<U, 8> r = releases_.template load<U>(index);
    roll.release = r[0], roll.release_trig = {r[1], r[2], r[3]}, roll.released = r[4], roll.push = r[5];
    return roll;
  }
  template <class U>
  Quiet<U> load_quiet(const std::uint32_t* index) const {
    const std::array<U, 8> r = releases_.template load<U>(index);
    return {r[6], r[7]};
  }

  template <class U>
  void store(const TakenOff<U>& off, const std::uint32_t* index, std::size_t count) {
    const Ascent<U>& ascent = off.ascent;
    lift_offs_.template store<U>(
        {off.angle, off.spin, ascent.apex, ascent.last_apex, ascent.sunk, ascent.dip}, index, count);
  }
  template <class U>
  TakenOff<U> load_lift_off(const std::uint32_t* index) const {
    const auto [angle, spin, apex, last_apex, sunk, dip] = lift_offs_.template load<U>(index);
    return {angle, spin, {U(0), apex, last_apex, sunk, dip}};
  }

 private:
  static constexpr std::size_t drive =
      6;  // of a hoop's numbers; it follows from others, and makes way for the level

  PackedRows<S, 9> paths_;
  PackedRows<S, 8> releases_;
  PackedRows<S, 6> lift_offs_;
};

}  // namespace leapmap
