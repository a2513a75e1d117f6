// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/rows.hpp"

#include <gtest/gtest.h>

namespace leapmap {
namespace {

TEST(Rows, ComeBackAsColumnsWhateverTheirOrder) {
  std::array<Row<double>, 20> rows;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < 8; ++k) rows[i][k] = static_cast<double>(10 * i + k);
  std::array<std::uint32_t, batch_width> index;
  for (std::size_t i = 0; i < batch_width; ++i) index[i] = static_cast<std::uint32_t>((7 * i + 3) % 20);
  const auto columns = load_rows<Batch>(rows.data(), index.data());
  for (std::size_t k = 0; k < 8; ++k)
    for (std::size_t i = 0; i < batch_width; ++i)
      EXPECT_EQ(lanes_of(columns[k])[i], 10.0 * index[i] + static_cast<double>(k));

  std::array<Row<double>, 20> copy{};
  store_rows(columns, copy.data(), index.data(), batch_width - 1);
  for (std::size_t i = 0; i + 1 < batch_width; ++i) EXPECT_EQ(copy[index[i]], rows[index[i]]);
  EXPECT_EQ(copy[index[batch_width - 1]], Row<double>{}) << "lanes to spare are not stored";
}

TEST(Rows, AnItemOfMoreThanEightNumbersComesBackWhole) {
  constexpr std::size_t numbers = 11, items = 20;
  PackedRows<double, numbers> packed(items);
  for (std::uint32_t item = 0; item < items; ++item) {
    std::array<double, numbers> values;
    for (std::size_t k = 0; k < numbers; ++k) values[k] = 100.0 * item + static_cast<double>(k);
    packed.store<double>(values, &item, 1);
  }
  std::array<std::uint32_t, batch_width> index;
  for (std::size_t i = 0; i < batch_width; ++i) index[i] = static_cast<std::uint32_t>((7 * i + 3) % items);
  std::array<Batch, numbers> loaded = packed.load<Batch>(index.data());
  for (std::size_t k = 0; k < numbers; ++k)
    for (std::size_t i = 0; i < batch_width; ++i)
      EXPECT_EQ(lanes_of(loaded[k])[i], 100.0 * index[i] + static_cast<double>(k));

  for (Batch& number : loaded) number = number + Batch(0.5);
  packed.store<Batch>(loaded, index.data(), batch_width - 1);
  const std::uint32_t last = index[batch_width - 1], first = index[0];
  EXPECT_EQ(packed.load<double>(&last)[numbers - 1], 100.0 * last + 10.0) << "lanes to spare are not stored";
  EXPECT_EQ(packed.load<double>(&first)[numbers - 1], 100.0 * first + (batch_width > 1 ? 10.5 : 10.0));
}

}  // namespace
}  // namespace leapmap
