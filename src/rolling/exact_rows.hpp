// SPDX-License-Identifier: GPL-3.0-or-later
/// What the stages of the exact solver pass on for each design of a block, in rows of eight numbers, so that
/// any designs make up a batch at the cost of a transposition.
#pragma once

#include <vector>

#include "rolling/rolling_time.hpp"

namespace leapmap {

/// What a row of lift_offs holds.
enum LiftOffRow { angle_of, spin_of, apex_of, last_apex_of, sunk_of, dip_of };

template <class T>
struct BlockRows {
  using S = ScalarOf<T>;

  /// Of each design: its hoop and level; its release; its last lift-off and the Ascent from it.
  std::vector<Row<S>> motions, releases, lift_offs;

  explicit BlockRows(std::size_t designs) : motions(designs), releases(designs), lift_offs(designs) {}

  void store(const Roll<T>& roll, const Quiet<T>& quiet, const std::uint32_t* index, std::size_t count) {
    const Hoop<T>& h = roll.hoop;
    const Trig<T>& phi = roll.release_trig;
    store_rows<T>({h.sin_slope, h.cos_slope, h.rho, h.clearance, h.Ic, h.J_min, roll.level, h.slope},
                  motions.data(), index, count);
    store_rows<T>({roll.release, phi.sin, phi.cos, phi.versine, roll.released, roll.push, quiet.vis_viva,
                   quiet.distance},
                  releases.data(), index, count);
  }

  /// Hoop and level only; U is T, or S for one design.
  template <class U>
  Roll<U> load_motion(const std::uint32_t* index) const {
    const std::array<U, 8> m = load_rows<U>(motions.data(), index);
    Roll<U> roll;
    roll.hoop = {m[7], m[0], m[1], m[2], m[3], m[4], m[5]};
    roll.level = m[6];
    return roll;
  }
  template <class U>
  Roll<U> load_roll(const std::uint32_t* index) const {
    Roll<U> roll = load_motion<U>(index);
    const std::array<U, 8> r = load_rows<U>(releases.data(), index);
    roll.release = r[0], roll.release_trig = {r[1], r[2], r[3]}, roll.released = r[4], roll.push = r[5];
    return roll;
  }
  Quiet<T> load_quiet(const std::uint32_t* index) const {
    const std::array<T, 8> r = load_rows<T>(releases.data(), index);
    return {r[6], r[7]};
  }
};

}  // namespace leapmap
