// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap hop --scatter: yield and distribution of one design as manufactured.
#pragma once

#include "cli/json.hpp"
#include "leapmap/scatter.hpp"

namespace leapmap::cli {

/// Yield, goals, quantities, a histogram, and the influence of each tolerance.
/// unit_words: as of --units.
void print_scatter(const Spec& spec, const ScatterReport& report, const std::string& unit_words);

/// The same as JSON, histograms of height and time with it.
Json scatter_json(const Spec& spec, const ScatterReport& report);

}  // namespace leapmap::cli
