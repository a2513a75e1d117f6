// SPDX-License-Identifier: GPL-3.0-or-later
/// Times from the release to angles, of all designs of a block in lanes.
///
/// A hoop that turned round rolls back from rest: the time up to the turn is what it takes from there back to
/// the release.
#pragma once

#include <vector>

#include "noslip/block.hpp"

namespace leapmap {

/// The time that a design takes from its release to an angle.
template <class S>
struct Reading {
  std::uint32_t design;  ///< of the block
  S angle;
  S time;  ///< NaN where it cannot be told: too near a stall
};

/// Designs whose angles lie in the same half-turn are timed together, for they have the panels of RollingTime
/// in common, those that need about as many nodes side by side. Those that would need too many nodes are
/// timed one at a time.
template <class T>
class Clock {
 public:
  using S = ScalarOf<T>;

  /// Times will be good to the tolerance, relative, or to some roundings.
  explicit Clock(double tolerance) : time_(tolerance) {}

  /// Where the leg of each design begins.
  void start(const Block<T>& block, const DesignList& designs);

  /// Fills in the times. From one call to the next a design's angle must not fall.
  void read(const Block<T>& block, std::vector<Reading<S>>& readings);

  /// The same for one design at an angle of its leg, without start.
  S time(const Block<T>& block, std::uint32_t design, const S& angle) const;

 private:
  /// How far a design has been timed: to the angle `panel` pi.
  struct Dial {
    long panel;
    S time;
    S before;         ///< from the release to the beginning of the leg
    S needle, strip;  ///< of NodesNeeded
    int nodes;        ///< that its panels need; 0: it is timed by halving
  };
  struct Due {
    long panel;  ///< the half-turn in which the angle lies, from angle 0 on; 0 for all early ones
    int nodes;
    Reading<S>* reading;
  };
  /// As many readings in one half-turn as there are lanes; lanes to spare repeat the first.
  struct Together {
    std::size_t count;
    DesignLanes<T> designs;
    T to;
    NodesNeeded<T> needed;
    int nodes;
  };

  S halve(const Block<T>& block, std::uint32_t design, const S& angle) const {
    return time_.halving(block.template load_roll<S>(&design), angle);
  }
  LaneArray<T> before_legs(const Block<T>& block, const DesignLanes<T>& index, const Roll<T>& roll,
                           const Quiet<T>& quiet, const NodesNeeded<T>& needed, const T& span,
                           MaskOf<T> hard);
  S before_leg(const Block<T>& block, std::uint32_t design) const;
  NodesNeeded<T> needed_by(const DesignLanes<T>& designs) const;
  Together together(const std::vector<Due>& due, std::size_t first) const;
  template <class Item, class Key>
  void sort(std::vector<Item>& items, std::vector<Item>& sorted, const Key& key_of);
  void read_early(const Block<T>& block);
  void read_due(const Block<T>& block);

  RollingTime<T> time_;
  std::vector<Dial> dials_;
  DesignList designs_, sorted_designs_;
  std::vector<Due> early_, due_, sorted_;  // early: before the first panel's edge
  std::vector<std::uint32_t> places_;
};

}  // namespace leapmap
