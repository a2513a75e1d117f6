// SPDX-License-Identifier: GPL-3.0-or-later
/// The rolling phases of many designs, as many at once as there are lanes.
///
/// A lane takes a phase that ends without turning round, at one place that its neighbours tell, and whose
/// time the panels resolve; any other is rolled by itself (coulomb/rolling_leg.hpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "coulomb/ended_phase.hpp"
#include "coulomb/rolling_leg.hpp"

namespace leapmap {

template <class T>
class RollingLanes {
 public:
  using S = ScalarOf<T>;

  /// tolerance: as of RollingLeg.
  explicit RollingLanes(double tolerance);

  /// Adds a phase to those that the passes to come roll.
  void begin(std::uint32_t place, const Hoop<S>& hoop, const S& mu_static, const ContactState<S>& at,
             const S& runway);
  std::size_t waiting() const { return waiting_.size(); }
  /// Rolls some, and adds them to `ended`.
  void pass(std::vector<EndedPhase<S>>& ended);

 private:
  static constexpr std::size_t width = Lanes<T>::count, nodes = 24;

  struct Phase {
    std::uint32_t place;
    Hoop<S> hoop;
    S mu_static;
    ContactState<S> at;
    S runway;
  };
  /// A phase whose end is known to lie between two angles, as seen on its leg.
  struct Bracketed {
    Phase phase;
    S way;
    Roll<S> roll;
    PhaseEnd end;
    S from, to;  ///< the same where the end is there
    S from_value, to_value;
  };
  bool bracket(const Phase& phase, Bracketed& found) const;
  void alone(const Phase& phase, std::vector<EndedPhase<S>>& ended) const;
  void roll(std::span<const Bracketed> phases, std::vector<EndedPhase<S>>& ended);
  /// How long it takes to roll so far. NaN: the panels do not resolve it.
  T duration(const Roll<T>& roll, const T& length) const;

  S tolerance_;
  RollingLeg<S> leg_;
  RollingWalk<S> walk_;
  SpectralPanel<T, nodes> panel_;
  std::vector<Phase> waiting_;
  std::vector<Bracketed> bracketed_;
};

}  // namespace leapmap
