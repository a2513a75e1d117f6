// SPDX-License-Identifier: GPL-3.0-or-later
/// What the library has of GSL, which a browser has not: the same points by GSL's own directions, which
/// sobol_directions.cpp reads off at build time, and the same law by Boost.
#include <bit>
#include <boost/math/special_functions/erf.hpp>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "numerics/normal_law.hpp"
#include "numerics/sobol_sequence.hpp"
#include "sobol_directions.hpp"

namespace leapmap {

/// In Gray code's order, as Antonov and Saleev have it: from one point to the next one direction changes.
std::vector<double> sobol_sequence(std::size_t dimensions, std::size_t count) {
  assert(dimensions >= 1 && dimensions <= most_sobol_dimensions && count <= std::size_t{1} << direction_bits);
  std::vector<double> points(dimensions * count);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::uint32_t digits = 0;
    for (std::size_t i = 1; i < count; ++i) {
      digits ^= sobol_directions[d][std::countr_zero(i)];
      points[i * dimensions + d] = std::ldexp(static_cast<double>(digits), -30);
    }
  }
  return points;
}

double normal_share(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double normal_quantile(double share) {
  using namespace boost::math::policies;
  // Messages of what cannot happen here would make the module a fifth larger.
  using Policy = policy<promote_double<false>, domain_error<ignore_error>, overflow_error<ignore_error>>;
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * share, Policy());
}

}  // namespace leapmap
