// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/boundaries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <tuple>

#include "boundaries/cliff.hpp"
#include "boundaries/cliff_curves.hpp"
#include "engine/engine.hpp"
#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"
#include "model/parameters.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"

namespace leapmap {
namespace {

/// An outcome as one number.
std::uint64_t word_of(const Discrete& outcome) {
  // Sequences of phases fill 64 bits: mixed, two of them are the same by chance once in 2^40.
  return static_cast<std::uint64_t>(outcome.status) | std::uint64_t{outcome.jumps_on} << 8 |
         std::uint64_t{outcome.spurious_first_jump} << 16 |
         (outcome.phase_sequence * 0x9e3779b97f4a7c15u >> 24) << 24;
}

Request request_for_outcomes(const Spec& spec) { return request_of(spec, {find_field("status")}); }

void check_grid(const Spec& spec) {
  check_spec(spec);
  if (spec.axes.empty()) throw InputError(origin_of(spec) + ": has no axes; allowed: at least one axis");
  const std::size_t designs = designs_of(shape_of(spec));
  if (designs > most_bounded_designs)
    throw InputError(
        fmt::format("{}: {} designs; allowed: at most {}", origin_of(spec), designs, most_bounded_designs));
  if (std::ranges::none_of(spec.axes, [](const Axis& axis) { return axis.values.size() > 1; }))
    throw InputError(origin_of(spec) + ": no axis has two values; allowed: an axis with at least two");
}

/// The grid's outcomes, as words.
std::vector<std::uint64_t> solve_grid(const Spec& spec, const BoundaryOptions& options, std::size_t total) {
  const Tiling tiling(shape_of(spec));
  std::vector<std::uint64_t> words(tiling.designs());
  std::mutex telling;
  std::size_t done = 0;
  run_sweep(spec, request_for_outcomes(spec), tiling, {options.threads, 0, options.stop_requested}, [&] {
    return TileWork{[&](const Tile& tile, std::size_t first, const Solved& solved) {
                      const std::span<const Outcome> some = solved.outcomes;
                      for (std::size_t i = 0; i < some.size(); ++i)
                        words[tiling.number(tile, first + i)] = word_of(discrete(some[i], options.phases));
                      const std::lock_guard lock(telling);
                      done += some.size();
                      if (options.progress) options.progress(done, total);
                    },
                    [](std::size_t, const Tile&) {
                      return Prepared{[] {}, 0};
                    }};
  });
  if (options.stop_requested && options.stop_requested()) throw Stopped("boundaries was stopped");
  return words;
}

/// An edge of the grid between designs whose outcomes differ.
struct Edge {
  std::size_t design, axis;
};

std::vector<Edge> edges_of(const std::vector<std::size_t>& shape, const std::vector<std::uint64_t>& words) {
  std::vector<Edge> edges;
  std::size_t stride = words.size();
  for (std::size_t axis = 0; axis < shape.size(); ++axis) {
    const std::size_t block = stride;
    stride /= shape[axis];
    for (std::size_t first = 0; first < words.size(); first += block)
      for (std::size_t i = first; i + stride < first + block; ++i)
        if (words[i] != words[i + stride]) edges.push_back({i, axis});
  }
  return edges;
}

/// Bisects the edges on all threads, some hundred side by side.
std::vector<Cliff> polish(const Spec& spec, const std::vector<Edge>& edges, const BoundaryOptions& options,
                          std::size_t designs) {
  constexpr std::size_t at_once = 512;
  const DesignSpace space(spec);
  const std::vector<std::size_t> shape = shape_of(spec);
  std::vector<std::vector<Cliff>> found((edges.size() + at_once - 1) / at_once);
  std::mutex telling;
  std::size_t done = 0;
  parallel_for_each(found.size(), options.threads, options.stop_requested, [&] {
    return [&, solve = make_solver(request_for_outcomes(spec))](std::size_t block) {
      const std::span some =
          std::span(edges).subspan(block * at_once, std::min(at_once, edges.size() - block * at_once));
      std::vector<std::vector<double>> beginnings;
      for (const Edge& edge : some) beginnings.push_back(space.values(edge.design));
      const auto design_at = [&](std::size_t line, double value) {
        beginnings[line][some[line].axis] = value;
        return space.varied().at(beginnings[line]);
      };
      std::vector<Stretch> stretches;
      std::vector<Design> ends;
      for (std::size_t i = 0; i < some.size(); ++i) {
        const std::vector<double>& values = spec.axes[some[i].axis].values;
        const std::size_t k = place_along(shape, some[i].design, some[i].axis);
        // From the lesser to the greater value, whichever way the axis runs.
        const auto [low, high] = std::minmax(values[k], values[k + 1]);
        stretches.push_back(
            {i,
             {low, {}},
             {high, {}},
             std::numeric_limits<double>::epsilon() * 0.25 * std::max(std::abs(low), std::abs(high))});
        ends.push_back(design_at(i, low)), ends.push_back(design_at(i, high));
      }
      std::vector<Outcome> outcomes(ends.size());
      solve(ends, outcomes);
      for (std::size_t i = 0; i < some.size(); ++i)
        stretches[i].below.outcome = outcomes[2 * i], stretches[i].above.outcome = outcomes[2 * i + 1];
      bisect(
          solve, options.phases, stretches, design_at,
          [&](const Stretch& at) {
            const CliffKind kind = kind_of(spec.scene, design_at(at.line, at.below.at), at.below,
                                           design_at(at.line, at.above.at), at.above);
            found[block].push_back({some[at.line].design, some[at.line].axis, at.below.at, kind,
                                    discrete(at.below.outcome, options.phases),
                                    discrete(at.above.outcome, options.phases)});
          },
          [&] {
            if (options.stop_requested && options.stop_requested()) throw Stopped("boundaries was stopped");
          });
      const std::lock_guard lock(telling);
      done += some.size();
      if (options.progress) options.progress(designs + done, designs + edges.size());
      return true;
    };
  });
  std::vector<Cliff> cliffs;
  for (const std::vector<Cliff>& some : found) cliffs.insert(cliffs.end(), some.begin(), some.end());
  std::ranges::sort(cliffs, [](const Cliff& a, const Cliff& b) {
    return std::tie(a.axis, a.design, a.value) < std::tie(b.axis, b.design, b.value);
  });
  return cliffs;
}

}  // namespace

std::vector<double> place_of(const Boundaries& boundaries, const Cliff& cliff) {
  std::vector<std::size_t> shape, position;
  for (const Axis& axis : boundaries.axes) shape.push_back(axis.values.size());
  unravel(cliff.design, shape, position);
  std::vector<double> place;
  for (std::size_t k = 0; k < shape.size(); ++k)
    place.push_back(k == cliff.axis ? cliff.value : boundaries.axes[k].values[position[k]]);
  return place;
}

Boundaries find_boundaries(const Spec& spec, const BoundaryOptions& asked) {
  check_grid(spec);
  BoundaryOptions options = asked;
  options.stop_requested = latched(asked.stop_requested);
  const std::size_t designs = designs_of(shape_of(spec));
  const std::vector<std::uint64_t> words = solve_grid(spec, options, designs);
  const std::vector<Edge> edges = edges_of(shape_of(spec), words);
  Boundaries boundaries{spec.axes, {}, polish(spec, edges, options, designs), {}};
  for (std::size_t k = 0; k < spec.axes.size(); ++k) boundaries.plane.push_back(k);
  std::ranges::stable_sort(boundaries.plane, std::ranges::greater{},
                           [&](std::size_t k) { return spec.axes[k].values.size(); });
  boundaries.plane.resize(spec.axes.size() < 2 ? 0 : 2);
  std::ranges::sort(boundaries.plane);
  boundaries.curves = curves_of(boundaries);
  return boundaries;
}

}  // namespace leapmap
