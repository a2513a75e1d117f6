// SPDX-License-Identifier: GPL-3.0-or-later
/// Text for a terminal: lines of at most 80 columns.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace leapmap {

inline constexpr std::size_t terminal_width = 80;

/// Wraps each line of a text at spaces. Lines that begin with two spaces are examples and stay as they are.
/// The result ends with a newline unless it is empty.
std::string wrapped(std::string_view text);

/// An entry of a list: a name, and its meaning in a column beside it that begins at `column`.
std::string list_entry(std::string_view name, std::string_view meaning, std::size_t column);

}  // namespace leapmap
