// SPDX-License-Identifier: GPL-3.0-or-later
/// What is packed in zip archives.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace leapmap {

/// The first file of an archive whose name ends so. allowed: what the archive should be, for errors. Throws
/// InputError if there is none, if it is longer than `most` bytes, or if it cannot be unpacked. The program
/// replaces this function by one of its own (cli/late.cpp): its source file must hold nothing else.
std::string unzipped(const std::string& path, std::string_view ending, std::size_t most,
                     std::string_view allowed);

}  // namespace leapmap
