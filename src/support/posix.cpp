// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/posix.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "leapmap/errors.hpp"

namespace leapmap {

void fail_with_errno(const std::string& path, std::string_view what) {
  const int reason = errno;
  throw IoError(fmt::format("{}: {}: {}", path, what, std::strerror(reason)));
}

bool open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF && uninterrupted([] {
                                                            return ::open("/dev/null", O_RDWR);
                                                          }) != stream)  // the lowest number that is free
      return false;
  return true;
}

bool sync_folder(const std::string& folder) {
  const auto impossible = [] { return errno == EACCES || errno == EINVAL || errno == ENOTSUP; };
  const int descriptor =
      uninterrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
  if (descriptor < 0) return impossible();
  const bool synced = uninterrupted([&] { return ::fsync(descriptor); }) == 0 || impossible();
  return ::close(descriptor) == 0 && synced;
}

TextFile::TextFile(const std::string& path, std::string_view allowed)
    : path_(path), descriptor_(uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); })) {
  struct stat status {};
  const bool folder = descriptor_ >= 0 && ::fstat(descriptor_, &status) == 0 && S_ISDIR(status.st_mode);
  if (descriptor_ >= 0 && !folder) return;
  const int reason = folder ? EISDIR : errno;
  if (folder) ::close(descriptor_);
  constexpr std::array of_the_name{ENOENT, EACCES, EPERM, EISDIR, ENOTDIR, ENAMETOOLONG, ELOOP, ENXIO};
  const std::string what = fmt::format("{}: cannot be read: {}", path, std::strerror(reason));
  if (std::ranges::find(of_the_name, reason) == of_the_name.end()) throw IoError(what);
  throw InputError(fmt::format("{}; allowed: {}", what, allowed));
}

TextFile::~TextFile() { ::close(descriptor_); }  // nothing was written that its failure could lose

bool TextFile::read_more() {
  constexpr std::size_t block = std::size_t{1} << 16;
  buffer_.erase(0, next_);
  next_ = 0;
  const std::size_t held = buffer_.size();
  buffer_.resize(held + block);
  const ssize_t count = uninterrupted([&] { return ::read(descriptor_, buffer_.data() + held, block); });
  buffer_.resize(held + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  if (count < 0) fail_with_errno(path_, "cannot be read");
  return count > 0;
}

bool TextFile::next_line(std::string& line) {
  std::size_t searched = next_;
  for (;;) {
    const std::size_t end = buffer_.find('\n', searched);
    if (end != std::string::npos) {
      line.assign(buffer_, next_, end - next_);
      next_ = end + 1;
      return true;
    }
    searched = buffer_.size() - next_;  // read_more moves what is left to the front
    if (read_more()) continue;
    line.assign(buffer_, next_);
    const bool more = !line.empty();
    next_ = buffer_.size();
    return more;
  }
}

std::string TextFile::rest() {
  while (read_more()) {
  }
  return buffer_.substr(std::exchange(next_, buffer_.size()));
}

}  // namespace leapmap
