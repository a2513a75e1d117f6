// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/wrapped.hpp"

#include <algorithm>

namespace leapmap {
namespace {

/// Appends words to a text whose last line is `used` columns long; new lines are indented.
void append_words(std::string& text, std::string_view words, std::size_t used, std::size_t indent) {
  bool first_on_line = true;
  while (!words.empty()) {
    const std::size_t begin = words.find_first_not_of(' ');
    if (begin == std::string_view::npos) break;
    words.remove_prefix(begin);
    const std::string_view word = words.substr(0, words.find(' '));
    words.remove_prefix(word.size());
    if (!first_on_line && used + 1 + word.size() > terminal_width) {
      text += '\n' + std::string(indent, ' ');
      used = indent, first_on_line = true;
    }
    if (!first_on_line) text += ' ', ++used;
    text += word, used += word.size();
    first_on_line = false;
  }
  text += '\n';
}

}  // namespace

std::string wrapped(std::string_view text) {
  std::string lines;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.starts_with("  "))
      lines += std::string(line) + '\n';
    else
      append_words(lines, line, 0, 0);
  }
  return lines;
}

std::string list_entry(std::string_view name, std::string_view meaning, std::size_t column) {
  std::string text(name);
  if (text.size() + 2 > column)
    text += '\n' + std::string(column, ' ');
  else
    text.resize(column, ' ');
  append_words(text, meaning, column, column);
  return text;
}

}  // namespace leapmap
