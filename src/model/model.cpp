// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/model.hpp"

#include <algorithm>
#include <array>

#include "coulomb/model.hpp"
#include "rolling/model.hpp"

namespace leapmap {
namespace {

const std::array list{
    Model{Friction::sticking, "sticking", "never slips (the paper's model)", rolling::exact,
          rolling::integration, rolling::refined, rolling::tell_exactly,
          [](const Design& design, const Scene& scene, const IntegrationOptions& options, double interval) {
            return rolling::tell_by_integration(design, scene, options, interval);
          }},
    Model{Friction::coulomb, "coulomb", "slips, lands and hops on", coulomb::exact, coulomb::integration,
          coulomb::refined, coulomb::tell_exactly, coulomb::tell_by_integration}};

}  // namespace

std::span<const Model> models() { return list; }

const Model& model_of(Friction friction) { return *std::ranges::find(list, friction, &Model::friction); }

}  // namespace leapmap
