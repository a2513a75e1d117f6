// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/audit_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/map_layout.hpp"
#include "hoop/units.hpp"
#include "map/hdf5.hpp"
#include "model/fields.hpp"
#include "model/variable.hpp"
#include "numerics/mixed.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"
#include "trajectory/later_jump.hpp"

namespace leapmap {
namespace {

/// As a map in f4 keeps it.
void round_to_single(Outcome& outcome) {
  const auto round = [](double& value) { value = static_cast<float>(value); };
  for (const Field& field : map_fields())
    if (const auto* quantity = std::get_if<Quantity>(&field.source)) round(outcome.*quantity->member);
  for (Jump& jump : outcome.later_jumps)
    for (const JumpRow& row : jump_rows) round(jump.*row.later);
}

}  // namespace

std::vector<std::size_t> audit_draw(double share, const Tiling& tiling, const Tile& tile) {
  return audit_draw(share, tiling, tile, 0, tile.count);
}

std::vector<std::size_t> audit_draw(double share, const Tiling& tiling, const Tile& tile, std::size_t first,
                                    std::size_t designs) {
  const auto due = [&](std::size_t so_many) {
    return static_cast<std::size_t>(std::ceil(share * static_cast<double>(so_many)));
  };
  const std::size_t before = tiling.designs_before(tile), count = due(before + tile.count) - due(before);
  std::vector<std::size_t> drawn;
  for (std::size_t i = first * count / tile.count; i < count; ++i) {
    // One at random from each of `count` equal shares of the tile.
    const std::size_t begin = i * tile.count / count, end = std::max(begin + 1, (i + 1) * tile.count / count);
    if (begin >= first + designs) break;
    const std::size_t one = begin + mixed(before + i) % (end - begin);
    if (one >= first && one < first + designs) drawn.push_back(one);
  }
  return drawn;
}

std::vector<AuditSample> audit_samples(const Spec& spec, const Tiling& tiling, const Tile& tile,
                                       std::size_t first, std::span<const Outcome> outcomes,
                                       const Gradients& gradients) {
  std::vector<AuditSample> samples;
  const bool single = spec.output.precision == "f4";
  const GradientWanted& derivatives = gradients.wanted();
  for (const std::size_t drawn : audit_draw(spec.numerics.audit, tiling, tile, first, outcomes.size())) {
    samples.push_back({tiling.number(tile, drawn), outcomes[drawn - first]});
    if (single) round_to_single(samples.back().outcome);
    for (std::size_t i = 0; i < derivatives.of.size(); ++i)
      for (std::size_t j = 0; j < derivatives.by.size(); ++j) {
        const double value = gradients.column(i, j)[drawn - first];
        samples.back().gradient.push_back(single ? static_cast<float>(value) : value);
      }
  }
  return samples;
}

namespace {

/// The solver by which failed designs of the map were retried.
Solver retry_solver(const MapReader& map, const Spec& spec) {
  Request request = request_of(spec);
  request.numerics = {.method = hdf5::read_text(map.file(), "retry_method"),
                      .tolerance = hdf5::read_number(map.file(), "retry_tolerance")};
  return make_solver(request);
}

/// The derivatives by the ratios, which a map lacks that has those by numbers of [hoop], solved again; NaN
/// where the map's do not follow from them.
void derive_by_ratios(const MapReader& map, const Request& request, const Tile& tile,
                      const DesignSpace& space, const std::vector<std::size_t>& drawn,
                      std::span<const Design> designs, Gradients& solved) {
  std::vector<Outcome> outcomes(designs.size());
  make_gradient_solver(request)(designs, outcomes, solved);
  std::vector<Body> bodies(drawn.size(), request.hoop.value_or(Body{}));
  Design unused;
  for (std::size_t i = 0; i < drawn.size() && space.varies_body(); ++i)
    space.fill(tile, drawn[i], {&unused, 1}, {&bodies[i], 1});
  constexpr double near = 1e-9;  // roundings of the chain rule, and of f4 more
  for (const Field* column : request.columns) {
    const auto* derivative = std::get_if<Derivative>(&column->source);
    if (!derivative || derivative->by) continue;
    const Variable variable = *find_variable(derivative->hoop, &bodies[0]);
    const std::vector<double> stored = map.read(std::string(column->name), tile);
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const Design by = solved.of_design(derivative->of, i);
      const double right = variable.derivative(
          by, bodies[i], ByScale::of(designs[i], by, in_seconds(derivative->of, outcomes[i]), request.held));
      const double single = stored[drawn[i]] == static_cast<float>(stored[drawn[i]]) ? 1e-6 : 0.0;
      if (std::abs(stored[drawn[i]] - right) <= (near + single) * (1.0 + std::abs(right))) continue;
      if (std::isnan(stored[drawn[i]]) && std::isnan(right)) continue;
      solved.scale(derivative->of, i, std::numeric_limits<double>::quiet_NaN());
    }
  }
}

/// What the map has of the derivatives that are compared.
void read_gradients(const MapReader& map, const Spec& spec, const Tile& tile,
                    const std::vector<std::size_t>& drawn, std::span<const Design> designs,
                    std::vector<AuditSample>& samples) {
  const Request request = request_of(spec);
  const GradientWanted derivatives = derivatives_of(request);
  Gradients solved(derivatives);
  if (derives_by_body(request))
    derive_by_ratios(map, request, tile, DesignSpace(spec), drawn, designs, solved);
  for (const auto of : derivatives.of)
    for (const std::size_t by : derivatives.by) {
      const std::string name(find_gradient(of, differentiable[by])->name);
      const bool is_stored = map.has(name);
      const std::vector<double> values = is_stored ? map.read(name, tile) : std::vector<double>{};
      for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i].gradient.push_back(is_stored ? values[drawn[i]]
                                                : solved.column(of, differentiable[by])[i]);
    }
}

}  // namespace

