// SPDX-License-Identifier: GPL-3.0-or-later
/// Numbers with units, as UDUNITS reads them: "60 mm", "300 rpm", "0.04 N m".
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "model/own_units.hpp"

namespace leapmap {

/// A number with or without a unit, in the unit `own` of leapmap's. Throws InputError, without what is
/// allowed, if the text is no number, its unit is unknown or of another kind, or it needs a mass that is not
/// known.
double number_in_own_unit(std::string_view text, std::string_view own, const Scales& scales);

/// A number with a unit, in the SI unit of leapmap's own unit `own`; nothing: it has no unit. Throws as
/// above.
std::optional<double> number_in_si(std::string_view text, const OwnUnit& own);

/// How many characters at the beginning of a text are a number: sign, digits, point, digits, exponent.
std::size_t length_of_number(std::string_view text);

/// How many of a unit are one of leapmap's own; nothing: it is of another kind, or needs a mass that is not
/// known. Throws InputError if UDUNITS does not know the unit.
std::optional<double> units_in_own(std::string_view unit, std::string_view own, const Scales& scales);

}  // namespace leapmap
