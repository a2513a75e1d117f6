// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "leapmap/errors.hpp"

namespace leapmap {
namespace {

std::vector<std::string> split(std::string_view line, const std::string& place) {
  std::vector<std::string> cells;
  const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
  for (;;) {
    std::string cell;
    skip_blanks();
    if (line.starts_with('"')) {
      for (bool inside = true; inside;) {
        line.remove_prefix(1);
        const std::size_t quote = line.find('"');
        if (quote == std::string_view::npos)
          throw InputError(place + ": a quote without an end; allowed: cells that end on their line");
        cell += line.substr(0, quote);
        line.remove_prefix(quote + 1);
        inside = line.starts_with('"');
        if (inside) cell += '"';
      }
      skip_blanks();
      if (!line.empty() && line.front() != ',')
        throw InputError(place + ": text after a quoted cell; allowed: a comma, or the end of the line");
    } else {
      cell = line.substr(0, line.find(','));
      cell.erase(cell.find_last_not_of(" \t") + 1);
      line.remove_prefix(std::min(line.find(','), line.size()));
    }
    cells.push_back(std::move(cell));
    if (line.empty()) return cells;
    line.remove_prefix(1);
  }
}

}  // namespace

CsvFile::CsvFile(const std::string& path, const std::string& allowed) : path_(path), file_(path, allowed) {
  if (!next_cells(header_)) return;
  for (const std::string& name : header_)
    if (std::ranges::count(header_, name) > 1)
      throw InputError(fmt::format("{}: column '{}' is there twice; allowed: once", place_, name));
}

bool CsvFile::next_cells(std::vector<std::string>& cells) {
  while (file_.next_line(line_)) {
    std::string_view text = line_;
    if (++number_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (text.find_first_not_of(" \t") == std::string_view::npos) continue;
    place_ = fmt::format("{}:{}", path_, number_);
    if (header_.empty() && text.starts_with('#')) text.remove_prefix(1);  // numpy.savetxt's header
    cells = split(text, place_);
    return true;
  }
  return false;
}

bool CsvFile::next(std::vector<std::string>& cells) {
  if (!next_cells(cells)) return false;
  if (cells.size() != header_.size())
    throw InputError(fmt::format("{}: {} values; allowed: {}, one for each column of the header", place_,
                                 cells.size(), header_.size()));
  return true;
}

}  // namespace leapmap
