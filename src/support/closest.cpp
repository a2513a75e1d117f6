// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/closest.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace leapmap {
namespace {

/// Number of letters to insert, remove, replace or swap with their neighbour (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = last;
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  constexpr std::size_t longest = 100;  // longer words are no misspelled names
  if (word.size() > longest) return {};
  std::size_t least = word.size() / 3 + 1;
  std::string_view closest;
  for (const std::string_view candidate : candidates)
    if (const std::size_t changes = distance(word, candidate); changes < least)
      least = changes, closest = candidate;
  return closest.empty() ? std::string() : " (did you mean " + std::string(closest) + "?)";
}

}  // namespace leapmap
