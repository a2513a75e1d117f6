// SPDX-License-Identifier: GPL-3.0-or-later
/// Numbers of many items, those of one item together in memory, so that any items make up a batch at the cost
/// of a transposition.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "numerics/wide.hpp"

namespace leapmap {

/// Eight numbers of one item, together in memory.
template <class S>
using Row = std::array<S, 8>;

#ifdef __AVX512F__
/// Eight registers of eight numbers as a matrix, transposed.
template <class A>
void transpose(std::array<xsimd::batch<double, A>, 8>& m) {
  std::array<xsimd::batch<double, A>, 8> pairs, quads;
  for (std::size_t i = 0; i < 8; i += 2) {
    pairs[i] = _mm512_unpacklo_pd(m[i], m[i + 1]);
    pairs[i + 1] = _mm512_unpackhi_pd(m[i], m[i + 1]);
  }
  for (const std::size_t i : {0, 4})
    for (std::size_t j = 0; j < 2; ++j) {
      quads[i + j] = _mm512_shuffle_f64x2(pairs[i + j], pairs[i + j + 2], 0x88);
      quads[i + j + 2] = _mm512_shuffle_f64x2(pairs[i + j], pairs[i + j + 2], 0xdd);
    }
  for (std::size_t i = 0; i < 4; ++i) {
    m[i] = _mm512_shuffle_f64x2(quads[i], quads[i + 4], 0x88);
    m[i + 4] = _mm512_shuffle_f64x2(quads[i], quads[i + 4], 0xdd);
  }
}
#endif
#ifdef __AVX2__
/// Four registers of four.
template <class A>
void transpose(std::array<xsimd::batch<double, A>, 4>& m) {
  const __m256d even_low = _mm256_unpacklo_pd(m[0], m[1]), odd_low = _mm256_unpackhi_pd(m[0], m[1]),
                even_high = _mm256_unpacklo_pd(m[2], m[3]), odd_high = _mm256_unpackhi_pd(m[2], m[3]);
  m[0] = _mm256_permute2f128_pd(even_low, even_high, 0x20);
  m[1] = _mm256_permute2f128_pd(odd_low, odd_high, 0x20);
  m[2] = _mm256_permute2f128_pd(even_low, even_high, 0x31);
  m[3] = _mm256_permute2f128_pd(odd_low, odd_high, 0x31);
}
#endif

/// row_of(i) points to eight numbers for lane i of T. Column k has number k of every lane.
template <class T, class RowOf>
std::array<T, 8> columns_of(const RowOf& row_of) {
  std::array<T, 8> columns;
#ifdef __AVX2__
  constexpr std::size_t width = Lanes<Batch>::count;
  if constexpr (std::is_same_v<T, Batch>) {
    std::array<Batch, width> part;
    for (std::size_t first = 0; first < 8; first += width) {
      for (std::size_t i = 0; i < width; ++i) part[i] = Batch::load_unaligned(row_of(i) + first);
      transpose(part);
      for (std::size_t k = 0; k < width; ++k) columns[first + k] = part[k];
    }
    return columns;
  }
  if constexpr (std::is_same_v<T, Wide<Batch>>) {
    const auto low = columns_of<Batch>(row_of),
               high = columns_of<Batch>([&](std::size_t i) { return row_of(i + width); });
    for (std::size_t k = 0; k < 8; ++k) columns[k] = {low[k], high[k]};
    return columns;
  }
#endif
  for (std::size_t k = 0; k < 8; ++k) columns[k] = gathered<T>([&](std::size_t i) { return row_of(i)[k]; });
  return columns;
}

/// The rows of as many items as T has lanes. An item has `stride` rows.
template <class T, std::size_t stride = 1>
std::array<T, 8> load_rows(const Row<ScalarOf<T>>* rows, const std::uint32_t* index) {
  return columns_of<T>([&](std::size_t i) { return rows[stride * index[i]].data(); });
}

/// The reverse, for the first `count` lanes.
template <class T, std::size_t stride = 1>
void store_rows(std::array<T, 8> columns, Row<ScalarOf<T>>* rows, const std::uint32_t* index,
                std::size_t count) {
#ifdef __AVX2__
  constexpr std::size_t width = Lanes<Batch>::count;
  if constexpr (std::is_same_v<T, Batch>) {
    std::array<Batch, width> part;
    for (std::size_t first = 0; first < 8; first += width) {
      for (std::size_t k = 0; k < width; ++k) part[k] = columns[first + k];
      transpose(part);
      for (std::size_t i = 0; i < count; ++i) part[i].store_unaligned(rows[stride * index[i]].data() + first);
    }
    return;
  }
  if constexpr (std::is_same_v<T, Wide<Batch>>) {
    std::array<Batch, 8> low, high;
    for (std::size_t k = 0; k < 8; ++k) low[k] = columns[k].low, high[k] = columns[k].high;
    store_rows<Batch, stride>(low, rows, index, std::min(count, width));
    if (count > width) store_rows<Batch, stride>(high, rows, index + width, count - width);
    return;
  }
#endif
  std::array<ScalarOf<T>, Lanes<T>::count> lanes;
  for (std::size_t k = 0; k < 8; ++k) {
    Lanes<T>::store(columns[k], lanes.data());
    for (std::size_t i = 0; i < count; ++i) rows[stride * index[i]][k] = lanes[i];
  }
}

/// N numbers of each item, padded to whole rows.
template <class S, std::size_t N>
class PackedRows {
 public:
  explicit PackedRows(std::size_t items = 0) { resize(items); }
  void resize(std::size_t items) { rows_.resize(items * rows_an_item); }

  /// Puts lane i of the numbers into item index[i], for the first `count` lanes.
  template <class T>
  void store(const std::array<T, N>& numbers, const std::uint32_t* index, std::size_t count) {
    for (std::size_t r = 0; r < rows_an_item; ++r) {
      std::array<T, 8> row;
      for (std::size_t k = 0; k < 8; ++k) row[k] = 8 * r + k < N ? numbers[8 * r + k] : T(0);
      store_rows<T, rows_an_item>(row, rows_.data() + r, index, count);
    }
  }

  template <class T>
  std::array<T, N> load(const std::uint32_t* index) const {
    std::array<T, N> numbers;
    for (std::size_t r = 0; r < rows_an_item; ++r) {
      const std::array<T, 8> row = load_rows<T, rows_an_item>(rows_.data() + r, index);
      for (std::size_t k = 0; k < 8 && 8 * r + k < N; ++k) numbers[8 * r + k] = row[k];
    }
    return numbers;
  }

 private:
  static constexpr std::size_t rows_an_item = (N + 7) / 8;
  std::vector<Row<S>> rows_;
};

}  // namespace leapmap
