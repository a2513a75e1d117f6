// SPDX-License-Identifier: GPL-3.0-or-later
/// How long many rolling phases take whose ends are known, a panel of as many at once as there are lanes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hoop/rolling_by_angle.hpp"
#include "numerics/rows.hpp"
#include "numerics/spectral.hpp"

namespace leapmap {

template <class T>
class TimedRolls {
 public:
  using S = ScalarOf<T>;
  static constexpr std::size_t width = Lanes<T>::count;
  using Places = std::array<std::uint32_t, width>;

  /// tolerance: relative, of times. most: places.
  TimedRolls(double tolerance, std::size_t most);

  /// Adds the phases of those lanes whose bits are set in `which`, to be timed from their rolls' releases
  /// over an angle x > 0 past them.
  void begin(const Roll<T>& rolls, const T& x, const Places& places, unsigned which);
  std::size_t waiting() const { return waiting_.size(); }
  void clear() { waiting_.clear(); }

  /// What a phase took; NaN: its panels cannot tell.
  struct Timed {
    std::uint32_t place;
    S duration;
  };
  /// Times some phases a panel further, and adds those that are through to `timed`.
  void pass(std::vector<Timed>& timed);

 private:
  static constexpr std::size_t nodes = 24;

  S tolerance_;
  SpectralPanel<T, nodes> panel_;
  std::vector<std::uint32_t> waiting_;  // places
  PackedRows<S, 8> motions_;            // PastRelease, by place
  PackedRows<S, 7> clocks_;  // shift; in q: the end, how far it is timed; time; a panel; how fine; thrust
};

}  // namespace leapmap
