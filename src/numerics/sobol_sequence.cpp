// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/sobol_sequence.hpp"

#include <gsl/gsl_qrng.h>

#include <cassert>
#include <memory>
#include <new>

namespace leapmap {

std::vector<double> sobol_sequence(std::size_t dimensions, std::size_t count) {
  assert(dimensions >= 1 && dimensions <= most_sobol_dimensions);
  const std::unique_ptr<gsl_qrng, void (*)(gsl_qrng*)> sequence(
      gsl_qrng_alloc(gsl_qrng_sobol, static_cast<unsigned>(dimensions)), gsl_qrng_free);
  if (!sequence) throw std::bad_alloc();
  std::vector<double> points(dimensions * count);  // GSL leaves out the first, which is zero
  for (std::size_t i = 1; i < count; ++i) gsl_qrng_get(sequence.get(), &points[i * dimensions]);
  return points;
}

}  // namespace leapmap
