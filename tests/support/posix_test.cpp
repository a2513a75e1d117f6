// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/posix.hpp"

#include <gtest/gtest.h>

#include "leapmap/errors.hpp"
#include "support/printable.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

TEST(TextFile, GivesEachLineOnceWhereverBlocksEnd) {
  const testing::TemporaryFolder folder;
  for (const std::size_t length : {0u, 1u, 65535u, 65536u, 65537u, 200000u}) {
    const std::string line(length, 'x');
    TextFile file(folder.write("text", line + "\n\nlast"), "");
    std::string read;
    EXPECT_TRUE(file.next_line(read));
    EXPECT_EQ(read, line);
    EXPECT_TRUE(file.next_line(read));
    EXPECT_EQ(read, "");
    EXPECT_TRUE(file.next_line(read));
    EXPECT_EQ(read, "last");
    EXPECT_FALSE(file.next_line(read));
  }
  EXPECT_EQ(TextFile(folder.write("text", "a\nb"), "").rest(), "a\nb");
}

TEST(TextFile, SaysWhatIsAllowedWhereThereIsNone) {
  const testing::TemporaryFolder folder;
  for (const std::string& name : {folder / "nowhere", folder / "."}) try {
      TextFile(name, "a spec");
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("allowed: a spec"), std::string::npos);
    }
}

TEST(Uninterrupted, MakesAnInterruptedCallAgainButNotForEver) {
  int calls = 0;
  EXPECT_EQ(uninterrupted([&] { return errno = EINTR, ++calls < 3 ? -1 : 7; }), 7);
  EXPECT_EQ(uninterrupted([&] { return errno = EINTR, ++calls, -1; }), -1);
  EXPECT_LT(calls, 1000);
}

TEST(Printable, LeavesNoControlCharacterAndNoByteThatIsNotUtf8) {
  EXPECT_EQ(printable("m\xc3\xbc \xe2\x82\xac"), "m\xc3\xbc \xe2\x82\xac");
  EXPECT_EQ(printable("a\x1b[2J\x7f\n"), "a\\x1b[2J\\x7f\\x0a");
  EXPECT_EQ(printable("a\nb\tc", "\n\t"), "a\nb\tc");
  EXPECT_EQ(printable("\xc2\x9bmore"), "\\xc2\\x9bmore") << "CSI of eight bits";
  EXPECT_EQ(printable("\x9b\xe2\x82"), "\\x9b\\xe2\\x82") << "cut short";
  EXPECT_EQ(printable(std::string_view("\0x", 2)), "\\x00x");
}

}  // namespace
}  // namespace leapmap
