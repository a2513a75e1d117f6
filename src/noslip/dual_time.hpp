// SPDX-License-Identifier: GPL-3.0-or-later
/// The time that one design rolls, with its derivatives: over angles of rest on the way, too.
#pragma once

#include <span>

#include "hoop/rolling_by_angle.hpp"
#include "numerics/quadrature.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {

/// D: DesignDual, or RollingDual.
template <class D>
class DualTime {
 public:
  DualTime() : rule_(gauss_rule<double>(20)) {}

  /// From an angle and a spin to another angle, turning round at `turns`, in order, which are plain roots of
  /// the vis viva.
  D time(const Hoop<D>& hoop, const D& angle, const D& spin, std::span<const double> turns,
         const D& to) const;

 private:
  D past(const Roll<D>& roll, const D& length) const;

  GaussRule<double> rule_;
};

}  // namespace leapmap
