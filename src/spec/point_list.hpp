// SPDX-License-Identifier: GPL-3.0-or-later
/// Designs one by one, from a CSV file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/own_units.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// Reads a list of designs. The header names parameters of a design; each line below holds one number for
/// each, in the parameter's own unit, in one written after it ("23 deg") or in that of the header
/// ("slope [deg]"); what stands in a column `label` names the design; origin, the spec's file, is for
/// messages. nominal: the scales of [hoop]'s nominal hoop. By them it reads the columns that hoops may share
/// in the SI, and adds their names to in_si. Throws InputError naming line and column, IoError if the file
/// cannot be read.
PointList read_points(const std::string& path, const std::string& origin, Scales scales,
                      const std::optional<Scales>& nominal, std::vector<std::string>& in_si);

}  // namespace leapmap
