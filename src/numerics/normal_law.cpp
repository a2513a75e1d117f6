// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/normal_law.hpp"

#include <gsl/gsl_cdf.h>

namespace leapmap {

double normal_share(double x) { return gsl_cdf_ugaussian_P(x); }
double normal_quantile(double share) { return gsl_cdf_ugaussian_Pinv(share); }

}  // namespace leapmap
