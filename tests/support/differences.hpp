// SPDX-License-Identifier: GPL-3.0-or-later
/// Derivatives against central differences of the exact solver in long double.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap::testing {

struct Comparison {
  std::size_t compared = 0;
  std::size_t undecided = 0;  ///< designs and parameters beside a cliff, or at the end of a range
  std::size_t wrong = 0, missing = 0;
  std::string first_wrong, first_missing;
};

/// One design's outcomes beside it, one and two steps h either way along a parameter. False: some are of
/// another kind, or beyond a range.
inline bool outcomes_beside(const Design& design, const Scene& scene, double Design::*member, double h,
                            const Outcome& own, std::array<Outcome, 4>& beside) {
  for (int k = 0; k < 4; ++k) {
    Design moved = design;
    moved.*member += (k % 2 == 0 ? h : -h) * (k < 2 ? 1.0 : 2.0);
    const bool kink = !std::isnan(design.mu_kinetic) && moved.mu_static < moved.mu_kinetic;
    if (!is_allowed(moved, scene) || kink) return false;
    beside[static_cast<std::size_t>(k)] = model_of(scene).refined(moved, scene);
    if (!same_flags(beside[static_cast<std::size_t>(k)], own)) return false;
  }
  return true;
}

/// The quantity's derivative there, of fourth order, and how far two steps' differ.
struct Difference {
  double truth, doubt;
};
inline Difference difference_of(const OutcomeNumber& of, const std::array<Outcome, 4>& beside, double h) {
  const double near = (of.of(beside[0]) - of.of(beside[1])) / (2.0 * h),
               far = (of.of(beside[2]) - of.of(beside[3])) / (4.0 * h);
  return {(4.0 * near - far) / 3.0, std::abs(near - far)};
}

/// An error is wrong if it is larger than allowed (1e-3 + |derivative|) and than the differences' own, which
/// two steps tell, and if a second look by finer steps says so, too: phases beyond those that flags show may
/// change within the first ones.
inline Comparison compare_with_differences(std::span<const Design> designs, const Scene& scene,
                                           std::span<const Outcome> outcomes, const Gradients& gradients,
                                           double allowed) {
  constexpr double coarse = 1e-5, fine = 3e-7;
  Comparison found;
  const GradientWanted& wanted = gradients.wanted();
  for (std::size_t d = 0; d < designs.size(); ++d) {
    const Design& design = designs[d];
    if (outcomes[d].candidates == 0) continue;
    for (std::size_t j = 0; j < wanted.by.size(); ++j) {
      const auto member = differentiable[wanted.by[j]];
      if (member == &Design::mu_kinetic && std::isnan(design.mu_kinetic)) continue;
      const double size = std::max(1.0, std::abs(design.*member));
      std::array<Outcome, 4> beside, closer;
      if (!outcomes_beside(design, scene, member, coarse * size, outcomes[d], beside)) {
        ++found.undecided;
        continue;
      }
      for (const OutcomeNumber& of : wanted.of) {
        if (std::isnan(of.of(outcomes[d]))) continue;
        const double ours = gradients.column(of, member)[d];
        const auto is_wrong = [&](const Difference& at) {
          return std::abs(ours - at.truth) > std::max(allowed * (1e-3 + std::abs(at.truth)), at.doubt);
        };
        const Difference first = difference_of(of, beside, coarse * size);
        const std::string where = fmt::format("design {}, quantity {} by parameter {}: {} for {}", d, of.jump,
                                              j, ours, first.truth);
        ++found.compared;
        if (std::isnan(ours)) {
          if (found.missing++ == 0) found.first_missing = where;
        } else if (is_wrong(first) &&
                   (!outcomes_beside(design, scene, member, fine * size, outcomes[d], closer) ||
                    is_wrong(difference_of(of, closer, fine * size)))) {
          if (found.wrong++ == 0) found.first_wrong = where;
        }
      }
    }
  }
  return found;
}

}  // namespace leapmap::testing
