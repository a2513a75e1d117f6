// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "leapmap/errors.hpp"
#include "support/csv.hpp"
#include "support/number.hpp"
#include "support/posix.hpp"
#include "support/printable.hpp"

namespace leapmap {
namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 30;
constexpr std::string_view a_table =
    "a table of tracked points over time: Tracker, DLTdv, DeepLabCut, Kinovea, an encoder's log, or CSV";

struct Line {
  long number;
  std::string text;
  bool is_comment;
};

constexpr std::string_view blanks = " \r\t\"";

/// Lines that are not blank; of comments the text after their mark.
std::vector<Line> read_lines(const std::string& path) {
  TextFile file(path, a_table, most_bytes);
  refuse_other_form(path, file.peek(4096), a_table);
  std::vector<Line> lines;
  std::string line;
  for (long number = 1; file.next_line(line); ++number) {
    std::string_view text = line;
    if (number == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (trimmed(text, blanks).empty()) continue;
    const std::size_t mark = text.find_first_not_of(" \t");
    const bool is_comment = text[mark] == '#' || text[mark] == '%';
    if (is_comment) text.remove_prefix(mark + 1);
    lines.push_back({number, std::string(text), is_comment});
  }
  return lines;
}

/// The delimiter that most lines have: a comma only where there is no other, as it may be decimal.
char delimiter_of(const std::vector<Line>& lines) {
  for (const char mark : {'\t', ';', ','})
    if (2 * std::ranges::count_if(
                lines, [&](const Line& line) { return line.text.find(mark) != std::string::npos; }) >
        std::ssize(lines))
      return mark;
  return ' ';
}

constexpr std::size_t most_cells = 256;  // more than any film has columns

/// At most one cell more than there may be.
std::vector<std::string> split(std::string_view text, char delimiter) {
  std::vector<std::string> cells;
  if (delimiter == ' ') text = trimmed(text, blanks);
  for (;;) {
    const std::size_t end = std::min(text.find(delimiter), text.size());
    cells.emplace_back(trimmed(text.substr(0, end), blanks));
    if (end == text.size() || cells.size() > most_cells) return cells;
    text.remove_prefix(end + 1);
    if (delimiter == ' ') text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  }
}

bool is_missing(std::string_view cell) {
  constexpr std::array words{"", "NaN", "nan", "NAN", "NA", "N/A", "-", "--", "null"};
  return std::ranges::find(words, cell) != words.end();
}

std::optional<double> number_of(std::string cell, bool decimal_comma) {
  if (decimal_comma) std::ranges::replace(cell, ',', '.');
  return number_in(cell);
}

/// Whether the cells are numbers, but for missing ones.
bool has_numbers(const std::vector<std::string>& cells) {
  bool some = false;
  for (const std::string& cell : cells) {
    if (is_missing(cell)) continue;
    if (!number_of(cell, false) && !number_of(cell, true)) return false;
    some = true;
  }
  return some;
}

/// Whether a name stands in each column of numbers: comments above a table may be its header.
bool may_name(const std::vector<std::string>& names, const std::vector<std::string>& numbers) {
  if (names.size() > numbers.size() + 1) return false;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (!is_missing(numbers[k]) && (k >= names.size() || names[k].empty())) return false;
  return true;
}

}  // namespace

FilmTable read_film_table(const std::string& path) {
  std::vector<Line> lines = read_lines(path);
  if (lines.empty()) throw InputError(fmt::format("{}: is empty; allowed: {}", path, a_table));
  FilmTable table{.path = path, .delimiter = delimiter_of(lines)};
  for (const Line& line : lines)
    if (split(line.text, table.delimiter).size() > most_cells)
      throw InputError(fmt::format("{}:{}: more than {} cells; allowed: at most that number", path,
                                   line.number, most_cells));
  const auto first = std::ranges::find_if(lines, [&](const Line& line) {
    return !line.is_comment && has_numbers(split(line.text, table.delimiter));
  });
  if (first == lines.end())
    throw InputError(fmt::format("{}: no line of numbers; allowed: {}", path, a_table));
  const std::vector<std::string> numbers = split(first->text, table.delimiter);
  for (auto line = lines.begin(); line != first; ++line)
    if (std::vector<std::string> names = split(line->text, table.delimiter);
        !line->is_comment || may_name(names, numbers))
      table.headers.push_back(std::move(names));
  if (table.delimiter != ',')
    table.decimal_comma = std::any_of(first, lines.end(), [&](const Line& line) {
      return !line.is_comment && line.text.find(',') != std::string::npos;
    });
  std::size_t width = numbers.size();
  for (auto line = first; line != lines.end(); ++line) {
    if (line->is_comment) continue;
    const std::vector<std::string> cells = split(line->text, table.delimiter);
    const auto place = [&](std::size_t column) {
      return fmt::format("{}:{}: column {}", path, line->number, column + 1);
    };
    if (cells.size() != width)
      throw InputError(fmt::format(
          "{}:{}: {} cells; allowed: {}, as in line {}{}", path, line->number, cells.size(), width,
          first->number, cells.size() == 2 * width ? " (or semicolons beside decimal commas)" : ""));
    std::vector<std::optional<double>> row;
    for (std::size_t k = 0; k < width; ++k) {
      row.push_back(is_missing(cells[k]) ? std::nullopt : number_of(cells[k], table.decimal_comma));
      if (!row.back() && !is_missing(cells[k]))
        throw InputError(
            fmt::format("{}: '{}' is not a number; allowed: numbers, blank cells, NaN", place(k), cells[k]));
    }
    table.rows.push_back(std::move(row));
    table.lines.push_back(line->number);
  }
  return table;
}

}  // namespace leapmap
