// SPDX-License-Identifier: GPL-3.0-or-later
/// In place of the library's own: the linker takes these, so that the program loads Arb and libzip when they
/// are first needed.
#include "cli/late.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "film/unzip.hpp"
#include "leapmap/errors.hpp"
#include "proof/walked.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace cli {
namespace {

/// Beside the program, as it is built, or where it is installed.
const Late* loaded() {
  constexpr std::string_view module = "leapmap-late.so";
  const std::filesystem::path folder = std::filesystem::canonical("/proc/self/exe").parent_path(),
                              installed = folder.parent_path() / LEAPMAP_MODULE_FOLDER;
  std::string why;
  for (const auto& path : {folder / module, installed / module}) {
    if (void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL))
      return reinterpret_cast<LateEntry>(::dlsym(library, late_entry))();
    why += fmt::format("{}{}", why.empty() ? "" : "; ", ::dlerror());
  }
  throw InputError(fmt::format("{} cannot be loaded: {}; allowed: beside the program, or in {}", module, why,
                               installed.string()));
}

const Late& late() {
  static const Late* const module = loaded();
  return *module;
}

}  // namespace
}  // namespace cli

Proof walked(const DesignBox& box, std::span<double Design::*const> varying, const Scene& scene, bool times) {
  return cli::late().walked(box, varying, scene, times, throw_if_stopped);
}

std::string unzipped(const std::string& path, std::string_view ending, std::size_t most,
                     std::string_view allowed) {
  return cli::late().unzipped(path, ending, most, allowed);
}

}  // namespace leapmap
