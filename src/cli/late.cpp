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
  std::error_code unknown;
  const std::filesystem::path folder = std::filesystem::canonical("/proc/self/exe", unknown).parent_path(),
                              installed = folder.parent_path() / LEAPMAP_MODULE_FOLDER;
  if (unknown)
    throw InputError(fmt::format("{} cannot be found, as the program's own file is gone: {}; start it again",
                                 module, unknown.message()));
  std::string why;
  for (const auto& path : {folder / module, installed / module}) {
    if (void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
      const auto entry = reinterpret_cast<LateEntry>(::dlsym(library, late_entry));
      if (const Late* const late = entry ? entry() : nullptr;
          late && late->revision == std::string_view(LEAPMAP_GIT_REVISION))
        return late;
      why = path.string() + ": is of another revision than the program";
      break;
    }
    why += fmt::format("{}{}", why.empty() ? "" : "; ", ::dlerror());
  }
  throw InputError(fmt::format("{} cannot be loaded: {}; copy it beside the program, or to {}", module, why,
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
