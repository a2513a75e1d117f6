// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/solve.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/parallel.hpp"
#include "engine/solve_blocks.hpp"
#include "leapmap/gradient.hpp"
#include "leapmap/spec.hpp"
#include "leapmap/trace.hpp"
#include "model/fields.hpp"
#include "model/parameters.hpp"
#include "numerics/nan.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"

namespace leapmap {
namespace {

/// Few of a stepper, which may take a second for one: whoever asks for a stop waits for a block.
std::size_t designs_a_block(const Spec& spec) { return resolved_method(spec) == "exact" ? 2048 : 16; }

/// The spec of one call: what its method and tolerance come to, checked.
template <class Options>
Spec spec_of(const Scene& scene, const Options& options) {
  Spec spec;
  spec.origin = "options";  // for messages
  spec.scene = scene;
  spec.numerics.method = options.method;
  spec.numerics.tolerance = options.tolerance;
  spec.numerics.max_steps = options.max_steps;
  spec.numerics.audit = 0.0;
  check_spec(spec);
  return spec;
}

/// Refuses what is no hoop by the design's number, if it is one of many.
void check_designs(std::span<const Design> block, const Scene& scene, std::size_t first,
                   std::size_t designs) {
  for (std::size_t i = 0; i < block.size(); ++i)
    if (!is_allowed(block[i], scene))
      check_design(block[i], scene, designs > 1 ? fmt::format("design {}", first + i) : "");
}

/// At most so many at once: make_block() once a thread, and what it returns with the first design and how
/// many. what: the call, for messages.
template <class MakeBlock>
void in_blocks(std::string_view what, std::size_t designs, std::size_t most, const SolveOptions& options,
               const MakeBlock& make_block) {
  parallel_for_each((designs + most - 1) / most, options.threads, options.stop_requested, [&] {
    return [&, solve_block = make_block()](std::size_t block) mutable {
      const std::size_t first = block * most;
      solve_block(first, std::min(most, designs - first));
      if (options.stop_requested && options.stop_requested())
        throw Stopped(fmt::format("{} was stopped", what));
      return true;
    };
  });
}

}  // namespace

Outcome solve(const Design& design, const Scene& scene, const SolveOptions& options) {
  const Spec spec = spec_of(scene, options);
  check_design(design, scene);
  Outcome outcome;
  make_solver(request_with_ways(spec))({&design, 1}, {&outcome, 1});
  return outcome;
}

void solve_into(std::span<Outcome> outcomes, std::span<const Design> designs, const Scene& scene,
                const SolveOptions& options) {
  if (designs.size() != outcomes.size())
    throw InputError(
        fmt::format("{} outcomes for {} designs; allowed: equal numbers", outcomes.size(), designs.size()));
  const Spec spec = spec_of(scene, options);
  in_blocks("solve", designs.size(), designs_a_block(spec), options, [&] {
    return [&, solver = make_solver(request_of_outcomes(spec))](std::size_t first, std::size_t size) {
      check_designs(designs.subspan(first, size), scene, first, designs.size());
      solver(designs.subspan(first, size), outcomes.subspan(first, size));
    };
  });
}

void solve_blocks(std::size_t designs, const Scene& scene, const SolveOptions& options,
                  const std::vector<const Field*>& fields, const BlockEnds& ends) {
  const Spec spec = spec_of(scene, options);
  const Request request = request_of(spec, fields);
  in_blocks("solve", designs, designs_a_block(spec), options, [&] {
    const std::size_t most = std::min(designs, designs_a_block(spec));
    return [&, solver = make_solver(request), some = std::vector<Design>(most),
            outcomes = std::vector<Outcome>(most)](std::size_t first, std::size_t size) mutable {
      const std::span<Design> block = std::span(some).first(size);
      ends.fill(first, block);
      check_designs(block, scene, first, designs);
      solver(block, std::span(outcomes).first(size));
      ends.take(first, std::span(outcomes).first(size));
    };
  });
}

std::vector<Outcome> solve(std::span<const Design> designs, const Scene& scene, const SolveOptions& options) {
  std::vector<Outcome> outcomes(designs.size());
  solve_into(outcomes, designs, scene, options);
  return outcomes;
}

Design gradient(const Design& design, const OutcomeNumber& of, const Scene& scene,
                const SolveOptions& options) {
  return gradient(std::span(&design, 1), of, scene, options)[0];
}

std::vector<Design> gradient(std::span<const Design> designs, const OutcomeNumber& of, const Scene& scene,
                             const SolveOptions& options) {
  Spec spec = spec_of(scene, options);
  for (const Field* field : fields_of(scene))
    if (can_be_differentiated(*field) && number_of(*field) == of)
      spec.output.gradients = {std::string(field->name)};
  if (spec.output.gradients.empty())
    throw InputError(fmt::format(
        "of: has no derivatives, or is of jump {} where scene.jumps = {}; allowed: a quantity of one of "
        "the jumps",
        of.jump, scene.jumps));
  check_spec(spec);
  const Request request = request_of(spec, derivative_columns(scene, {of}));
  const GradientWanted wanted = derivatives_of(request);
  std::vector<Design> found(designs.size());
  constexpr std::size_t most = 256;
  in_blocks("gradient", designs.size(), most, options, [&] {
    return [&, solver = make_gradient_solver(request), gradients = Gradients(wanted),
            outcomes = std::vector<Outcome>(most)](std::size_t first, std::size_t size) mutable {
      check_designs(designs.subspan(first, size), scene, first, designs.size());
      solver(designs.subspan(first, size), std::span(outcomes).first(size), gradients);
      for (std::size_t i = 0; i < size; ++i) {
        for (double Design::*parameter : differentiable) found[first + i].*parameter = nan;
        for (std::size_t j = 0; j < wanted.by.size(); ++j)
          found[first + i].*differentiable[wanted.by[j]] = gradients.column(0, j)[i];
      }
    };
  });
  return found;
}

Motion trace(const Design& design, const Scene& scene, const TraceOptions& options) {
  const Spec spec = spec_of(scene, options);
  check_design(design, scene);
  if (!(options.interval >= 0.0 && options.interval < 1e9))
    throw InputError(fmt::format("interval = {} is out of range; allowed: a number of seconds in [0, 1e9)",
                                 options.interval));
  return tell(design, request_of_everything(spec), options.interval);
}

}  // namespace leapmap
