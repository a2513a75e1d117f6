// SPDX-License-Identifier: GPL-3.0-or-later
/// Suggestions for misspelled words.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace leapmap {

/// " (did you mean X?)", where X is the candidate that takes the fewest changes of letters, or nothing if
/// every candidate takes more than a third of the word's letters.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace leapmap
