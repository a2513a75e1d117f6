// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace leapmap {

void Front::add(std::vector<Place> places) {
  std::erase_if(places, [](const Place& place) { return !place.verdict.feasible(); });
  std::vector<Place> all = std::exchange(places_, {});
  std::ranges::move(places, std::back_inserter(all));
  std::ranges::stable_sort(all, {}, [](const Place& place) { return place.verdict.cost; });
  double least = HUGE_VAL;
  for (Place& place : all)
    if (place.verdict.cost[1] < least) {
      least = place.verdict.cost[1];
      places_.push_back(std::move(place));
    }
}

void Front::thin(std::size_t most) {
  while (places_.size() > std::max<std::size_t>(most, 2)) {
    // What a place alone dominates; of neighbours only one goes at a time.
    const auto cost = [&](std::size_t i, std::size_t k) { return places_[i].verdict.cost[k]; };
    std::vector<std::pair<double, std::size_t>> worth;
    for (std::size_t i = 1; i + 1 < places_.size(); ++i)
      worth.emplace_back((cost(i + 1, 0) - cost(i, 0)) * (cost(i - 1, 1) - cost(i, 1)), i);
    std::ranges::sort(worth);
    std::vector<bool> goes(places_.size(), false);
    std::size_t left = places_.size() - std::max<std::size_t>(most, 2);
    for (const auto& [volume, i] : worth) {
      if (left == 0) break;
      if (goes[i - 1] || goes[i + 1]) continue;
      goes[i] = true, --left;
    }
    std::vector<Place> kept;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (!goes[i]) kept.push_back(std::move(places_[i]));
    places_ = std::move(kept);
  }
}

double Front::hypervolume() const {
  if (places_.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const auto &first = places_.front().verdict.cost, &last = places_.back().verdict.cost;
  double volume = 0.0;
  for (std::size_t i = 0; i + 1 < places_.size(); ++i)
    volume += (places_[i + 1].verdict.cost[0] - places_[i].verdict.cost[0]) *
              (first[1] - places_[i].verdict.cost[1]);
  return volume / ((last[0] - first[0]) * (first[1] - last[1]));
}

void refine(Judge& judge, Front& front, std::size_t most, std::uint64_t seed) {
  if (front.places().empty()) return;
  const bool slips = judge.question().one.scene.friction != Friction::sticking;
  const std::size_t rounds = judge.makes_hoops() ? 12 : 80;
  const std::size_t a_round = judge.makes_hoops() ? 128 : slips ? 8192 : 65536;
  const std::size_t dimensions = judge.dimensions();
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  std::vector<double> places(a_round * dimensions);
  std::vector<Verdict> verdicts(a_round);
  for (std::size_t round = 0; round < rounds; ++round) {
    const std::vector<Place>& members = front.places();
    for (std::size_t i = 0; i < a_round; ++i) {
      const std::size_t parent =
          std::min(members.size() - 1,
                   static_cast<std::size_t>(uniform(random) * static_cast<double>(members.size())));
      // Along the front as its neighbours lie, and by chance any length in any direction.
      const std::size_t reach = 1 + static_cast<std::size_t>(std::pow(uniform(random), 3.0) * 64.0);
      const std::size_t before = parent >= reach ? parent - reach : 0,
                        after = std::min(parent + reach, members.size() - 1);
      const double along = i % 2 == 0 ? 0.0 : 0.5 * normal(random),
                   off = 0.1 * std::pow(1e-7, uniform(random));
      for (std::size_t k = 0; k < dimensions; ++k)
        places[i * dimensions + k] =
            std::clamp(members[parent].at[k] + along * (members[after].at[k] - members[before].at[k]) +
                           (i % 4 == 1 ? 0.0 : off * normal(random)),
                       0.0, 1.0);
    }
    judge.judge(places, verdicts);
    std::vector<Place> met;
    for (std::size_t i = 0; i < a_round; ++i) {
      if (!verdicts[i].feasible()) continue;
      const auto begin = places.begin() + static_cast<std::ptrdiff_t>(i * dimensions);
      met.push_back({{begin, begin + static_cast<std::ptrdiff_t>(dimensions)}, verdicts[i]});
    }
    front.add(std::move(met));
    front.thin(2 * most);
  }
  front.thin(most);
}

}  // namespace leapmap
