// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>

#include "map/schema.hpp"
#include "sweep/designs.hpp"
#include "sweep/map_layout.hpp"
#include "sweep/options.hpp"
#include "sweep/parallel.hpp"

namespace leapmap {
namespace {

constexpr double audit_tolerance = 1e-13;
constexpr double own_error = 1e-11;  // an integration's at that tolerance, over a few revolutions
constexpr double adaptive_slack = 100.0;

/// splitmix64: a well-mixed number from a counter.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

struct Difference {
  bool flags = false;
  double height = 0.0, time = 0.0;
};

/// `ours` may lack what its sweep was not asked to store.
Difference difference(const Outcome& ours, const Outcome& theirs, const Output& output = {}) {
  Difference d;
  d.flags = !same_flags(ours, theirs);
  if (d.flags) return d;
  const auto compare = [&](std::string_view field, double Outcome::*member, double& most, bool is_relative) {
    const double a = ours.*member, b = theirs.*member;
    if (std::isnan(a) && std::isnan(b)) return;
    const double error = is_relative && b != 0.0 ? std::abs(a / b - 1.0) : std::abs(a - b);
    if (!std::isnan(error)) {
      most = std::max(most, error);
    } else if (stores(output, field)) {
      most = std::numeric_limits<double>::infinity();
    }
  };
  compare("jump_height", &Outcome::jump_height, d.height, false);
  compare("first_jump_height", &Outcome::first_jump_height, d.height, false);
  compare("dip", &Outcome::dip, d.height, false);
  compare("jump_time", &Outcome::jump_time, d.time, true);
  compare("first_jump_time", &Outcome::first_jump_time, d.time, true);
  compare("apex_time", &Outcome::apex_time, d.time, true);
  compare("flight_time", &Outcome::flight_time, d.time, true);
  return d;
}

/// What one unit in the last place of each parameter changes.
Difference sensitivity(const Solver& exact, const Design& design, const Spec& spec) {
  std::vector<Design> designs{design};
  for (const Option* parameter : design_parameters(spec)) {
    const auto member = std::get<ParameterSlot>(parameter->slot).member;
    if (design.*member == 0.0) continue;  // as written, and the number beside it is no rounding of it
    for (const double towards : {-1e300, 1e300}) {
      Design nudged = design;
      nudged.*member = std::nextafter(design.*member, towards);
      if (in_range(*parameter, nudged.*member)) designs.push_back(nudged);
    }
  }
  std::vector<Outcome> outcomes(designs.size());
  exact(designs, outcomes);
  Difference most;
  for (const Outcome& outcome : outcomes) {
    const Difference d = difference(outcomes[0], outcome);
    most = {most.flags || d.flags, std::max(most.height, d.height), std::max(most.time, d.time)};
  }
  return most;
}

}  // namespace

std::vector<std::size_t> audit_draw(double share, const Tiling& tiling, const Tile& tile) {
  const auto due = [&](std::size_t designs) {
    return static_cast<std::size_t>(std::ceil(share * static_cast<double>(designs)));
  };
  const std::size_t before = tiling.designs_before(tile), count = due(before + tile.count) - due(before);
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < count; ++i) {  // one at random from each of `count` equal shares of the tile
    const std::size_t begin = i * tile.count / count, end = std::max(begin + 1, (i + 1) * tile.count / count);
    drawn.push_back(begin + mix(before + i) % (end - begin));
  }
  return drawn;
}

std::vector<AuditSample> audit_samples(const Spec& spec, const Tiling& tiling, const Tile& tile,
                                       std::span<const Outcome> outcomes) {
  std::vector<AuditSample> samples;
  for (const std::size_t drawn : audit_draw(spec.numerics.audit, tiling, tile)) {
    samples.push_back({tiling.number(tile, drawn), outcomes[drawn]});
    for (const Field& field : map_fields()) {
      const auto* quantity = std::get_if<Quantity>(&field.source);
      if (!quantity) continue;
      double& value = samples.back().outcome.*quantity->member;
      const double unit = quantity->unit(time_unit(spec.scene)), stored = value * unit;
      value = (spec.output.precision == "f4" ? static_cast<float>(stored) : stored) / unit;
    }
  }
  return samples;
}

