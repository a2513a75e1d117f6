// SPDX-License-Identifier: GPL-3.0-or-later
/// A tile's outcomes as the chunks of the file: typed, shuffled, deflated and given a checksum. The expensive
/// half of writing, done by each thread for itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "leapmap/outcome.hpp"
#include "map/layout.hpp"
#include "map/plain_deflate.hpp"

struct libdeflate_compressor;

namespace leapmap {

/// One field's chunk, as HDF5's filters would have made it.
struct EncodedChunk {
  std::vector<std::byte> bytes;
  std::uint32_t skipped_filters = 0;  ///< bit i: the dataset's filter i was not applied, as it gained nothing
};

struct EncodedTile {
  std::size_t number = 0;
  std::vector<EncodedChunk> chunks;  ///< in the layout's order of fields
  StatusCounts statuses{};           ///< how many designs ended in each way

  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const EncodedChunk& chunk : chunks) sum += chunk.bytes.size();
    return sum;
  }
};

/// The checksum of HDF5's filter fletcher32: Fletcher's sums, modulo 65535, over 16-bit words, high byte
/// first.
std::uint32_t fletcher32(std::span<const std::byte> bytes);

/// Encodes tile after tile. One a thread.
class TileEncoder {
 public:
  /// Keeps references to both.
  TileEncoder(const MapLayout& layout, const Tiling& tiling);
  /// The values of a field that is no part of an outcome, of each design of a piece.
  using ColumnOf = std::function<std::span<const double>(const Field&)>;
  /// Takes a piece of a tile: its outcomes `first`, first + 1, ... and the columns of other fields that the
  /// layout has.
  void take(std::size_t first, std::span<const Outcome> outcomes, const ColumnOf& column = {});
  /// Encodes the tile whose outcomes were taken. What reaches over the map's edge holds fill values.
  EncodedTile encode(std::size_t number);

 private:
  struct Free {
    void operator()(libdeflate_compressor* compressor) const;
  };
  std::span<const std::byte> spread(const Tile& tile, std::size_t field);
  EncodedChunk filtered(std::span<const std::byte> values, std::size_t size);
  std::size_t pack(std::span<const std::byte> values, std::size_t plane);
  bool is_plain(std::span<const std::byte> plane);

  const MapLayout* layout_;
  const Tiling* tiling_;
  std::unique_ptr<libdeflate_compressor, Free> compressor_;
  std::vector<std::vector<std::byte>> columns_;  ///< a field's values each, in the tile's order
  StatusCounts statuses_{};                      ///< of what was taken
  std::vector<std::byte> chunk_, shuffled_, packed_;
  std::vector<BytePiece> pieces_;   ///< of the plane in hand
  std::vector<std::byte> between_;  ///< its bytes that are in no run
};

}  // namespace leapmap
