// SPDX-License-Identifier: GPL-3.0-or-later
/// Tables as comma-separated values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "support/posix.hpp"

namespace leapmap {

/// Throws InputError, saying what it looks like, if a file that begins so is no text in UTF-8: a film, a
/// spreadsheet, UTF-16 and the like.
void refuse_other_form(const std::string& path, std::string_view head, std::string_view allowed);

/// A cell of such a table, in quotes if it has to be.
std::string csv_quoted(const std::string& text);

/// Reads a table with a header line by line, after RFC 4180: a quoted cell may hold commas, and quotes
/// written twice. Empty lines, a byte order mark and a '#' before the header count for nothing.
class CsvFile {
 public:
  /// Reads the header; a column there twice, and anything that is no table, throws InputError. allowed: what
  /// the file should be.
  CsvFile(const std::string& path, const std::string& allowed);

  const std::vector<std::string>& header() const { return header_; }
  /// The next line's cells, as many as the header has; false after the last one.
  bool next(std::vector<std::string>& cells);
  /// "file:line" of what was read last.
  const std::string& place() const { return place_; }
  long line() const { return number_; }  ///< its number

 private:
  void refuse_other_delimiter(std::string_view allowed) const;
  bool next_cells(std::vector<std::string>& cells);

  std::string path_;
  TextFile file_;
  long number_ = 0;
  std::string line_, place_;
  std::vector<std::string> header_;
};

}  // namespace leapmap
