// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/outcome.hpp"

namespace leapmap {

std::string phase_letters(std::uint64_t sequence) {
  std::string letters;
  for (; sequence != 0; sequence >>= 2) letters += "-RSF"[sequence & 3];
  if (letters.size() == 32) letters += "...";
  return letters.empty() ? "-" : letters;
}

}  // namespace leapmap
