// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaits/error_growth.hpp"

#include <limits>

#include "gaits/return_map.hpp"

namespace leapmap {

ErrorGrowth::ErrorGrowth(const Scene& scene, DualJumpSolver<StateDual> duals)
    : scene_(each_jump_alone(scene)), duals_(std::move(duals)) {}

ErrorGrowth::ErrorGrowth(const Scene& scene, double tolerance)
    : ErrorGrowth(scene, need(model_of(scene), &Model::state_jumps, "derivatives of later jumps")(
                             each_jump_alone(scene), tolerance)) {}

std::vector<double> ErrorGrowth::along(const Design& design, std::size_t most) {
  return along(design, Start::release, released<double>(design), most);
}

std::vector<double> ErrorGrowth::along(const Design& design, Start start, ContactState<double> at,
                                       std::size_t most) {
  std::vector<double> growth;
  // Each of them takes an error made at one landing, or at the release, to the last landing.
  std::vector<StateMatrix> since{StateMatrix::Identity()};
  while (growth.size() < most) {
    ContactState<StateDual> dual = by_state(at);
    if (duals_(start, design, dual, {}).status != Status::jumped) break;
    const StateMatrix slope = slope_of(dual);
    if (!slope.allFinite()) {
      growth.resize(most, std::numeric_limits<double>::quiet_NaN());
      break;
    }
    double all = 1.0;
    for (StateMatrix& from : since) {
      from = slope * from;
      all += from.lpNorm<Eigen::Infinity>();
    }
    if (!(all < most_growth)) {
      growth.resize(most, most_growth);
      break;
    }
    growth.push_back(all);
    since.push_back(StateMatrix::Identity());
    at = reduced(plain(dual)), start = Start::landing;
  }
  return growth;
}

void ErrorGrowth::tell(std::span<const Design> designs, std::span<Outcome> outcomes) {
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const std::vector<double> growth = along(designs[i], outcomes[i].jumps());
    if (!growth.empty() && growth.size() == outcomes[i].jumps())
      outcomes[i].sequence_condition = growth.back();
  }
}

}  // namespace leapmap
