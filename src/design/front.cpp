// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/front.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
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
  const std::size_t count = places_.size();
  if (count <= std::max<std::size_t>(most, 2)) return;
  // One place after the other, whichever dominates least alone; its neighbours then dominate more.
  std::vector<std::size_t> before(count), after(count);
  for (std::size_t i = 0; i < count; ++i) before[i] = i - 1, after[i] = i + 1;
  const auto cost = [&](std::size_t i, std::size_t k) { return places_[i].verdict.cost[k]; };
  const auto worth = [&](std::size_t i) {
    return (cost(after[i], 0) - cost(i, 0)) * (cost(before[i], 1) - cost(i, 1));
  };
  std::set<std::pair<double, std::size_t>> order;
  for (std::size_t i = 1; i + 1 < count; ++i) order.emplace(worth(i), i);
  std::vector<bool> goes(count, false);
  for (std::size_t left = count; left > std::max<std::size_t>(most, 2); --left) {
    const std::size_t i = order.begin()->second, b = before[i], a = after[i];
    order.erase(order.begin());
    goes[i] = true;
    for (const std::size_t neighbour : {b, a})
      if (neighbour > 0 && neighbour + 1 < count) order.erase({worth(neighbour), neighbour});
    after[b] = a, before[a] = b;
    for (const std::size_t neighbour : {b, a})
      if (neighbour > 0 && neighbour + 1 < count) order.emplace(worth(neighbour), neighbour);
  }
  std::vector<Place> kept;
  for (std::size_t i = 0; i < count; ++i)
    if (!goes[i]) kept.push_back(std::move(places_[i]));
  places_ = std::move(kept);
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

void Fronts::add(std::vector<Place> places) {
  std::map<std::uint64_t, std::vector<Place>> sorted;
  for (Place& place : places)
    if (place.verdict.feasible()) sorted[place.verdict.outcome].push_back(std::move(place));
  for (auto& [outcome, some] : sorted) fronts_[outcome].add(std::move(some));
}

void Fronts::thin(std::size_t most) {
  for (auto& [outcome, front] : fronts_) front.thin(most);
}

Front Fronts::of_all() const {
  Front all;
  for (const auto& [outcome, front] : fronts_) all.add(front.places());
  return all;
}

void Fronts::leave_nearest(std::size_t most) {
  Front all = of_all();
  if (fronts_.size() <= most || all.places().size() < 2) return;
  constexpr std::size_t enough = 512;  // to tell how far a band is behind
  all.thin(enough);
  const auto &first = all.places().front().verdict.cost, &last = all.places().back().verdict.cost;
  const std::array span{last[0] - first[0], first[1] - last[1]};
  // How far the front of all would have to move back for a place to be on it, in shares of its ends'
  // distance.
  const auto behind = [&](const Verdict& verdict) {
    double most_behind = 0.0;
    for (const Place& place : all.places())
      most_behind = std::max(most_behind, std::min((verdict.cost[0] - place.verdict.cost[0]) / span[0],
                                                   (verdict.cost[1] - place.verdict.cost[1]) / span[1]));
    return most_behind;
  };
  std::vector<std::pair<double, std::uint64_t>> order;
  for (const auto& [outcome, front] : fronts_) {
    double nearest = HUGE_VAL;
    for (const Place& place : front.places()) nearest = std::min(nearest, behind(place.verdict));
    order.emplace_back(nearest, outcome);
  }
  std::ranges::sort(order);
  for (std::size_t i = most; i < order.size(); ++i)
    if (order[i].first > 0.0) fronts_.erase(order[i].second);  // those on the front of all stay
}

namespace {

/// A step by chance from a place of a front: along it as its neighbours lie, or any length in any direction.
void step_from(const Front& front, bool along, bool off, std::mt19937_64& random, std::span<double> place) {
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  const std::vector<Place>& members = front.places();
  const auto parent = std::min(
      members.size() - 1, static_cast<std::size_t>(uniform(random) * static_cast<double>(members.size())));
  const std::size_t reach = 1 + static_cast<std::size_t>(std::pow(uniform(random), 3.0) * 64.0);
  const Place &before = members[parent >= reach ? parent - reach : 0],
              &after = members[std::min(parent + reach, members.size() - 1)];
  const double forwards = along ? 0.5 * normal(random) : 0.0,
               sideways = off ? 0.1 * std::pow(1e-7, uniform(random)) : 0.0;
  for (std::size_t k = 0; k < place.size(); ++k)
    place[k] = std::clamp(
        members[parent].at[k] + forwards * (after.at[k] - before.at[k]) + sideways * normal(random), 0.0,
        1.0);
}

}  // namespace

void refine(Judge& judge, Fronts& fronts, std::size_t most, std::size_t a_round, std::uint64_t seed) {
  const std::size_t rounds = judge.makes_hoops() ? 12 : 100;
  const std::size_t dimensions = judge.dimensions();
  std::mt19937_64 random(seed);
  std::vector<double> places(a_round * dimensions);
  std::vector<Verdict> verdicts(a_round);
  for (std::size_t round = 0; round < rounds && !fronts.by_outcome().empty(); ++round) {
    // Ever fewer bands: those that stay behind had their turn.
    fronts.leave_nearest(std::max<std::size_t>(24 >> (3 * round / rounds), 3));
    for (std::size_t i = 0; i < a_round;)
      for (auto band = fronts.by_outcome().begin(); band != fronts.by_outcome().end() && i < a_round;
           ++band, ++i) {
        const std::uint64_t kind = random() >> 62;
        step_from(band->second, kind >= 2, kind != 3, random,
                  std::span(places).subspan(i * dimensions, dimensions));
      }
    judge.judge(places, verdicts);
    std::vector<Place> met;
    for (std::size_t i = 0; i < a_round; ++i)
      if (verdicts[i].feasible()) met.push_back(place_of(places, verdicts, i));
    fronts.add(std::move(met));
    fronts.thin(2 * most);
  }
}

}  // namespace leapmap
