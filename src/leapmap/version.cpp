// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/version.hpp"

namespace leapmap {

std::string_view program_version() { return LEAPMAP_VERSION; }
std::string_view git_revision() { return LEAPMAP_GIT_REVISION; }

std::string instruction_set() {
#if defined(__AVX512F__)
  return "AVX-512, 8 lanes";
#elif defined(__AVX2__)
  return "AVX2, 4 lanes";
#elif defined(__AVX__)
  return "AVX, 4 lanes";
#elif defined(__SSE2__)
  return "SSE2, 2 lanes";
#else
  return "no SIMD known here";
#endif
}

}  // namespace leapmap
