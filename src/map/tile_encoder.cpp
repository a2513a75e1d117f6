// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/tile_encoder.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>
#include <functional>
#include <new>
#include <numeric>
#include <utility>

namespace leapmap {
namespace {

static_assert(std::endian::native == std::endian::little, "chunks are written as they lie in memory");

template <class T, class Row, class Value>
void gather_as(std::span<const Row> rows, std::byte* to, const Value& value) {
  for (const Row& row : rows) {
    const T stored = value(row);
    std::memcpy(to, &stored, sizeof stored);
    to += sizeof stored;
  }
}

EncodedChunk with_checksum(std::span<const std::byte> bytes, std::uint32_t skipped_filters) {
  const std::uint32_t checksum = fletcher32(bytes);
  const auto* first = reinterpret_cast<const std::byte*>(&checksum);
  EncodedChunk chunk{{}, skipped_filters};
  chunk.bytes.reserve(bytes.size() + sizeof checksum);
  chunk.bytes.assign(bytes.begin(), bytes.end());
  chunk.bytes.insert(chunk.bytes.end(), first, first + sizeof checksum);
  return chunk;
}

}  // namespace

std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  constexpr std::size_t most_words = 256;  // of which the weighted sum fits 32 bits: 256 * 257 / 2 * 65535
  // Modulo 65535, with 65535 for a multiple of it, as folding the carries back in leaves it.
  const auto folded = [](std::uint64_t sum) { return sum == 0 ? sum : (sum - 1) % 65535 + 1; };
  std::uint64_t sum = 0, sum_of_sums = 0;
  const std::size_t words = bytes.size() / 2;
  for (std::size_t first = 0; first < words; first += most_words) {
    const auto count = static_cast<std::uint32_t>(std::min(most_words, words - first));
    std::uint32_t plain = 0, weighted = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint16_t word = 0;
      std::memcpy(&word, bytes.data() + 2 * (first + i), sizeof word);
      const std::uint32_t high_first = (word & 0xffu) << 8 | word >> 8;
      plain += high_first;
      weighted += (count - i) * high_first;
    }
    sum_of_sums = folded(sum_of_sums + count * sum + weighted);
    sum = folded(sum + plain);
  }
  if (bytes.size() % 2 != 0) {
    sum = folded(sum + (std::to_integer<std::uint64_t>(bytes.back()) << 8));
    sum_of_sums = folded(sum_of_sums + sum);
  }
  return static_cast<std::uint32_t>(sum_of_sums << 16 | sum);
}

void TileEncoder::Free::operator()(libdeflate_compressor* compressor) const {
  libdeflate_free_compressor(compressor);
}

TileEncoder::TileEncoder(const MapLayout& layout, const Tiling& tiling) : layout_(&layout), tiling_(&tiling) {
  const std::vector<std::size_t>& shape = tiling.tile_shape();
  const std::size_t most = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  for (const Field* field : layout.fields) columns_.emplace_back(most * value_bytes(layout, *field));
  if (layout.compression == 0) return;
  compressor_.reset(libdeflate_alloc_compressor(layout.compression));
  if (!compressor_) throw std::bad_alloc();
}

void TileEncoder::take(std::size_t first, std::span<const Outcome> outcomes, const ColumnOf& column) {
  for (const Outcome& outcome : outcomes) ++statuses_[static_cast<std::size_t>(outcome.status)];
  constexpr std::size_t block = 128;  // outcomes that stay in the first cache for all fields
  for (std::size_t from = 0; from < outcomes.size(); from += block) {
    const auto some = outcomes.subspan(from, std::min(block, outcomes.size() - from));
    for (std::size_t f = 0; f < columns_.size(); ++f) {
      const Field& field = *layout_->fields[f];
      const std::size_t size = value_bytes(*layout_, field);
      assert((first + from + some.size()) * size <= columns_[f].size());
      std::byte* to = columns_[f].data() + (first + from) * size;
      if (const auto* code = std::get_if<Code>(&field.source); code && !code->value) {
        gather_as<std::uint8_t>(column(field).subspan(from, some.size()), to,
                                [](double value) { return static_cast<std::uint8_t>(value); });
        continue;
      } else if (code) {
        gather_as<std::uint8_t>(some, to, code->value);
        continue;
      }
      if (const auto* word = std::get_if<Word>(&field.source)) {
        gather_as<std::uint64_t>(some, to, [&](const Outcome& o) { return o.*word->member; });
        continue;
      }
      const auto gather = [&](const auto& values, const auto& value) {
        using Row = std::decay_t<decltype(values[0])>;
        is_single(*layout_, field)
            ? gather_as<float>(values, to, [&](const Row& row) { return static_cast<float>(value(row)); })
            : gather_as<double>(values, to, value);
      };
      if (const auto* quantity = std::get_if<Quantity>(&field.source))
        gather(some, [&](const Outcome& outcome) { return outcome.*quantity->member; });
      else if (const auto* later = std::get_if<OfJump>(&field.source))
        gather(some, [&](const Outcome& outcome) { return later->number.of(outcome); });
      else
        gather(column(field).subspan(from, some.size()), [](double value) { return value; });
    }
  }
}

