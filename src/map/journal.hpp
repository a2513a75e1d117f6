// SPDX-License-Identifier: GPL-3.0-or-later
/// What may end a journaled file: a journal of writes that wait (a redo log), or the seal of a file that is
/// whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace leapmap {

/// A write that a commit has yet to make.
struct WaitingWrite {
  std::uint64_t offset;
  std::vector<std::byte> bytes;
};

struct Journal {
  std::uint64_t begin;  ///< where it begins in the file
  std::uint64_t size;   ///< of the file once the writes are made
  std::vector<WaitingWrite> writes;
};

/// Appends a journal at `begin` and brings it to disk. Throws IoError.
void write_journal(int descriptor, const std::string& path, std::uint64_t begin, std::uint64_t size,
                   std::span<const WaitingWrite> writes);
/// The whole journal that ends a file `stored` bytes long, if one does. Throws IoError, BrokenFile if its
/// checksum holds and it makes no sense.
std::optional<Journal> read_journal(int descriptor, const std::string& path, std::uint64_t stored);

/// A checksum of all the bytes before it, and of its own.
struct Seal {
  std::uint64_t size;  ///< of the file before the seal
  std::uint32_t checksum;
};

/// Seals a file `size` bytes long whose CRC-32 is `checksum`, and brings the seal to disk. Throws IoError.
Seal write_seal(int descriptor, const std::string& path, std::uint64_t size, std::uint32_t checksum);
/// The seal that ends a file `stored` bytes long, if one does; whether it holds is not looked at. Throws
/// IoError.
std::optional<Seal> read_seal(int descriptor, const std::string& path, std::uint64_t stored);
/// Whether the bytes are those that were sealed. Reads the whole file. Throws IoError.
bool holds(const Seal& seal, int descriptor, const std::string& path);

}  // namespace leapmap
