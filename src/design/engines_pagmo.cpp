// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/batch_evaluators/member_bfe.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <random>
#include <utility>

#include "design/engines.hpp"

namespace leapmap {
namespace {

/// A question as pagmo knows problems: what misses a goal costs more than anything that does not.
struct DesignProblem {
  Judge* judge = nullptr;

  pagmo::vector_double::size_type get_nobj() const { return judge ? judge->question().objectives.size() : 1; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    const std::size_t dimensions = judge ? judge->dimensions() : 1;
    return {pagmo::vector_double(dimensions, 0.0), pagmo::vector_double(dimensions, 1.0)};
  }
  pagmo::vector_double fitness(const pagmo::vector_double& place) const { return batch_fitness(place); }
  pagmo::vector_double batch_fitness(const pagmo::vector_double& places) const {
    std::vector<Verdict> verdicts(places.size() / judge->dimensions());
    judge->judge(places, verdicts);
    pagmo::vector_double costs;
    for (const Verdict& verdict : verdicts)
      for (std::size_t k = 0; k < get_nobj(); ++k)
        costs.push_back(verdict.feasible() ? verdict.cost[k] : missed * (1.0 + verdict.violation));
    return costs;
  }

  static constexpr double missed = 1e30;
  template <class Archive>
  void serialize(Archive&, unsigned) {}  // pagmo asks for it; nothing here leaves the process
};

/// Coordinates near a place by chance, kept inside the box.
std::vector<double> near_by(const std::vector<double>& place, double spread, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, spread);
  std::vector<double> other;
  for (const double coordinate : place) other.push_back(std::clamp(coordinate + normal(random), 0.0, 1.0));
  return other;
}

}  // namespace

bool has_engines() { return true; }

void evolve(Judge& judge, Place& place, std::uint64_t seed) {
  const std::size_t size = 4 + 3 * judge.dimensions();
  constexpr double spread = 0.02;
  const unsigned generations = judge.makes_hoops() ? 12 : 60;
  std::mt19937_64 random(seed);
  pagmo::population population(DesignProblem{&judge}, 0, static_cast<unsigned>(seed));
  population.push_back(place.at);
  while (population.size() < size) population.push_back(near_by(place.at, spread, random));
  population = pagmo::cmaes(generations, -1, -1, -1, -1, spread, 1e-12, 1e-12, false, true,
                            static_cast<unsigned>(seed))
                   .evolve(population);
  Place best{population.champion_x(), {}};
  best.verdict = judge.judge(best.at);
  if (better(best.verdict, place.verdict)) place = std::move(best);
}

void evolve_front(Judge& judge, std::vector<Place>& places, std::uint64_t seed) {
  const std::size_t size = judge.makes_hoops() ? 40 : 400;
  const unsigned generations = judge.makes_hoops() ? 20 : 150;
  std::mt19937_64 random(seed);
  pagmo::population population(DesignProblem{&judge}, 0, static_cast<unsigned>(seed));
  const std::size_t seeds = std::min(places.size(), size);
  for (std::size_t i = 0; i < seeds; ++i) population.push_back(places[i * places.size() / seeds].at);
  while (population.size() < size)
    population.push_back(near_by(places[population.size() % places.size()].at, 0.05, random));
  pagmo::nsga2 nsga(generations, 0.95, 10.0, 0.1, 20.0, static_cast<unsigned>(seed));
  nsga.set_bfe(pagmo::bfe(pagmo::member_bfe()));
  population = nsga.evolve(population);
  for (const pagmo::vector_double& at : population.get_x()) places.push_back({at, judge.judge(at)});
}

}  // namespace leapmap
