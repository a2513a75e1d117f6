// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/contestant.hpp"

#include <array>

#include "model/kernels.hpp"

namespace leapmap {

std::string_view name_of(RollingModel model) {
  constexpr std::array<std::string_view, 6> names{"energy integral", "one coordinate",
                                                  "multipliers",     "multipliers, projected",
                                                  "centre of mass",  "centre of mass, projected"};
  return names[static_cast<std::size_t>(model)];
}

Solving make_solving(const Contestant& contestant, const Scene& scene, long max_steps) {
  return kernels().make_solving(contestant, scene, max_steps);
}

}  // namespace leapmap