EncodedTile TileEncoder::encode(std::size_t number) {
  const Tile tile = tiling_->tile(number);
  EncodedTile encoded;
  encoded.number = number;
  encoded.statuses = std::exchange(statuses_, {});
  assert(designs_in(encoded.statuses) == tile.count);
  for (std::size_t f = 0; f < columns_.size(); ++f)
    encoded.chunks.push_back(filtered(spread(tile, f), value_bytes(*layout_, *layout_->fields[f])));
  return encoded;
}

/// A field's values where they belong in the chunk, which is larger than a tile cut short by the map's edge.
std::span<const std::byte> TileEncoder::spread(const Tile& tile, std::size_t field) {
  const std::vector<std::size_t>& shape = tiling_->tile_shape();
  if (tile.extent == shape) return columns_[field];
  const std::size_t size = value_bytes(*layout_, *layout_->fields[field]);
  const std::size_t row = tile.extent.back() * size;
  chunk_.resize(columns_[field].size());
  const void* fill = fill_value(*layout_, *layout_->fields[field]);
  for (std::size_t i = 0; i < chunk_.size(); i += size) std::memcpy(chunk_.data() + i, fill, size);
  std::vector<std::size_t> position;
  for (std::size_t first = 0; first < tile.count; first += tile.extent.back()) {
    unravel(first, tile.extent, position);
    std::size_t place = 0;
    for (std::size_t k = 0; k < shape.size(); ++k) place = place * shape[k] + position[k];
    std::memcpy(chunk_.data() + place * size, columns_[field].data() + first * size, row);
  }
  return chunk_;
}

/// HDF5's filters: first bytes of equal rank together (for values of more than one byte), then zlib's format,
/// then the checksum.
EncodedChunk TileEncoder::filtered(std::span<const std::byte> values, std::size_t size) {
  if (!compressor_) return with_checksum(values, 0);
  const bool shuffles = size > 1;
  if (shuffles) {
    shuffled_.resize(values.size());
    const std::size_t count = values.size() / size;
    for (std::size_t rank = 0; rank < size; ++rank)
      for (std::size_t i = 0; i < count; ++i) shuffled_[rank * count + i] = values[i * size + rank];
    values = shuffled_;
  }
  const std::size_t packed = pack(values, values.size() / size);
  if (packed == 0) return with_checksum(values, shuffles ? 2u : 1u);  // it would not get smaller
  return with_checksum(std::span(packed_).first(packed), 0);
}

/// Fills packed_ with zlib's format of the values, and returns its length, 0 if that is no shorter. Planes of
/// noise and runs at the beginning, as the last digits of numbers are, are written without a search.
std::size_t TileEncoder::pack(std::span<const std::byte> values, std::size_t plane) {
  constexpr std::size_t head = 2, trailer = 4;
  packed_.resize(values.size());
  if (values.size() <= head + trailer) return 0;
  PlainDeflate plain(std::span<std::byte>(packed_).subspan(head, values.size() - head - trailer));
  std::size_t taken = 0;
  while (taken < values.size() && is_plain(values.subspan(taken, plane))) {
    for (const BytePiece& piece : pieces_)
      piece.is_run ? plain.repeat(piece.bytes[0], piece.bytes.size()) : plain.store(piece.bytes);
    taken += plane;
  }
  if (taken == 0)
    return libdeflate_zlib_compress(compressor_.get(), values.data(), values.size(), packed_.data(),
                                    packed_.size());
  taken < values.size() ? plain.align() : plain.finish();
  if (!plain.fits()) return 0;
  std::size_t written = head + plain.size();
  if (taken < values.size()) {
    const std::size_t rest =
        libdeflate_deflate_compress(compressor_.get(), values.data() + taken, values.size() - taken,
                                    packed_.data() + written, packed_.size() - written - trailer);
    if (rest == 0) return 0;
    written += rest;
  }
  const auto put = [&](std::size_t at, std::size_t byte) {
    packed_[at] = static_cast<std::byte>(byte & 255u);
  };
  put(0, 0x78), put(1, 0x01);  // deflate, a window of 32 kB, and a check of these two
  const std::uint32_t sum = libdeflate_adler32(1, values.data(), values.size());
  for (std::size_t i = 0; i < trailer; ++i) put(written + i, sum >> (24 - 8 * i));
  return written + trailer;
}

/// Splits a plane into pieces_. Returns whether what lies between its runs is noise, or next to nothing, and
/// the runs are few: each that is written by itself takes some eight bytes more than after a search.
bool TileEncoder::is_plain(std::span<const std::byte> plane) {
  split_runs(plane, pieces_);
  between_.clear();
  std::size_t runs = 0;
  for (const BytePiece& piece : pieces_) {
    runs += piece.is_run;
    if (!piece.is_run) between_.insert(between_.end(), piece.bytes.begin(), piece.bytes.end());
  }
  const bool are_few = 64 * runs <= between_.size() + plane.size() / 8;
  return are_few && (64 * between_.size() <= plane.size() || is_noise(between_));
}

}  // namespace leapmap
