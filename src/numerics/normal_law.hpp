// SPDX-License-Identifier: GPL-3.0-or-later
/// The normal law of mean 0 and deviation 1.
#pragma once

namespace leapmap {

/// How much of it lies below x.
double normal_share(double x);

/// Below which value a share of it lies; share: in (0, 1).
double normal_quantile(double share);

}  // namespace leapmap
