// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "leapmap/trace.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "sweep/options.hpp"
#include "sweep/parallel.hpp"
#include "sweep/solver.hpp"

namespace leapmap {
namespace {

constexpr std::size_t designs_a_block = 2048;

/// The spec of one call: what its method and tolerance come to, checked.
template <class Options>
Spec spec_of(const Scene& scene, const Options& options) {
  Spec spec;
  spec.scene = scene;
  spec.numerics.method = options.method;
  spec.numerics.tolerance = options.tolerance;
  spec.numerics.max_steps = options.max_steps;
  check_spec(spec);
  return spec;
}

/// Calls make_work()(solver, first, size) for each block of neighbours, on all threads.
template <class MakeWork>
void for_blocks(std::size_t count, const Scene& scene, const SolveOptions& options,
                const MakeWork& make_work) {
  const Spec spec = spec_of(scene, options);
  parallel_for_each((count + designs_a_block - 1) / designs_a_block, options.threads, [&] {
    return [&, solver = make_solver(spec), work = make_work()](std::size_t block) mutable {
      const std::size_t first = block * designs_a_block;
      work(solver, first, std::min(designs_a_block, count - first));
      if (options.stop_requested && options.stop_requested()) throw Stopped("solve was asked to stop");
      return true;
    };
  });
}

void check_designs(std::span<const Design> designs, const Scene& scene, std::size_t first) {
  for (std::size_t i = 0; i < designs.size(); ++i)
    if (!is_allowed(designs[i], scene)) check_design(designs[i], scene, fmt::format("design {}", first + i));
}

}  // namespace

void solve_blocks(std::size_t count, const GiveDesigns& give, const TakeOutcomes& take, const Scene& scene,
                  const SolveOptions& options) {
  for_blocks(count, scene, options, [&] {
    return [&, designs = std::vector<Design>(), outcomes = std::vector<Outcome>()](
               const Solver& solver, std::size_t first, std::size_t size) mutable {
      designs.resize(size), outcomes.resize(size);
      give(first, designs);
      check_designs(designs, scene, first);
      solver(designs, outcomes);
      take(first, outcomes);
    };
  });
}

Outcome solve(const Design& design, const Scene& scene, const SolveOptions& options) {
  const Spec spec = spec_of(scene, options);
  check_design(design, scene);
  Outcome outcome;
  make_solver(spec)({&design, 1}, {&outcome, 1});
  return outcome;
}

void solve(std::span<const Design> designs, std::span<Outcome> outcomes, const Scene& scene,
           const SolveOptions& options) {
  assert(designs.size() == outcomes.size());
  for_blocks(designs.size(), scene, options, [&] {
    return [&](const Solver& solver, std::size_t first, std::size_t size) {
      const std::span<const Design> some = designs.subspan(first, size);
      check_designs(some, scene, first);
      solver(some, outcomes.subspan(first, size));
    };
  });
}

std::vector<Outcome> solve(std::span<const Design> designs, const Scene& scene, const SolveOptions& options) {
  std::vector<Outcome> outcomes(designs.size());
  solve(designs, outcomes, scene, options);
  return outcomes;
}

Motion trace(const Design& design, const Scene& scene, const TraceOptions& options) {
  const Spec spec = spec_of(scene, options);
  check_design(design, scene);
  if (!(options.interval >= 0.0 && options.interval < 1e9))
    throw InputError(fmt::format("interval = {} is out of range; allowed: a number of seconds in [0, 1e9)",
                                 options.interval));
  const Model& model = model_of(scene);
  return resolved_method(spec.numerics) == "exact"
             ? model.tell_exactly(design, scene, options.tolerance, options.interval)
             : model.tell_by_integration(design, scene, integration_options(spec.numerics), options.interval);
}

}  // namespace leapmap
