// SPDX-License-Identifier: GPL-3.0-or-later
/// What commands print on standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace leapmap::cli {

/// Writes to standard output, control characters but line ends and tabs escaped. Throws IoError if that
/// cannot be done, for instance on a full disk.
void write_out(const std::string& text);
/// Brings what was written on its way. Throws as write_out does.
void flush_out();

/// Formats and writes to standard output. Throws as write_out does.
template <class... T>
void say(fmt::format_string<T...> form, T&&... values) {
  write_out(fmt::format(form, std::forward<T>(values)...));
}

/// A line on stderr, control characters escaped. A terminal that is gone or a log on a full disk is no reason
/// to stop.
void tell(const std::string& line);
/// Tells that a file is in its place, but its folder could not be brought to disk.
void tell_of_folder(const std::string& path);

}  // namespace leapmap::cli
