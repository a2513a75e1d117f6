// SPDX-License-Identifier: GPL-3.0-or-later
/// What every use of the system's calls has in common: interrupted calls are made again, and every failure is
/// told with the file and the reason.
#pragma once

#include <sys/stat.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace leapmap {

/// Makes a call again while a signal interrupts it, but not for ever: a file system that answers nothing but
/// EINTR is broken, and its error is told like any other.
template <class Call>
auto uninterrupted(const Call& call) {
  constexpr int most_trials = 100;
  auto result = call();
  for (int trial = 1; trial < most_trials && result == -1 && errno == EINTR; ++trial) result = call();
  return result;
}

/// Numbers that are others for any other file, and for the same file once it was changed. Empty: there is no
/// such file.
std::vector<std::int64_t> identity_of(const std::string& path);

/// Throws IoError with path, `what` and errno's reason.
[[noreturn]] void fail_with_errno(const std::string& path, std::string_view what);

/// Opens /dev/null in place of each of the descriptors 0 to 2 that is closed: a file opened later would take
/// its number, and what is printed would go into that file. False if that cannot be done.
bool open_standard_streams();

/// Brings the names in a folder to disk. False if that failed: they are there all the same. Folders that may
/// not be read, and file systems that cannot sync folders, are as good as it gets.
bool sync_folder(const std::string& folder);

/// Reads a text file from its beginning to its end. A device may go on for ever, and a file may be anything:
/// more than most_bytes, or a line longer than most_line, is refused before memory is filled with it.
class TextFile {
 public:
  static constexpr std::size_t most_line = std::size_t{1} << 24;

  /// Throws InputError, saying what is `allowed`, if there is no such file that may be read, IoError if the
  /// system fails.
  TextFile(const std::string& path, std::string_view allowed, std::size_t most_bytes);
  ~TextFile();
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  /// What the file begins with, up to so many bytes; it is read again by what follows.
  std::string_view peek(std::size_t bytes);
  /// The next line without its end; false after the last one. Throws InputError, and IoError also if the file
  /// ends before its size says, or changes meanwhile.
  bool next_line(std::string& line);
  /// All that was not read yet. Throws as next_line does.
  std::string rest();

 private:
  /// False at the end of the file.
  bool read_more();
  /// That a plain file ends where its size says.
  void check_end() const;

  std::string path_, allowed_;
  std::size_t most_bytes_, read_ = 0;
  struct stat opened_ {};
  bool ended_ = false;
  int descriptor_;
  std::string buffer_;
  std::size_t next_ = 0;  ///< the first character of buffer_ that was not handed out
};

}  // namespace leapmap
