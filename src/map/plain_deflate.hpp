// SPDX-License-Identifier: GPL-3.0-or-later
/// Deflate's format (RFC 1951) for bytes in which there is nothing to search: runs of one byte, and noise.
/// Most of a shuffled column is either: the last digits of numbers, and NaN where a design has no answer. A
/// search through them takes longer than the designs did.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace leapmap {

/// Appends blocks to a stream, none of them the last one until `finish`.
class PlainDeflate {
 public:
  /// Writes from the beginning of `room`, and stops where there is no more of it.
  explicit PlainDeflate(std::span<std::byte> room) : room_(room) {}

  /// The bytes as they are, in stored blocks.
  void store(std::span<const std::byte> bytes);
  /// One byte `count` > 0 times, in a block of fixed codes.
  void repeat(std::byte value, std::size_t count);
  /// Fills up the last byte, so that another stream may follow.
  void align();
  /// An empty block as the last one.
  void finish();

  /// So far; all of it only if it `fits`.
  std::size_t size() const { return size_; }
  bool fits() const { return fits_; }

 private:
  void put(std::uint32_t bits, int count);
  void put_byte(std::uint32_t byte);
  void put_last_bits();

  std::span<std::byte> room_;
  std::size_t size_ = 0;
  bool fits_ = true;
  std::uint64_t bits_ = 0;  // not yet written, the first one lowest
  int waiting_ = 0;         // how many
};

/// A run of one byte, or the bytes between two runs.
struct BytePiece {
  std::span<const std::byte> bytes;
  bool is_run;
};

/// Divides bytes into runs and what is between them, in order.
void split_runs(std::span<const std::byte> bytes, std::vector<BytePiece>& pieces);

/// Whether bytes look like noise, which deflate takes long to pass on as it is. In samples of them an eighth
/// at most is the same as the byte before, and the others hold more than 7 bits a byte, so that none is
/// frequent. No row of them is the same as one before, however far.
bool is_noise(std::span<const std::byte> bytes);

}  // namespace leapmap
