// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "leapmap/errors.hpp"

namespace leapmap {
namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 30;
constexpr std::size_t most_cells = 256;  // more than any list has columns

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
          throw InputError(place + ": an unclosed quote; allowed: cells that end on their line");
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
    if (cells.size() == most_cells)
      throw InputError(
          fmt::format("{}: more than {} values; allowed: at most that number", place, most_cells));
    cells.push_back(std::move(cell));
    if (line.empty()) return cells;
    line.remove_prefix(1);
  }
}

}  // namespace

void refuse_other_form(const std::string& path, std::string_view head, std::string_view allowed) {
  const auto refuse = [&](std::string_view what) {
    throw InputError(fmt::format("{}: looks like {}; allowed: {}", path, what, allowed));
  };
  const auto at = [&](std::size_t place, std::string_view mark) {
    return head.substr(0, place + mark.size()).ends_with(mark) && head.size() >= place + mark.size();
  };
  const auto zeros_at = [&](std::size_t parity) {
    std::size_t zeros = 0;
    for (std::size_t i = parity; i < head.size(); i += 2) zeros += head[i] == '\0';
    return zeros;
  };
  const std::size_t even = zeros_at(0), odd = zeros_at(1);
  if (at(0, "\xff\xfe") || at(0, "\xfe\xff") ||
      (std::min(even, odd) == 0 && 4 * (even + odd) >= head.size() && head.size() >= 4))
    refuse("text in UTF-16: save it as UTF-8");
  const bool boxes = head.starts_with('\0');  // the length of its first box
  if ((boxes && (at(4, "ftyp") || at(4, "moov") || at(4, "mdat") || at(4, "wide") || at(4, "free"))) ||
      (at(0, "RIFF") && at(8, "AVI ")) || at(0, "\x1a\x45\xdf\xa3"))
    refuse("a video; leapmap reads coordinates of its markers over time");
  if (at(0, "PK\x03\x04"))
    refuse(head.find("opendocument.spreadsheet") != head.npos ? "a spreadsheet (ods): save it as CSV"
           : head.find("xl/") != head.npos || head.find("[Content_Types].xml") != head.npos
               ? "a spreadsheet (xlsx): save it as CSV"
               : "a zip archive");
  if (at(0, "\xd0\xcf\x11\xe0")) refuse("a spreadsheet (xls): save it as CSV");
  if (at(0, "\x89HDF")) refuse("an HDF5 file, which leapmap info reads");
  if (at(0, "<?xml")) refuse("XML");
  if (const auto zero = head.find('\0'); zero != head.npos)
    throw InputError(fmt::format("{}:{}: holds a byte 0; allowed: text, in UTF-8", path,
                                 1 + std::ranges::count(head.substr(0, zero), '\n')));
}

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

CsvFile::CsvFile(const std::string& path, const std::string& allowed)
    : path_(path), file_(path, allowed, most_bytes) {
  refuse_other_form(path, file_.peek(4096), allowed);
  if (!next_cells(header_)) throw InputError(fmt::format("{}: is empty; allowed: {}", path, allowed));
  refuse_other_delimiter(allowed);
  for (const std::string& name : header_)
    if (std::ranges::count(header_, name) > 1)
      throw InputError(fmt::format("{}: column '{}' appears twice; allowed: once", place_, name));
}

bool CsvFile::next_cells(std::vector<std::string>& cells) {
  while (file_.next_line(line_)) {
    std::string_view text = line_;
    if (++number_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (text.find_first_not_of(" \t") == std::string_view::npos) continue;
    place_ = fmt::format("{}:{}", path_, number_);
    if (text.find('\0') != std::string_view::npos)
      throw InputError(place_ + ": holds a byte 0; allowed: text, in UTF-8");
    if (header_.empty() && text.starts_with('#')) text.remove_prefix(1);  // numpy.savetxt's header
    cells = split(text, place_);
    return true;
  }
  return false;
}

/// Spreadsheets write semicolons where the comma is decimal, other programs tabs or blanks.
void CsvFile::refuse_other_delimiter(std::string_view allowed) const {
  if (header_.size() > 1) return;
  const std::string name_alone = header_[0].substr(0, header_[0].find(" ["));  // "slope [deg]" is one column
  for (const auto& [mark, name] : {std::pair{';', "semicolons"}, {'\t', "tabs"}, {' ', "blanks"}})
    if (name_alone.find(mark) != std::string::npos)
      throw InputError(
          fmt::format("{}: '{}' looks like columns separated by {}{}; allowed: commas between columns "
                      "and a point in numbers: {}",
                      place_, header_[0], name, mark == ';' ? ", perhaps with decimal commas" : "", allowed));
}

bool CsvFile::next(std::vector<std::string>& cells) {
  if (!next_cells(cells)) return false;
  if (cells.size() == 2 * header_.size() && header_.size() > 1)
    throw InputError(
        fmt::format("{}: {} values for {} columns, which looks like decimal commas; allowed: a "
                    "point in numbers, commas between them",
                    place_, cells.size(), header_.size()));
  if (cells.size() != header_.size())
    throw InputError(fmt::format("{}: {} values; allowed: {}, one for each column of the header", place_,
                                 cells.size(), header_.size()));
  return true;
}

}  // namespace leapmap
