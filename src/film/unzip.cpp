// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/unzip.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <memory>

#include "leapmap/errors.hpp"

namespace leapmap {

std::string unzipped(const std::string& path, std::string_view ending, std::size_t most,
                     std::string_view allowed) {
  int error = 0;
  const std::unique_ptr<zip_t, decltype(&zip_discard)> archive(zip_open(path.c_str(), ZIP_RDONLY, &error),
                                                               &zip_discard);
  if (!archive)
    throw InputError(fmt::format("{}: is not a zip archive that can be read; allowed: {}", path, allowed));
  const zip_int64_t files = zip_get_num_entries(archive.get(), 0);
  for (zip_int64_t i = 0; i < files; ++i) {
    zip_stat_t entry;
    zip_stat_init(&entry);
    if (zip_stat_index(archive.get(), static_cast<zip_uint64_t>(i), 0, &entry) != 0) continue;
    if (!std::string_view(entry.name).ends_with(ending)) continue;
    if (entry.size > most)
      throw InputError(
          fmt::format("{}: {} has {} bytes; allowed: at most {}", path, entry.name, entry.size, most));
    const std::unique_ptr<zip_file_t, decltype(&zip_fclose)> file(
        zip_fopen_index(archive.get(), static_cast<zip_uint64_t>(i), 0), &zip_fclose);
    std::string text(entry.size, '\0');
    if (!file || zip_fread(file.get(), text.data(), entry.size) != static_cast<zip_int64_t>(entry.size))
      throw InputError(fmt::format("{}: {} cannot be unpacked; allowed: {}", path, entry.name, allowed));
    return text;
  }
  throw InputError(fmt::format("{}: holds no {}; allowed: {}", path, ending, allowed));
}

}  // namespace leapmap
