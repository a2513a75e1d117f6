// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/plain_deflate.hpp"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include <memory>
#include <random>

namespace leapmap {
namespace {

using Bytes = std::vector<std::byte>;

/// What another library reads in a stream, which must be as long as that.
Bytes inflated(std::span<const std::byte> stream, std::size_t length) {
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> reader(
      libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  Bytes bytes(length);
  std::size_t read = 0;
  EXPECT_EQ(libdeflate_deflate_decompress(reader.get(), stream.data(), stream.size(), bytes.data(),
                                          bytes.size(), &read),
            LIBDEFLATE_SUCCESS);
  EXPECT_EQ(read, length);
  return bytes;
}

Bytes noise(std::size_t count, std::mt19937::result_type seed) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random() & 255u);
  return bytes;
}

TEST(PlainDeflate, ARunOfAnyByteAndAnyLengthIsReadAsItWas) {
  for (std::size_t length = 1; length <= 1100; ++length) {  // every code of a length, and several matches
    const auto value = static_cast<std::byte>(7 * length & 255u);
    Bytes room(length + 64);
    PlainDeflate stream(room);
    stream.repeat(value, length);
    stream.finish();
    ASSERT_TRUE(stream.fits());
    ASSERT_EQ(inflated(std::span(room).first(stream.size()), length), Bytes(length, value)) << length;
  }
  Bytes room(64);
  PlainDeflate longest(room);
  longest.repeat(std::byte{0}, 5000);
  EXPECT_LE(longest.size(), 40u) << "13 bits for every 258 bytes";
}

TEST(PlainDeflate, BlocksOfAllKindsFollowEachOther) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    Bytes all, room(400'000);
    PlainDeflate stream(room);
    for (std::size_t block = random() % 6; block-- > 0;) {
      if (random() % 2 == 0) {
        const Bytes some = noise(random() % (trial % 10 == 0 ? 70'000 : 100), random());  // 65,535 a block
        stream.store(some);
        all.insert(all.end(), some.begin(), some.end());
      } else {
        const std::size_t length = 1 + random() % 400;
        const auto value = static_cast<std::byte>(random() & 255u);
        stream.repeat(value, length);
        all.insert(all.end(), length, value);
      }
      if (random() % 3 == 0) stream.align();
    }
    stream.finish();
    ASSERT_TRUE(stream.fits());
    ASSERT_EQ(inflated(std::span(room).first(stream.size()), all.size()), all) << trial;
  }
}

TEST(PlainDeflate, TellsWhereThereIsNoMoreRoomAndWritesNothingBeyond) {
  const Bytes some = noise(100, 4);
  for (std::size_t size = 0; size < 113; ++size) {
    Bytes room(size + 1, std::byte{0x5a});
    PlainDeflate stream(std::span<std::byte>(room).first(size));
    stream.repeat(std::byte{1}, 300);
    stream.store(some);
    stream.finish();
    EXPECT_FALSE(stream.fits()) << size;
    EXPECT_LE(stream.size(), size);
    EXPECT_EQ(room.back(), std::byte{0x5a});
  }
}

TEST(PlainDeflate, SplitsRunsFromWhatIsBetweenThem) {
  std::mt19937 random(5);
  std::vector<BytePiece> pieces;
  for (int trial = 0; trial < 500; ++trial) {
    Bytes all;
    std::size_t in_runs = 0;
    for (std::size_t part = random() % 8; part-- > 0;) {
      const Bytes some = noise(random() % 50, random());
      all.insert(all.end(), some.begin(), some.end());
      const std::size_t length = random() % 80;
      all.insert(all.end(), length, static_cast<std::byte>(random() & 255u));
      if (length >= 16) in_runs += length;
    }
    split_runs(all, pieces);
    Bytes again;
    std::size_t found = 0;
    for (const BytePiece& piece : pieces) {
      ASSERT_FALSE(piece.bytes.empty());
      again.insert(again.end(), piece.bytes.begin(), piece.bytes.end());
      if (!piece.is_run) continue;
      found += piece.bytes.size();
      for (const std::byte byte : piece.bytes) ASSERT_EQ(byte, piece.bytes[0]);
    }
    ASSERT_EQ(again, all);
    ASSERT_GE(found, in_runs) << "a run grows where a neighbour is the same byte by chance";
  }
}

TEST(PlainDeflate, NoiseDiffersFromNumbersAndText) {
  for (const std::size_t size : {200u, 300u, 4096u, 100'000u}) {
    int found = 0;
    for (unsigned seed = 0; seed < 100; ++seed) found += is_noise(noise(size, seed));
    EXPECT_GE(found, 90) << size << ": a short sample of noise may look ordered";
    Bytes slow(size), few = noise(size, 1), repeats = noise(size, 2);
    for (std::size_t i = 0; i < size; ++i) {
      slow[i] = static_cast<std::byte>(i / 40 & 255u);
      few[i] &= std::byte{0x3f};  // six bits a byte
      if (i % 4 != 0) repeats[i] = repeats[i - 1];
    }
    EXPECT_FALSE(is_noise(slow)) << size;
    EXPECT_FALSE(is_noise(few)) << size;
    EXPECT_FALSE(is_noise(repeats)) << size;
  }
  EXPECT_FALSE(is_noise(noise(191, 1))) << "fewer than a sample needs";
}

TEST(PlainDeflate, RowsThatComeAgainAreNoNoiseHoweverLong) {
  std::mt19937 random(8);
  for (const std::size_t size : {2048u, 16384u}) {
    int found = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const Bytes row = noise(200 + random() % (size / 3), random());
      Bytes rows;
      while (rows.size() < size) rows.insert(rows.end(), row.begin(), row.end());
      rows.resize(size);
      found += is_noise(rows);
    }
    EXPECT_LE(found, 4) << size << ": two words may share a slot, and the first is forgotten";
  }
}

}  // namespace
}  // namespace leapmap
