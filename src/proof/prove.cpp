// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/prove.hpp"

#include <fmt/format.h>

#include <vector>

#include "leapmap/errors.hpp"
#include "model/parameters.hpp"
#include "proof/acting.hpp"
#include "proof/walked.hpp"

namespace leapmap {
bool can_prove() { return true; }

Proof prove(const DesignBox& box, const Scene& scene, bool times) {
  check_scene(scene);
  for (const auto member : acting)
    if (!(box.from.*member <= box.to.*member))
      throw InputError(
          fmt::format("a box from {} to {}; allowed: bounds in order", box.from.*member, box.to.*member));
  if (box.from.size != box.to.size)
    throw InputError("a box of hoops of several sizes; allowed: one size, of which times depend");
  check_design(box.from, scene), check_design(box.to, scene);
  refuse_unprovable(scene);
  std::vector<double Design::*> varying;
  for (const auto member : acting)
    if (box.from.*member != box.to.*member) varying.push_back(member);
  constexpr std::size_t most = 7;
  if (varying.size() > most)
    throw InputError("a box in eight parameters cannot be proved; allowed: up to seven");
  return walked(box, varying, scene, times);
}

Proof prove(const Design& design, const Scene& scene) {
  return prove(DesignBox{design, design}, scene, true);
}

}  // namespace leapmap
