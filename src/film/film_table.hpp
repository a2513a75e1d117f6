// SPDX-License-Identifier: GPL-3.0-or-later
/// Tables of tracked points as laboratories export them: any delimiter, decimal commas, several header lines,
/// comments after # or %, a byte order mark, blank cells.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace leapmap {

struct FilmTable {
  std::string path{};
  char delimiter = ',';
  bool decimal_comma = false;
  std::vector<std::vector<std::string>> headers{};         ///< lines above the numbers, the names' last
  std::vector<std::vector<std::optional<double>>> rows{};  ///< nothing: a cell without a number
  std::vector<long> lines{};                               ///< the line number of each row

  std::size_t columns() const { return rows.empty() ? 0 : rows.front().size(); }
};

/// Reads a table. Throws InputError, with the line, for a cell that is neither a number nor a sign for a
/// missing one, for a row with another number of cells, and for a file that is no table; IoError.
FilmTable read_film_table(const std::string& path);

}  // namespace leapmap
