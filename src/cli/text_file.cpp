// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/text_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "leapmap/errors.hpp"
#include "map/hdf5_driver.hpp"

namespace leapmap::cli {

void write_text(const std::string& path, const std::string& text) {
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary);
  file << text;
  file.close();
  std::error_code failed;
  if (file) std::filesystem::rename(part, path, failed);
  if (!file || failed) throw IoError(fmt::format("{}: cannot be written", path));
}

void refuse_text_over(std::string_view flag, const std::string& path, const std::vector<std::string>& others,
                      Locking locking) {
  if (path.empty()) return;
  std::error_code ignored;
  for (const std::string& other : others)
    if (path == other || std::filesystem::equivalent(path, other, ignored))
      throw InputError(
          fmt::format("{} {}: is the file of something else here; allowed: another name", flag, other));
  if (hdf5::is_hdf5(path, locking))
    throw InputError(fmt::format("{} {}: is an HDF5 file; allowed: another name", flag, path));
}

}  // namespace leapmap::cli
