// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/plain_deflate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>

namespace leapmap {
namespace {

/// Deflate's Huffman codes begin with their highest bit, and all else with its lowest.
constexpr std::uint32_t reversed(std::uint32_t code, int count) {
  std::uint32_t bits = 0;
  for (int i = 0; i < count; ++i) bits |= (code >> i & 1u) << (count - 1 - i);
  return bits;
}

struct HuffmanCode {
  std::uint32_t bits;
  int count;
};

/// RFC 1951, 3.2.6: the fixed code of a literal, of the end (256) or of a length.
constexpr HuffmanCode fixed_code(std::uint32_t symbol) {
  if (symbol < 144) return {reversed(0x30 + symbol, 8), 8};
  if (symbol < 256) return {reversed(0x190 + symbol - 144, 9), 9};
  if (symbol < 280) return {reversed(symbol - 256, 7), 7};
  return {reversed(0xc0 + symbol - 280, 8), 8};
}

constexpr std::uint32_t end_of_block = 256, stored = 0, fixed = 1;
constexpr std::size_t longest_match = 258, shortest_match = 3;

/// RFC 1951, 3.2.5: four lengths a number of further bits.
struct MatchLength {
  std::uint32_t symbol, further;
  int further_bits;
};
constexpr MatchLength match_length(std::size_t length) {
  if (length == longest_match) return {285, 0, 0};
  const auto past = static_cast<std::uint32_t>(length - shortest_match);
  if (past < 8) return {257 + past, 0, 0};
  const int further = std::bit_width(past) - 3;
  return {261 + 4 * static_cast<std::uint32_t>(further) + (past >> further & 3u),
          past & ((1u << further) - 1u), further};
}

}  // namespace

void PlainDeflate::put_byte(std::uint32_t byte) {
  fits_ = fits_ && size_ < room_.size();
  if (fits_) room_[size_++] = static_cast<std::byte>(byte & 255u);
}

void PlainDeflate::put(std::uint32_t bits, int count) {
  bits_ |= std::uint64_t{bits} << waiting_;
  for (waiting_ += count; waiting_ >= 8; waiting_ -= 8, bits_ >>= 8)
    put_byte(static_cast<std::uint32_t>(bits_));
}

void PlainDeflate::put_last_bits() {
  if (waiting_ > 0) put(0, 8 - waiting_);
}

void PlainDeflate::store(std::span<const std::byte> bytes) {
  constexpr std::size_t most = 65535;
  do {
    const auto some = bytes.first(std::min(most, bytes.size()));
    bytes = bytes.subspan(some.size());
    put(stored << 1, 3);
    put_last_bits();
    const auto length = static_cast<std::uint32_t>(some.size());
    put(length, 16), put(~length & 0xffffu, 16);
    fits_ = fits_ && some.size() <= room_.size() - size_;
    if (!fits_ || some.empty()) return;
    std::memcpy(room_.data() + size_, some.data(), some.size());
    size_ += some.size();
  } while (!bytes.empty());
}

void PlainDeflate::repeat(std::byte value, std::size_t count) {
  assert(count > 0);
  const auto code = [&](std::uint32_t symbol) {
    const auto [bits, length] = fixed_code(symbol);
    put(bits, length);
  };
  put(fixed << 1, 3);
  code(std::to_integer<std::uint32_t>(value));
  for (std::size_t left = count - 1; left > 0;) {
    if (left < shortest_match) {
      code(std::to_integer<std::uint32_t>(value));
      --left;
      continue;
    }
    const std::size_t length = std::min(left, longest_match);
    const MatchLength match = match_length(length);
    code(match.symbol), put(match.further, match.further_bits);
    put(0, 5);  // the byte before
    left -= length;
  }
  code(end_of_block);
}

void PlainDeflate::align() {
  if (waiting_ > 0) store({});
}

void PlainDeflate::finish() {
  put(1 | fixed << 1, 3);
  put(fixed_code(end_of_block).bits, fixed_code(end_of_block).count);
  put_last_bits();
}

namespace {

constexpr std::size_t word_bytes = sizeof(std::uint64_t);

std::uint64_t word_at(std::span<const std::byte> bytes, std::size_t place) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes.data() + place, word_bytes);
  return word;
}

bool is_one_byte(std::uint64_t word) { return word == std::rotl(word, 8); }

/// Whether words of the bytes occur again, at whatever distance: of places a step apart and of all places of
/// the last step, there are two at every distance.
bool repeats_itself(std::span<const std::byte> bytes) {
  constexpr std::size_t step = 128, slots = 16 * step;
  const std::size_t last = bytes.size() - word_bytes - step;  // where the last step begins
  std::array<std::uint8_t, slots> places{};                   // by a word's hash: of the last step, from 1
  const auto slot_of = [](std::uint64_t word) { return word * 0x9e3779b97f4a7c15u >> 53; };
  for (std::size_t k = 0; k < step; ++k)
    places[slot_of(word_at(bytes, last + k))] = static_cast<std::uint8_t>(k + 1);
  for (std::size_t place = 0; place < last; place += step) {
    const std::uint64_t word = word_at(bytes, place);
    const std::size_t k = places[slot_of(word)];
    if (k > 0 && word == word_at(bytes, last + k - 1) && !is_one_byte(word)) return true;
  }
  return false;
}

}  // namespace

void split_runs(std::span<const std::byte> bytes, std::vector<BytePiece>& pieces) {
  constexpr std::size_t least_run = 16;  // two changes of blocks take some ten bytes
  pieces.clear();
  std::size_t taken = 0;
  const auto take = [&](std::size_t end, bool is_run) {
    if (end > taken) pieces.push_back({bytes.subspan(taken, end - taken), is_run});
    taken = end;
  };
  for (std::size_t i = 0; i + word_bytes <= bytes.size();) {
    const std::uint64_t word = word_at(bytes, i);
    if (!is_one_byte(word)) {
      i += word_bytes;
      continue;
    }
    std::size_t begin = i, end = i + word_bytes;
    while (begin > taken && bytes[begin - 1] == bytes[i]) --begin;
    while (end + word_bytes <= bytes.size() && word_at(bytes, end) == word) end += word_bytes;
    while (end < bytes.size() && bytes[end] == bytes[i]) ++end;
    if (end - begin >= least_run) take(begin, false), take(end, true);
    i = end;
  }
  take(bytes.size(), false);
}

bool is_noise(std::span<const std::byte> bytes) {
  constexpr std::size_t most_samples = 32, each = 64;
  if (bytes.size() < 3 * each) return false;
  const std::size_t samples = std::min(most_samples, (bytes.size() - 1) / each), all = samples * each;
  std::array<unsigned, 256> met{};
  std::size_t repeated = 0;
  for (std::size_t s = 0; s < samples; ++s) {
    const auto some = bytes.subspan(s * (bytes.size() / samples), each + 1);
    for (std::size_t i = 1; i <= each; ++i) {
      const bool repeats = some[i] == some[i - 1];
      met[std::to_integer<std::size_t>(some[i])] += !repeats, repeated += repeats;
    }
  }
  // Of n uniform bytes, pairs of equal ones are n (n - 1) / 512: with 7 bits a byte, twice as many.
  const std::size_t others = all - repeated;
  std::size_t pairs = 0;
  for (const std::size_t n : met) pairs += n * (n - 1) / 2;
  return repeated <= all / 8 && pairs < others * (others - 1) / 256 && !repeats_itself(bytes);
}

}  // namespace leapmap
