// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/printable.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace leapmap {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
}

/// How many bytes the character at i takes if it is UTF-8 and shows something, else 0.
std::size_t shown_bytes(std::string_view text, std::size_t i) {
  const unsigned lead = byte_at(text, i);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t bytes = lead >= 0xf0 && lead < 0xf5   ? 4
                            : lead >= 0xe0 && lead < 0xf0 ? 3
                            : lead >= 0xc2 && lead < 0xe0 ? 2
                                                          : 0;
  for (std::size_t k = 1; k < bytes; ++k)
    if ((byte_at(text, i + k) & 0xc0u) != 0x80u) return 0;
  const unsigned second = byte_at(text, i + 1), third = byte_at(text, i + 2);
  const bool control = lead == 0xc2 && second < 0xa0;  // U+0080 to U+009F, CSI among them
  const bool turns =
      lead == 0xe2 && ((second == 0x80 && third >= 0xaa && third <= 0xae) ||
                       (second == 0x81 && third >= 0xa6 && third <= 0xa9));  // the direction of reading
  const bool ill_formed = (lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) ||
                          (lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second > 0x8f);
  return control || turns || ill_formed ? 0 : bytes;
}

}  // namespace

std::string printable(std::string_view text, std::string_view kept) {
  std::string shown;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = kept.find(text[i]) != std::string_view::npos ? 1 : shown_bytes(text, i);
    shown += bytes > 0 ? std::string(text.substr(i, bytes)) : fmt::format("\\x{:02x}", byte_at(text, i));
    i += std::max<std::size_t>(bytes, 1);
  }
  return shown;
}

std::string lower_case(std::string_view text) {
  std::string lowered(text);
  for (char& c : lowered)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lowered;
}

std::string_view trimmed(std::string_view text, std::string_view blanks) {
  const std::size_t first = text.find_first_not_of(blanks);
  return first == text.npos ? std::string_view{}
                            : text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

std::string shell_quoted(const std::string& word) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-+=./:,@%").find(c) != std::string_view::npos;
  };
  bool needs = word.empty();
  std::string text = "'";
  for (const char c : word) {
    needs = needs || !plain(c);
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return needs ? text + "'" : word;
}

}  // namespace leapmap
