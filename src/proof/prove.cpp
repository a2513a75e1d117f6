// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/prove.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "leapmap/errors.hpp"
#include "model/parameters.hpp"
#include "proof/acting.hpp"
#include "proof/walk.hpp"

namespace leapmap {
namespace {

template <std::size_t N>
Proof walk(const DesignBox& box, const std::vector<double Design::*>& varying, const Scene& scene,
           bool times) {
  // What does not vary stands for what is left over: its reach is none.
  std::array<double Design::*, N> members;
  for (std::size_t k = 0, other = 0; k < N; ++k) {
    if (k < varying.size()) {
      members[k] = varying[k];
      continue;
    }
    while (std::ranges::find(varying, acting[other]) != varying.end()) ++other;
    members[k] = acting[other++];
  }
  try {
    return Walk<N>(box, members, scene, times).prove();
  } catch (const Undecided& undecided) {
    return {.open = undecided.event};
  }
}

}  // namespace

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
  switch (varying.size()) {
    case 0:
      return walk<0>(box, varying, scene, times);
    case 1:
      return walk<1>(box, varying, scene, times);
    case 2:
      return walk<2>(box, varying, scene, times);
    case 3:
      return walk<3>(box, varying, scene, times);
    case 8:
      throw InputError("a box in eight parameters cannot be proved; allowed: up to seven");
    default:
      return walk<7>(box, varying, scene, times);
  }
}

Proof prove(const Design& design, const Scene& scene) {
  return prove(DesignBox{design, design}, scene, true);
}

}  // namespace leapmap
