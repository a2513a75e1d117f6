// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>

#include "support/closest.hpp"
#include "support/wrapped.hpp"

namespace leapmap {
namespace {

TEST(Suggestion, IsTheCandidateWithTheFewestChangedLetters) {
  constexpr std::array<std::string_view, 4> candidates{"slope", "sweep", "mass_ratio", "offset_ratio"};
  EXPECT_EQ(did_you_mean("slpoe", candidates), " (did you mean slope?)") << "a swap is one change";
  EXPECT_EQ(did_you_mean("swep", candidates), " (did you mean sweep?)");
  EXPECT_EQ(did_you_mean("mas_ratio", candidates), " (did you mean mass_ratio?)");
}

TEST(Suggestion, IsMissingIfNoCandidateResemblesTheWord) {
  constexpr std::array<std::string_view, 2> candidates{"slope", "sweep"};
  EXPECT_EQ(did_you_mean("friction", candidates), "");
  EXPECT_EQ(did_you_mean("", candidates), "");
  EXPECT_EQ(did_you_mean(std::string(100'000, 's'), candidates), "");
}

TEST(WrappedText, HasNoLineOverEightyColumnsAndLosesNoWord) {
  std::string text, words;
  for (int i = 0; i < 200; ++i) words += "word" + std::to_string(i * i * i) + (i % 7 == 0 ? "\n" : " ");
  text = wrapped(words);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    EXPECT_LE(end - begin, terminal_width);
    begin = end + 1;
  }
  const auto without_spaces = [](std::string from) {
    std::erase_if(from, [](char c) { return c == ' ' || c == '\n'; });
    return from;
  };
  EXPECT_EQ(without_spaces(text), without_spaces(words));
}

TEST(WrappedText, LeavesExamplesAsTheyAre) {
  const std::string example = "  leapmap sweep " + std::string(90, 'x');
  EXPECT_EQ(wrapped("An example:\n" + example), "An example:\n" + example + "\n");
}

TEST(ListEntry, PutsTheMeaningInItsColumn) {
  EXPECT_EQ(list_entry("  --slope", "of the plane", 14), "  --slope     of the plane\n");
  EXPECT_EQ(list_entry("  --offset-ratio", "L / R", 14), "  --offset-ratio\n              L / R\n");
}

}  // namespace
}  // namespace leapmap
