// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/solve.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "leapmap/spec.hpp"
#include "leapmap/trace.hpp"
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

}  // namespace

Outcome solve(const Design& design, const Scene& scene, const SolveOptions& options) {
  const Spec spec = spec_of(scene, options);
  check_design(design, scene);
  Outcome outcome;
  make_solver(spec)({&design, 1}, {&outcome, 1});
  return outcome;
}

void solve_into(std::span<Outcome> outcomes, std::span<const Design> designs, const Scene& scene,
                const SolveOptions& options) {
  if (designs.size() != outcomes.size())
    throw InputError(
        fmt::format("{} outcomes for {} designs; allowed: as many", outcomes.size(), designs.size()));
  const Spec spec = spec_of(scene, options);
  parallel_for_each((designs.size() + designs_a_block - 1) / designs_a_block, options.threads, [&] {
    return [&, solver = make_solver(spec)](std::size_t block) {
      const std::size_t first = block * designs_a_block,
                        size = std::min(designs_a_block, designs.size() - first);
      const std::span<const Design> some = designs.subspan(first, size);
      for (std::size_t i = 0; i < size; ++i)
        if (!is_allowed(some[i], scene)) check_design(some[i], scene, fmt::format("design {}", first + i));
      solver(some, outcomes.subspan(first, size));
      if (options.stop_requested && options.stop_requested()) throw Stopped("solve was asked to stop");
      return true;
    };
  });
}

std::vector<Outcome> solve(std::span<const Design> designs, const Scene& scene, const SolveOptions& options) {
  std::vector<Outcome> outcomes(designs.size());
  solve_into(outcomes, designs, scene, options);
  return outcomes;
}

Motion trace(const Design& design, const Scene& scene, const TraceOptions& options) {
  Spec spec = spec_of(scene, options);
  check_design(design, scene);
  if (!(options.interval >= 0.0 && options.interval < 1e9))
    throw InputError(fmt::format("interval = {} is out of range; allowed: a number of seconds in [0, 1e9)",
                                 options.interval));
  spec.design = design;
  return tell(spec, options.interval);
}

}  // namespace leapmap
