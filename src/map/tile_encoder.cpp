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

void append_checksum(std::vector<std::byte>& bytes) {
  const std::uint32_t checksum = fletcher32(bytes);
  const auto* first = reinterpret_cast<const std::byte*>(&checksum);
  bytes.insert(bytes.end(), first, first + sizeof checksum);
}

/// Whether bytes look like noise, which deflate takes long to pass on as it is: samples of them hold more
/// than 7 bits a byte, so that none is frequent, and do not repeat what is before them.
bool is_noise(std::span<const std::byte> bytes) {
  constexpr std::size_t samples = 32, each = 64, all = samples * each;
  if (bytes.size() < 2 * all) return false;
  std::array<unsigned, 256> met{};
  unsigned repeated = 0;
  for (std::size_t s = 0; s < samples; ++s) {
    const auto some = bytes.subspan(s * (bytes.size() / samples), each + 1);
    for (std::size_t i = 1; i <= each; ++i)
      ++met[std::to_integer<std::size_t>(some[i])], repeated += some[i] == some[i - 1];
  }
  // Of n uniform bytes, pairs of equal ones are n (n - 1) / 512: with 7 bits a byte, twice as many.
  std::size_t pairs = 0;
  for (const std::size_t n : met) pairs += n * (n - 1) / 2;
  return pairs < all * (all - 1) / 256 && repeated < all / 64;
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
  for (std::size_t f = 0; f < columns_.size(); ++f) {
    encoded.chunks.push_back(deflate(spread(tile, f), value_bytes(*layout_, *layout_->fields[f])));
    append_checksum(encoded.chunks.back().bytes);
  }
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

/// HDF5's filters before the checksum: first bytes of equal rank together (for values of more than one byte),
/// then zlib's format.
EncodedChunk TileEncoder::deflate(std::span<const std::byte> values, std::size_t size) {
  if (!compressor_) return {{values.begin(), values.end()}};
  const bool shuffles = size > 1;
  if (shuffles) {
    shuffled_.resize(values.size());
    const std::size_t count = values.size() / size;
    for (std::size_t rank = 0; rank < size; ++rank)
      for (std::size_t i = 0; i < count; ++i) shuffled_[rank * count + i] = values[i * size + rank];
    values = shuffled_;
  }
  const std::size_t packed = pack(values, values.size() / size);
  if (packed == 0) return {{values.begin(), values.end()}, shuffles ? 2u : 1u};  // it would not get smaller
  return {{packed_.begin(), packed_.begin() + static_cast<std::ptrdiff_t>(packed)}};
}

/// Fills packed_ with zlib's format of the values, and returns its length, 0 if that is no shorter. Planes of
/// noise at the beginning, as the last digits of numbers are, become stored blocks.
std::size_t TileEncoder::pack(std::span<const std::byte> values, std::size_t plane) {
  constexpr std::size_t most_stored = 65535, trailer = 4;
  packed_.resize(values.size());
  std::size_t noise = 0;
  while (noise < values.size() && is_noise(values.subspan(noise, plane))) noise += plane;
  if (noise == 0)
    return libdeflate_zlib_compress(compressor_.get(), values.data(), values.size(), packed_.data(),
                                    packed_.size());
  const std::size_t blocks = (noise + most_stored - 1) / most_stored;
  if (noise + 5 * blocks + 2 + trailer >= values.size()) return 0;
  std::byte* to = packed_.data();
  const auto put = [&](std::size_t byte) { *to++ = static_cast<std::byte>(byte & 255u); };
  put(0x78), put(0x01);  // deflate, a window of 32 kB, and a check of these two
  for (std::size_t at = 0; at < noise;) {
    const std::size_t length = std::min(most_stored, noise - at);
    put(0), put(length), put(length >> 8), put(~length), put(~length >> 8);  // stored, and not the last block
    std::memcpy(to, values.data() + at, length);
    to += length, at += length;
  }
  const auto written = static_cast<std::size_t>(to - packed_.data());
  const std::size_t packed =
      libdeflate_deflate_compress(compressor_.get(), values.data() + noise, values.size() - noise, to,
                                  packed_.size() - written - trailer);
  if (packed == 0) return 0;
  to += packed;
  const std::uint32_t sum = libdeflate_adler32(1, values.data(), values.size());
  put(sum >> 24), put(sum >> 16), put(sum >> 8), put(sum);
  return written + packed + trailer;
}

}  // namespace leapmap
