// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/posix.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <utility>

#include "leapmap/errors.hpp"
#include "support/number.hpp"
#include "support/output_file.hpp"
#include "support/printable.hpp"
#include "support/temporary_folder.hpp"

namespace leapmap {
namespace {

TEST(TextFile, GivesEachLineOnceWhereverBlocksEnd) {
  const testing::TemporaryFolder folder;
  for (const std::size_t length : {0u, 1u, 65535u, 65536u, 65537u, 200000u}) {
    const std::string line(length, 'x');
    TextFile file(folder.write("text", line + "\n\nlast"), "", 1 << 20);
    std::string read;
    EXPECT_TRUE(file.next_line(read));
    EXPECT_EQ(read, line);
    EXPECT_TRUE(file.next_line(read));
    EXPECT_EQ(read, "");
    EXPECT_TRUE(file.next_line(read));
    EXPECT_EQ(read, "last");
    EXPECT_FALSE(file.next_line(read));
  }
  EXPECT_EQ(TextFile(folder.write("text", "a\nb"), "", 3).rest(), "a\nb");
}

TEST(TextFile, SaysWhatIsAllowedWhereThereIsNone) {
  const testing::TemporaryFolder folder;
  for (const std::string& name : {folder / "nowhere", folder / "."}) try {
      TextFile(name, "a spec", 100);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("allowed: a spec"), std::string::npos);
    }
}

TEST(TextFile, TakesNoMoreThanIsAllowed) {
  const testing::TemporaryFolder folder;
  EXPECT_THROW(TextFile(folder.write("text", "abcd"), "", 3).rest(), InputError);
  EXPECT_THROW(TextFile("/dev/zero", "", 1 << 20).rest(), InputError);
  std::string line;
  TextFile zeros("/dev/zero", "", std::size_t{1} << 40);
  EXPECT_THROW(zeros.next_line(line), InputError) << "a line without an end";
}

TEST(TextFile, ThatEndsBeforeItsSizeSaysIsAnError) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.write("text", std::string(200'000, 'x'));
  TextFile file(path, "", 1 << 20);
  EXPECT_EQ(file.peek(10), "xxxxxxxxxx");
  std::filesystem::resize_file(path, 100'000);
  EXPECT_THROW(file.rest(), IoError);
  TextFile grows(path, "", 1 << 20);
  std::ofstream(path, std::ios::app) << "more";
  EXPECT_THROW(grows.rest(), IoError);
}

TEST(Numbers, AreDecimalFiniteAndTheWholeText) {
  for (const auto& [text, value] :
       {std::pair{"0.5", 0.5}, {" +1e3 ", 1e3}, {"-2", -2.0}, {".5", 0.5}, {"5.", 5.0}})
    EXPECT_EQ(number_in(text), value) << text;
  for (const char* text : {"", " ", "nan", "-inf", "1e999", "0x10", "+-1", "++1", "1 2", "1_000", "1,5"})
    EXPECT_FALSE(number_in(text)) << text;
}

TEST(Outputs, OfTwoNamesAreOneFileThereOrNot) {
  const testing::TemporaryFolder folder;
  const std::string file = folder / "x.csv";
  EXPECT_TRUE(same_file(file, folder / "./x.csv"));
  EXPECT_FALSE(same_file(file, folder / "y.csv"));
  std::filesystem::create_symlink("x.csv", folder / "link");
  EXPECT_TRUE(same_file(file, folder / "link")) << "dangling";
  folder.write("x.csv", "a");
  std::filesystem::create_hard_link(file, folder / "second");
  EXPECT_TRUE(same_file(file, folder / "second"));
  EXPECT_FALSE(same_file("/dev/null", "/dev/null")) << "what is written there is lost either way";
  std::filesystem::create_symlink("ring", folder / "ring");
  EXPECT_THROW(behind_links(folder / "ring"), InputError);
}

TEST(Outputs, ReplaceOnlyWhatIsOursAndKeepItsMode) {
  const testing::TemporaryFolder folder;
  const auto write = [&](const std::string& path, bool overwrite) {
    TextOutput("--csv", path, "a,b", overwrite).commit("a,b\n1,2\n");
  };
  const auto content = [](const std::string& path) { return TextFile(path, "", 1000).rest(); };
  const std::string notes = folder.write("notes", "mine");
  std::filesystem::permissions(notes, std::filesystem::perms{0600});
  EXPECT_THROW(write(notes, false), InputError);
  EXPECT_EQ(content(notes), "mine");
  std::filesystem::create_symlink("notes", folder / "link");
  write(folder / "link", true);
  EXPECT_EQ(content(notes), "a,b\n1,2\n");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(std::filesystem::status(notes).permissions(), std::filesystem::perms{0600});
  write(notes, false);  // it is ours now
  { const TextOutput never("--csv", folder / "never", "", false); }
  EXPECT_FALSE(std::filesystem::exists(folder / "never"));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator(folder / ".")) ++files;
  EXPECT_EQ(files, 2u) << "nothing temporary is left";
  EXPECT_THROW(write(folder / "nowhere/x", false), IoError);
  write("/dev/null", false);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
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
