// SPDX-License-Identifier: GPL-3.0-or-later
/// Texts that come from files or users, as a terminal may show them and a shell takes them.
#pragma once

#include <string>
#include <string_view>

namespace leapmap {

/// The text with every control character and every byte that is not UTF-8 written as \x1b, so that no text
/// can give a terminal orders. `kept`: control characters that stay, for example "\n\t".
std::string printable(std::string_view text, std::string_view kept = "");

/// The text with the letters A to Z small; every other byte as it is.
std::string lower_case(std::string_view text);

/// The text without such characters at its ends.
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r");

/// A word as a shell takes it, in quotes where it needs them.
std::string shell_quoted(const std::string& word);

}  // namespace leapmap