std::vector<AuditSample> audit_samples(const Spec& spec, const Tiling& tiling, const Tile& tile,
                                       const Solver& solve) {
  std::vector<AuditSample> samples;
  const DesignSpace space(spec);
  for (const std::size_t drawn : audit_draw(spec.numerics.audit, tiling, tile)) {
    samples.push_back({tiling.number(tile, drawn), {}});
    const Design design = space.at(samples.back().number);
    solve({&design, 1}, {&samples.back().outcome, 1});
  }
  return samples;
}

void take_quantities(const MapReader& map, const Spec& spec, const Tiling& tiling, const Tile& tile,
                     std::span<AuditSample> samples) {
  if (samples.empty()) return;
  const std::vector<std::size_t> drawn = audit_draw(spec.numerics.audit, tiling, tile);
  for (const Field& field : map_fields()) {
    const auto* quantity = std::get_if<Quantity>(&field.source);
    if (!quantity || !stores(spec, field)) continue;
    const std::vector<double> values = map.read(std::string(field.name), tile);
    const double unit = quantity->unit(time_unit(spec.scene));
    for (std::size_t i = 0; i < samples.size(); ++i)
      samples[i].outcome.*quantity->member = values[drawn[i]] / unit;
  }
}

std::string audit_method(const Numerics& numerics) {
  return resolved_method(numerics) == "exact" ? "gsl-rk8pd" : "exact";
}

AuditReport audit(const Spec& spec, std::span<const AuditSample> samples, int threads,
                  const std::function<bool()>& stop_requested) {
  const DesignSpace space(spec);
  const bool integrates = audit_method(spec.numerics) != "exact";
  const double rounding = spec.output.precision == "f4" ? std::numeric_limits<float>::epsilon() : 0.0;
  const double allowed =
      std::max(spec.numerics.tolerance * (integrates ? 1.0 : adaptive_slack), own_error) + rounding;
  AuditReport report;
  report.method = audit_method(spec.numerics);
  report.allowed_error = allowed;
  std::mutex reporting;
  parallel_for_each(samples.size(), threads, [&] {
    return [&, second = make_solver(spec, report.method, audit_tolerance),
            exact = make_solver(spec, "exact", audit_tolerance)](std::size_t i) {
      const auto& [number, ours] = samples[i];
      if (ours.status == Status::failed) {
        const std::lock_guard lock(reporting);
        ++report.designs, ++report.failed;
        return !(stop_requested && stop_requested());
      }
      const Design design = space.at(number);
      Outcome theirs;
      second({&design, 1}, {&theirs, 1});
      const Difference d = difference(ours, theirs, spec.output);
      const double height_allowed = allowed * (std::isnan(ours.jump_height) ? 1.0 : 1.0 + ours.jump_height);
      bool inaccurate = !d.flags && (d.height > height_allowed || d.time > allowed);
      bool undecided = theirs.status == Status::failed && ours.status != Status::failed;
      if ((d.flags || inaccurate) && !undecided) {
        const Difference ulp = sensitivity(exact, design, spec);
        undecided = ulp.flags;
        inaccurate = inaccurate && (d.height > std::max(height_allowed, 10.0 * ulp.height) ||
                                    d.time > std::max(allowed, 10.0 * ulp.time));
      }
      inaccurate = inaccurate && !undecided;
      const std::lock_guard lock(reporting);
      ++report.designs;
      if (undecided) {
        ++report.undecided;
      } else if (d.flags) {
        ++report.flag_mismatches;
        report.first_mismatch = std::min(report.first_mismatch.value_or(number), number);
      } else {
        report.max_abs_height_error = std::max(report.max_abs_height_error, d.height);
        report.max_rel_time_error = std::max(report.max_rel_time_error, d.time);
      }
      if (inaccurate) {
        ++report.beyond_tolerance;
        report.first_inaccurate = std::min(report.first_inaccurate.value_or(number), number);
      }
      return !(stop_requested && stop_requested());
    };
  });
  return report;
}

}  // namespace leapmap
