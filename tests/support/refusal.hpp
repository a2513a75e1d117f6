// SPDX-License-Identifier: GPL-3.0-or-later
/// How whatever is refused is told.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace leapmap::testing {

inline const std::string accepted = "(accepted)";

/// One line, which has each of these words.
inline void expect_one_line(const std::string& line, const std::vector<const char*>& told) {
  EXPECT_NE(line, accepted);
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  for (const char* word : told) EXPECT_NE(line.find(word), std::string::npos) << line << " lacks " << word;
}

}  // namespace leapmap::testing