std::vector<AuditSample> audit_samples(const MapReader& map, const Spec& spec, double share,
                                       const Tiling& tiling, const Tile& tile, const Solver& solve) {
  const std::vector<std::size_t> drawn = audit_draw(share, tiling, tile);
  std::vector<AuditSample> samples;
  const DesignSpace space(spec);
  std::vector<Design> designs;
  for (const std::size_t index : drawn) {
    samples.push_back({tiling.number(tile, index), {}});
    designs.push_back(space.at(samples.back().number));
  }
  std::vector<Outcome> outcomes(designs.size());
  solve(designs, outcomes);
  std::vector<bool> gave_up;  // the map's method on them: settled since, if they are, without derivatives
  for (const Outcome& outcome : outcomes) gave_up.push_back(outcome.status == Status::failed);
  const bool retried =
      std::ranges::find(gave_up, true) != gave_up.end() && hdf5::has_attribute(map.file(), "retry_designs");
  if (retried) {
    const Solver retry = retry_solver(map, spec);  // for what the map does not store of them
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (gave_up[i]) retry({&designs[i], 1}, {&outcomes[i], 1});
  }
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].outcome = std::move(outcomes[i]);
  if (!samples.empty()) read_gradients(map, spec, tile, drawn, designs, samples);
  if (retried)
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (gave_up[i]) samples[i].gradient.clear();
  for (const Field* each : fields_of(spec.scene)) {
    const Field& field = *each;
    if (samples.empty() || !map.has(std::string(field.name))) continue;
    const auto place = [&](const auto& values, const auto& put) {
      for (std::size_t i = 0; i < samples.size(); ++i) put(samples[i].outcome, values[drawn[i]]);
    };
    if (const auto* word = std::get_if<Word>(&field.source)) {
      place(map.read_words(std::string(field.name), tile),
            [&](Outcome& outcome, std::uint64_t value) { outcome.*word->member = value; });
      continue;
    }
    const std::vector<double> values = map.read(std::string(field.name), tile);
    if (const auto* quantity = std::get_if<Quantity>(&field.source)) {
      place(values, [&](Outcome& outcome, double value) { outcome.*quantity->member = value; });
    } else if (const auto* later = std::get_if<OfJump>(&field.source)) {
      place(values, [&](Outcome& outcome, double value) {
        if (double* kept = later->number.in(outcome)) *kept = value;
      });
    } else {
      const auto& code = std::get<Code>(field.source);
      place(values,
            [&](Outcome& outcome, double value) { code.put(outcome, static_cast<std::uint8_t>(value)); });
    }
  }
  return samples;
}

}  // namespace leapmap
