// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/posix.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "leapmap/errors.hpp"

namespace leapmap {

std::vector<std::int64_t> identity_of(const std::string& path) {
  struct stat now {};
  if (::stat(path.c_str(), &now) != 0) return {};
  return {static_cast<std::int64_t>(now.st_dev),
          static_cast<std::int64_t>(now.st_ino),
          now.st_size,
          now.st_mtim.tv_sec,
          now.st_mtim.tv_nsec,
          now.st_ctim.tv_sec,
          now.st_ctim.tv_nsec};
}

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

TextFile::TextFile(const std::string& path, std::string_view allowed, std::size_t most_bytes)
    : path_(path),
      allowed_(allowed),
      most_bytes_(most_bytes),
      descriptor_(uninterrupted([&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); })) {
  const bool known = descriptor_ >= 0 && ::fstat(descriptor_, &opened_) == 0;
  const bool folder = known && S_ISDIR(opened_.st_mode);
  if (known && !folder) return;
  const int reason = folder ? EISDIR : errno;
  if (descriptor_ >= 0) ::close(descriptor_);
  constexpr std::array of_the_name{ENOENT, EACCES, EPERM, EISDIR, ENOTDIR, ENAMETOOLONG, ELOOP, ENXIO};
  const std::string what = fmt::format("{}: cannot be read: {}", path, std::strerror(reason));
  if (std::ranges::find(of_the_name, reason) == of_the_name.end()) throw IoError(what);
  throw InputError(fmt::format("{}; allowed: {}", what, allowed));
}

TextFile::~TextFile() { ::close(descriptor_); }  // nothing was written that its failure could lose

bool TextFile::read_more() {
  constexpr std::size_t block = std::size_t{1} << 16;
  if (ended_) return false;
  buffer_.erase(0, next_);
  next_ = 0;
  const std::size_t held = buffer_.size();
  buffer_.resize(held + block);
  const ssize_t count = uninterrupted([&] { return ::read(descriptor_, buffer_.data() + held, block); });
  buffer_.resize(held + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  if (count < 0) fail_with_errno(path_, "cannot be read");
  read_ += static_cast<std::size_t>(count);
  if (read_ > most_bytes_)
    throw InputError(fmt::format("{}: is longer than {} bytes; allowed: {}", path_, most_bytes_, allowed_));
  ended_ = count == 0;
  if (ended_) check_end();
  return count > 0;
}

void TextFile::check_end() const {
  struct stat now {};
  if (::fstat(descriptor_, &now) != 0) fail_with_errno(path_, "cannot be read");
  if (!S_ISREG(now.st_mode) || opened_.st_size == 0) return;  // of /proc no size is known
  if (now.st_size != opened_.st_size || now.st_mtim.tv_sec != opened_.st_mtim.tv_sec ||
      now.st_mtim.tv_nsec != opened_.st_mtim.tv_nsec)
    throw IoError(path_ + ": it changed while it was read");
  if (read_ != static_cast<std::size_t>(opened_.st_size))
    throw IoError(path_ + ": cannot be read: it is truncated");
}

std::string_view TextFile::peek(std::size_t bytes) {
  while (buffer_.size() - next_ < bytes && read_more()) {
  }
  return std::string_view(buffer_).substr(next_, bytes);
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
    if (buffer_.size() - next_ > most_line)
      throw InputError(
          fmt::format("{}: a line of more than {} bytes; allowed: {}", path_, most_line, allowed_));
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
