// SPDX-License-Identifier: GPL-3.0-or-later
/// The one reader of numbers: of flags, cells of a CSV file, texts in specs and in Python.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace leapmap {

/// A finite decimal number that is the whole text but for blanks around it; a sign may be a plus. Nothing:
/// the text is no such number ("nan", "inf", "0x10" and "+-1" are none).
std::optional<double> number_in(std::string_view text);

/// A number that TOML reads back as the same float, in as few digits as that takes.
std::string toml_number(double value);

}  // namespace leapmap
