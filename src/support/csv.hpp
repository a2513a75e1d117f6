// SPDX-License-Identifier: GPL-3.0-or-later
/// Tables as comma-separated values.
#pragma once

#include <string>
#include <vector>

#include "support/posix.hpp"

namespace leapmap {

/// Reads a table with a header line by line, after RFC 4180: a quoted cell may hold commas, and quotes
/// written twice. Empty lines, a byte order mark and a '#' before the header count for nothing.
class CsvFile {
 public:
  /// Reads the header; a column there twice, and anything that is no table, throws InputError. allowed: what
  /// the file should be.
  CsvFile(const std::string& path, const std::string& allowed);

  const std::vector<std::string>& header() const { return header_; }  ///< empty: the file has no lines
  /// The next line's cells, as many as the header has; false after the last one.
  bool next(std::vector<std::string>& cells);
  /// "file:line" of what was read last.
  const std::string& place() const { return place_; }
  long line() const { return number_; }  ///< its number

 private:
  bool next_cells(std::vector<std::string>& cells);

  std::string path_;
  TextFile file_;
  long number_ = 0;
  std::string line_, place_;
  std::vector<std::string> header_;
};

}  // namespace leapmap
