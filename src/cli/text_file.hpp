// SPDX-License-Identifier: GPL-3.0-or-later
/// Small text files beside what a command prints.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "map/journaled_file.hpp"

namespace leapmap::cli {

/// Replaces the file only once the text is whole. Throws IoError.
void write_text(const std::string& path, const std::string& text);

/// Throws InputError, naming the flag, if the path is one of the others or an HDF5 file: what is somebody's
/// is not overwritten by a table. Does nothing for an empty path.
void refuse_text_over(std::string_view flag, const std::string& path, const std::vector<std::string>& others,
                      Locking locking);

}  // namespace leapmap::cli
