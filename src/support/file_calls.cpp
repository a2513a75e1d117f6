// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/file_calls.hpp"

#include <libdeflate.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "leapmap/errors.hpp"
#include "support/posix.hpp"

namespace leapmap {

struct stat status_of(int descriptor, const std::string& path) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) fail_with_errno(path, "cannot be read");
  return status;
}

void read_all(int descriptor, const std::string& path, std::uint64_t offset, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = uninterrupted(
        [&] { return ::pread(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset)); });
    if (count < 0) fail_with_errno(path, "cannot be read");
    if (count == 0) throw IoError(path + ": cannot be read: it is truncated");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

void write_all(int descriptor, const std::string& path, std::uint64_t offset,
               std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = uninterrupted(
        [&] { return ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(offset)); });
    if (count < 0) fail_with_errno(path, "cannot be written");
    if (count == 0) throw IoError(path + ": cannot be written: the system takes no bytes");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

void write_stream(int descriptor, const std::string& path, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = uninterrupted([&] { return ::write(descriptor, text.data(), text.size()); });
    if (count < 0) fail_with_errno(path, "cannot be written");
    if (count == 0) throw IoError(path + ": cannot be written: the system takes no bytes");
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

void cut(int descriptor, const std::string& path, std::uint64_t size) {
  if (uninterrupted([&] { return ::ftruncate(descriptor, static_cast<off_t>(size)); }) != 0)
    fail_with_errno(path, "cannot be written");
}

void sync(int descriptor, const std::string& path) {
  if (uninterrupted([&] { return ::fsync(descriptor); }) != 0)
    fail_with_errno(path, "cannot be synced to disk");
}

std::uint32_t checksum_of(int descriptor, const std::string& path, std::uint64_t begin, std::uint64_t end) {
  return checksum_of(begin, end, [&](std::uint64_t offset, std::span<std::byte> bytes) {
    read_all(descriptor, path, offset, bytes);
  });
}

std::uint32_t checksum_of(std::uint64_t begin, std::uint64_t end,
                          const std::function<void(std::uint64_t, std::span<std::byte>)>& read) {
  std::uint32_t sum = 0;
  std::vector<std::byte> block(std::min<std::uint64_t>(std::size_t{1} << 18, end - begin));
  for (std::uint64_t offset = begin; offset < end; offset += block.size()) {
    block.resize(std::min<std::uint64_t>(block.size(), end - offset));
    read(offset, block);
    sum = libdeflate_crc32(sum, block.data(), block.size());
  }
  return sum;
}

}  // namespace leapmap
