// SPDX-License-Identifier: GPL-3.0-or-later
/// From a recording to a film: where its points are on the hoop, its unit, its axes, and when the hoop is
/// released.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "leapmap/fit.hpp"

namespace leapmap {

/// What a recording is, given the hoop that was filmed; notes say how it was understood, a line each.
/// Throws InputError for a track without a known place on the hoop, positions that do not fit its size, and
/// options without effect.
Film place_film(const Recording& recording, const Spec& spec, const MeasurementOptions& options,
                std::vector<std::string>& notes);

/// Throws InputError: the name of what is to be free is neither a parameter nor a number of the camera.
[[noreturn]] void refuse_free_name(const std::string& name);

/// How long a film shows the hoop held before the release: the time at which it leaves its place for good, or
/// nothing: it moves from the first frames on.
std::optional<double> leaves_at(const Film& film, double slope, double second);

}  // namespace leapmap
