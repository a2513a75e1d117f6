// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/version.hpp"

namespace leapmap {

std::string_view program_version() { return LEAPMAP_VERSION; }
std::string_view git_revision() { return LEAPMAP_GIT_REVISION; }

}  // namespace leapmap
