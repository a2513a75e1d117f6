// SPDX-License-Identifier: GPL-3.0-or-later
/// What the studies measure errors against.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// By what the right answer is known. The exact solver in long double has the digits, but a fault of the
/// method itself would be in it as well: gsl-rk8pd at 1e-13 in time has none of the method, and must agree.
enum class Witness {
  both,         ///< long double's digits; the integration agrees within its own error
  integration,  ///< the integration's: long double disagrees with it
  long_double   ///< long double's alone: the integration gives up, or is in doubt about itself
};
std::string_view name_of(Witness witness);

struct Truth {
  Outcome outcome;
  Witness witness = Witness::both;
};

/// The right answers for the designs.
std::vector<Truth> truths_of(std::span<const Design> designs, const Scene& scene);

/// What an outcome depends on with that friction.
std::vector<double Design::*> inputs_of(Friction friction);

/// The exact solver's answer in long double, to some roundings.
Outcome refined_outcome(const Design& design, const Scene& scene);

/// Whether two methods see the same of the whole sequence: flags, and how many jumps.
bool same_course(const Outcome& a, const Outcome& b);

/// The largest of the errors of heights, absolute [hoop diameters], and of times, relative. Of outcomes with
/// the same course.
double error_of(const Outcome& ours, const Outcome& right);

}  // namespace leapmap
