// SPDX-License-Identifier: GPL-3.0-or-later
/// Derivatives against central differences of the exact solver in long double.
#pragma once

#include <fmt/format.h>

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

/// An error is wrong if it is larger than allowed (1e-3 + |derivative|) and than the differences' own, which
/// two steps tell.
inline Comparison compare_with_differences(std::span<const Design> designs, const Scene& scene,
                                           std::span<const Outcome> outcomes, const Gradients& gradients,
                                           double allowed) {
  Comparison found;
  const Model& model = model_of(scene);
  const GradientWanted& wanted = gradients.wanted();
  for (std::size_t d = 0; d < designs.size(); ++d) {
    const Design& design = designs[d];
    if (outcomes[d].candidates == 0) continue;
    for (std::size_t j = 0; j < wanted.by.size(); ++j) {
      const auto member = differentiable[wanted.by[j]];
      const bool follows = std::isnan(design.mu_kinetic);
      if (member == &Design::mu_kinetic && follows) continue;
      const double x = design.*member, h = 1e-5 * std::max(1.0, std::abs(x));
      Outcome beside[4];
      bool same = true;
      for (int k = 0; k < 4; ++k) {
        Design moved = design;
        moved.*member = x + (k % 2 == 0 ? h : -h) * (k < 2 ? 1.0 : 2.0);
        const bool kink = !follows && moved.mu_static < moved.mu_kinetic;
        same = same && is_allowed(moved, scene) && !kink;
        if (!same) break;
        beside[k] = model.refined(moved, scene);
        same = same_flags(beside[k], outcomes[d]);
      }
      if (!same) {
        ++found.undecided;
        continue;
      }
      for (std::size_t i = 0; i < wanted.of.size(); ++i) {
        const auto of = wanted.of[i];
        if (std::isnan(of.of(outcomes[d]))) continue;
        const double near = (of.of(beside[0]) - of.of(beside[1])) / (2.0 * h),
                     far = (of.of(beside[2]) - of.of(beside[3])) / (4.0 * h),
                     truth = (4.0 * near - far) / 3.0;
        const double ours = gradients.column(i, j)[d], error = std::abs(ours - truth);
        const std::string where =
            fmt::format("design {}, quantity {} by parameter {}: {} for {}", d, i, j, ours, truth);
        ++found.compared;
        if (std::isnan(ours)) {
          if (found.missing++ == 0) found.first_missing = where;
        } else if (error > allowed * (1e-3 + std::abs(truth)) && error > std::abs(near - far)) {
          if (found.wrong++ == 0) found.first_wrong = where;
        }
      }
    }
  }
  return found;
}

}  // namespace leapmap::testing
