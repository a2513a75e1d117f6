// SPDX-License-Identifier: GPL-3.0-or-later
/// One set of kernels, under a name of its own: LEAPMAP_KERNELS, which cmake/kernels.cmake gives.
#include "model/kernels.hpp"

#include <array>

#include "coulomb/model.hpp"
#include "numerics/lanes.hpp"
#include "rolling/model.hpp"
#include "trajectory/contestant.hpp"

namespace leapmap {
namespace {

// Made by the compiler: nothing of a set may run before it is chosen.
constinit const std::array list{
    Model{Friction::sticking, "sticking", "never slips (the paper's model)", false, rolling::exact,
          rolling::jumps, rolling::gradients, rolling::dual_jumps, rolling::integration,
          rolling::integrated_jumps, rolling::refined, rolling::tell_exactly,
          [](const Design& design, const Scene& scene, const IntegrationOptions& options, double interval) {
            return rolling::tell_by_integration(design, scene, options, interval);
          },
          rolling::solving, rolling::effort, rolling::ways},
    Model{Friction::coulomb, "coulomb", "slips, by Coulomb friction", true, coulomb::exact, coulomb::jumps,
          coulomb::gradients, coulomb::dual_jumps, coulomb::integration, coulomb::integrated_jumps,
          coulomb::refined, coulomb::tell_exactly, coulomb::tell_by_integration, coulomb::solving,
          coulomb::effort, coulomb::ways}};

constinit const Kernels of_this_set{list, static_cast<int>(batch_width)};

}  // namespace
}  // namespace leapmap

extern "C" const leapmap::Kernels* LEAPMAP_KERNELS() { return &leapmap::of_this_set; }
