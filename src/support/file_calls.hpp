// SPDX-License-Identifier: GPL-3.0-or-later
/// The system's calls on an open file, to their end: interrupted ones are made again, partial ones go on, and
/// every failure is an IoError with the file's path and the reason.
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace leapmap {

struct stat status_of(int descriptor, const std::string& path);
/// Fills all of `bytes`; an error as well if the file ends before.
void read_all(int descriptor, const std::string& path, std::uint64_t offset, std::span<std::byte> bytes);
void write_all(int descriptor, const std::string& path, std::uint64_t offset,
               std::span<const std::byte> bytes);
/// Writes to a device or a pipe, which has no places.
void write_stream(int descriptor, const std::string& path, std::string_view text);
/// Makes the file `size` bytes long.
void cut(int descriptor, const std::string& path, std::uint64_t size);
/// Returns once what was written is on disk.
void sync(int descriptor, const std::string& path);
/// CRC-32 of the bytes from begin to end.
std::uint32_t checksum_of(int descriptor, const std::string& path, std::uint64_t begin, std::uint64_t end);
/// The same of bytes that read(offset, bytes) fills in.
std::uint32_t checksum_of(std::uint64_t begin, std::uint64_t end,
                          const std::function<void(std::uint64_t, std::span<std::byte>)>& read);

}  // namespace leapmap
