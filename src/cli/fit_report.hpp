// SPDX-License-Identifier: GPL-3.0-or-later
/// What leapmap fit reports: parameters with errors, verdicts, and a table of residuals.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cli/json.hpp"
#include "cli/shown_units.hpp"
#include "leapmap/fit.hpp"

namespace leapmap::cli {

void print_fit(const Measurements& measured, const ModelFit& fit, ShownUnits& units);
/// Which model the data prefer, by Akaike's weights.
void print_preference(const FitReport& report);
/// How a film was read: notes, and the first rows of each series.
void print_as_read(const Measurements& measured);

Json fit_json(const ModelFit& fit);

inline constexpr std::string_view fit_csv_head = "t,quantity,unit,measured";
/// A line for each number measured: what it is, and what each model has in its place.
std::string fit_csv(const Measurements& measured, const FitReport& report);

}  // namespace leapmap::cli
