// SPDX-License-Identifier: GPL-3.0-or-later
#include "proof/walked.hpp"

#include <algorithm>
#include <array>

#include "proof/acting.hpp"
#include "proof/walk.hpp"

namespace leapmap {
namespace {

template <std::size_t N>
Proof walk(const DesignBox& box, std::span<double Design::*const> varying, const Scene& scene, bool times) {
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

Proof walked(const DesignBox& box, std::span<double Design::*const> varying, const Scene& scene, bool times) {
  switch (varying.size()) {
    case 0:
      return walk<0>(box, varying, scene, times);
    case 1:
      return walk<1>(box, varying, scene, times);
    case 2:
      return walk<2>(box, varying, scene, times);
    case 3:
      return walk<3>(box, varying, scene, times);
    default:
      return walk<7>(box, varying, scene, times);
  }
}

}  // namespace leapmap
