// SPDX-License-Identifier: GPL-3.0-or-later
/// One rolling phase by its energy integral: where friction is used up, or the runway is, and where the hoop
/// turns round on the way.
#pragma once

#include <functional>

#include "friction/rolling_walk.hpp"
#include "numerics/spectral.hpp"

namespace leapmap {

template <class S>
class RollingLeg {
 public:
  /// Times will be good to the tolerance, relative, or to some roundings.
  explicit RollingLeg(double tolerance);

  using Told = std::function<void(const ContactState<S>&)>;

  /// Rolls on from a state without slip to the phase's end. turns, if set, is told where it turns round.
  /// Forces depend on the angle alone, so that a hoop that has turned twice has seen all there is to see.
  PhaseEnd run(const Hoop<S>& hoop, const S& mu_static, ContactState<S>& at, const S& runway,
               const Told& turns = {}) const;

 private:
  static constexpr std::size_t nodes = 24;

  LegEnd<S> first_end(const Roll<S>& roll, const Roll<S>& begin, const S& mu_static, const S& last) const;
  S duration_to_rest(const Roll<S>& roll, const S& length) const;
  S duration_near_rest(const Roll<S>& roll, const S& length) const;
  S duration(const Roll<S>& roll, const S& length) const;
  /// enough: an error that does not matter.
  S duration(const Roll<S>& roll, const S& shift, const S& from, const S& to, const S& enough, int halvings,
             int& panels) const;

  S tolerance_;
  SpectralPanel<S, nodes> panel_;
  RollingWalk<S> walk_;
};

}  // namespace leapmap
