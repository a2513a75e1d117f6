// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "support/printable.hpp"

namespace leapmap {

std::optional<double> number_in(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
  return is_number ? std::optional(value) : std::nullopt;
}

std::string toml_number(double value) {
  std::string digits = fmt::format("{}", value);
  const bool is_integer = digits.find_first_of(".en") == std::string::npos;  // and not inf
  return is_integer ? digits + ".0" : digits;
}

}  // namespace leapmap
