// SPDX-License-Identifier: GPL-3.0-or-later
#include "design/front.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <random>
#include <utility>

namespace leapmap {

namespace {

const Cost& cost_of(const Place& place) { return place.verdict.cost; }

/// Which of a front's designs to keep, so many: one after the other goes, whichever dominates least alone;
/// its neighbours then dominate more. The ends stay.
std::vector<bool> worth_most(std::span<const Cost> front, std::size_t most) {
  const std::size_t count = front.size();
  most = std::max<std::size_t>(most, 2);
  std::vector<bool> kept(count, true);
  if (count <= most) return kept;
  std::vector<std::size_t> before(count), after(count);
  for (std::size_t i = 0; i < count; ++i) before[i] = i - 1, after[i] = i + 1;
  using Worth = std::pair<double, std::size_t>;
  std::vector<Worth> heap;  // the least on top; what changed since is in it once more
  std::vector<double> now(count);
  const auto weigh = [&](std::size_t i) {
    now[i] = (front[after[i]][0] - front[i][0]) * (front[before[i]][1] - front[i][1]);
    heap.emplace_back(now[i], i);
  };
  for (std::size_t i = 1; i + 1 < count; ++i) weigh(i);
  std::ranges::make_heap(heap, std::greater{});
  for (std::size_t left = count; left > most;) {
    const auto [worth, i] = heap.front();
    std::ranges::pop_heap(heap, std::greater{});
    heap.pop_back();
    if (!kept[i] || worth != now[i]) continue;
    kept[i] = false, --left;
    const std::size_t b = before[i], a = after[i];
    after[b] = a, before[a] = b;
    for (const std::size_t neighbour : {b, a})
      if (neighbour > 0 && neighbour + 1 < count)
        weigh(neighbour), std::ranges::push_heap(heap, std::greater{});
  }
  return kept;
}

}  // namespace

bool Front::takes(const Verdict& verdict) const {
  if (!verdict.feasible()) return false;
  const auto above = std::ranges::upper_bound(places_, verdict.cost[0], {},
                                              [](const Place& place) { return place.verdict.cost[0]; });
  const double least = above == places_.begin() ? HUGE_VAL : std::prev(above)->verdict.cost[1];
  return verdict.cost[1] < least;
}

void Front::add(std::vector<Place> places) {
  std::erase_if(places, [&](const Place& place) { return !takes(place.verdict); });
  if (places.empty()) return;
  std::ranges::stable_sort(places, {}, cost_of);
  std::vector<Place> all;
  all.reserve(places_.size() + places.size());
  std::merge(std::move_iterator(places_.begin()), std::move_iterator(places_.end()),
             std::move_iterator(places.begin()), std::move_iterator(places.end()), std::back_inserter(all),
             [](const Place& a, const Place& b) { return cost_of(a) < cost_of(b); });
  places_.clear();
  double least = HUGE_VAL;
  for (Place& place : all)
    if (place.verdict.cost[1] < least) {
      least = place.verdict.cost[1];
      places_.push_back(std::move(place));
    }
}

void Front::thin(std::size_t most) {
  if (places_.size() <= most) return;
  std::vector<Cost> costs;
  std::ranges::transform(places_, std::back_inserter(costs), cost_of);
  const std::vector<bool> kept = worth_most(costs, most);
  std::size_t next = 0;
  std::erase_if(places_, [&](const Place&) { return !kept[next++]; });
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

void Fronts::add(std::span<const double> places, std::span<const Verdict> verdicts) {
  std::map<std::uint64_t, std::vector<Place>> sorted;
  const Front none;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const auto there = fronts_.find(verdicts[i].outcome);
    if ((there == fronts_.end() ? none : there->second).takes(verdicts[i]))
      sorted[verdicts[i].outcome].push_back(place_of(places, verdicts, i));
  }
  for (auto& [outcome, some] : sorted) fronts_[outcome].add(std::move(some));
}

std::vector<Cost> Fronts::costs_of_all() const {
  std::vector<Cost> all;
  for (const auto& [outcome, front] : fronts_)
    std::ranges::transform(front.places(), std::back_inserter(all), cost_of);
  std::ranges::sort(all);
  double least = HUGE_VAL;
  std::erase_if(all, [&](const Cost& cost) {
    if (!(cost[1] < least)) return true;
    least = cost[1];
    return false;
  });
  return all;
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
  if (fronts_.size() <= most) return;
  std::vector<Cost> all = costs_of_all();
  if (all.size() < 2) return;
  constexpr std::size_t enough = 512;  // to tell how far a band is behind
  const std::vector<bool> kept = worth_most(all, enough);
  std::size_t next = 0;
  std::erase_if(all, [&](const Cost&) { return !kept[next++]; });
  const Cost span{all.back()[0] - all.front()[0], all.front()[1] - all.back()[1]};
  // How far the front of all would have to move back for a place to be on it, in shares of its ends'
  // distance. Along the front one cost falls behind ever less, the other ever more: where they meet is it.
  const auto behind = [&](const Cost& cost) {
    const auto first = [&](const Cost& on) { return (cost[0] - on[0]) / span[0]; };
    const auto second = [&](const Cost& on) { return (cost[1] - on[1]) / span[1]; };
    const auto meet =
        std::ranges::partition_point(all, [&](const Cost& on) { return first(on) > second(on); });
    double most_behind = 0.0;
    if (meet != all.begin()) most_behind = std::max(most_behind, second(*std::prev(meet)));
    if (meet != all.end()) most_behind = std::max(most_behind, first(*meet));
    return most_behind;
  };
  std::vector<std::pair<double, std::uint64_t>> order;
  for (const auto& [outcome, front] : fronts_) {
    double nearest = HUGE_VAL;
    for (const Place& place : front.places()) nearest = std::min(nearest, behind(cost_of(place)));
    order.emplace_back(nearest, outcome);
  }
  std::ranges::sort(order);
  for (std::size_t i = most; i < order.size(); ++i)
    if (order[i].first > 0.0) fronts_.erase(order[i].second);  // those on the front of all stay
}

namespace {

/// What a front dominates of both costs up to those of a corner.
double volume_of(std::span<const Cost> front, const Cost& corner) {
  double volume = 0.0;
  for (std::size_t i = 0; i < front.size() && front[i][0] < corner[0]; ++i) {
    const double next = i + 1 < front.size() ? std::min(front[i + 1][0], corner[0]) : corner[0];
    volume += (next - front[i][0]) * std::max(corner[1] - front[i][1], 0.0);
  }
  return volume;
}

/// Whether a front dominates about as much as it did before. Both are measured up to the same corner, which
/// lies beyond both, so that longer ends count.
bool is_as_before(std::span<const Cost> before, std::span<const Cost> now) {
  constexpr double alike = 1e-6;  // gaps between a front's places are worth more
  const Cost corner{std::max(before.back()[0], now.back()[0]), std::max(before.front()[1], now.front()[1])};
  const double volume = volume_of(now, corner);
  return volume - volume_of(before, corner) <= alike * volume;
}

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
  // What so many rounds bring no more, the next will not either. Many bands take their turns: they are not
  // all of the front while they come nearer.
  constexpr std::size_t patience = 16, few = 4;
  std::vector<std::vector<Cost>> fronts_before;
  const auto is_still = [&] {
    return fronts.by_outcome().size() <= few && fronts_before.size() > patience &&
           is_as_before(fronts_before[fronts_before.size() - 1 - patience], fronts_before.back());
  };
  for (std::size_t round = 0; round < rounds && !fronts.by_outcome().empty() && !is_still(); ++round) {
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
    fronts.add(places, verdicts);
    fronts.thin(2 * most);
    fronts_before.push_back(fronts.costs_of_all());
  }
}

}  // namespace leapmap
