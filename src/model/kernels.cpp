// SPDX-License-Identifier: GPL-3.0-or-later
/// One set of kernels, under a name of its own: LEAPMAP_KERNELS, which cmake/kernels.cmake gives.
#include "model/kernels.hpp"

#include <array>

#include "friction/model.hpp"
#include "friction/motion_at.hpp"
#include "integrate/contestant.hpp"
#include "noslip/model.hpp"
#include "numerics/lanes.hpp"
#include "pendulum/model.hpp"

namespace leapmap {
namespace {

/// The rows of a hoop with a pendulum.
constexpr Model with_pendulum(Friction friction, std::string_view name, std::string_view meaning,
                              bool slips) {
  Model row{};
  row.mechanism = Mechanism::pendulum, row.stepper = pendulum::usual_stepper;
  row.friction = friction, row.name = name, row.meaning = meaning, row.slips = slips;
  row.integration = pendulum::integration, row.tell_by_integration = pendulum::tell_by_integration;
  row.ways = pendulum::ways;
  return row;
}

// Made by the compiler: nothing of a set may run before it is chosen.
constinit const std::array list{
    Model{Friction::sticking, "sticking", "never slips (the paper's model)", false, noslip::exact,
          noslip::jumps, noslip::gradients, noslip::dual_jumps, noslip::state_jumps, noslip::integration,
          noslip::integrated_jumps, noslip::refined, noslip::tell_exactly, recorded_motions<noslip::record>,
          [](const Design& design, const Scene& scene, const IntegrationOptions& options, double interval) {
            return noslip::tell_by_integration(design, scene, options, interval);
          },
          noslip::solving, noslip::effort, noslip::ways},
    Model{Friction::coulomb, "coulomb", "slips, by Coulomb friction", true, friction::exact, friction::jumps,
          friction::gradients, friction::dual_jumps, friction::state_jumps, friction::integration,
          friction::integrated_jumps, friction::refined, friction::tell_exactly,
          recorded_motions<friction::record>, friction::tell_by_integration, friction::solving,
          friction::effort, friction::ways, friction::long_jumps},
    with_pendulum(Friction::sticking, "sticking", "never slips", false),
    with_pendulum(Friction::coulomb, "coulomb", "slips, by Coulomb friction", true)};

constinit const Kernels of_this_set{list, static_cast<int>(batch_width)};

}  // namespace
}  // namespace leapmap

extern "C" const leapmap::Kernels* LEAPMAP_KERNELS() { return &leapmap::of_this_set; }
