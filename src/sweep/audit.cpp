// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>

#include "map/schema.hpp"
#include "support/errors.hpp"
#include "sweep/map_layout.hpp"
#include "sweep/options.hpp"
#include "sweep/parallel.hpp"

namespace leapmap {
namespace {

constexpr double audit_tolerance = 1e-13, coarser_tolerance = 1e-12;
constexpr double audit_reach =
    1e-11;  // relative: how far off an integration at that tolerance may see a flag flip
constexpr double own_error = 1e-11;  // an integration's at that tolerance, over a few revolutions
constexpr double adaptive_slack = 100.0;

/// splitmix64: a well-mixed number from a counter.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

using Difference = AuditDifference;

Difference larger(const Difference& a, const Difference& b, double weight) {
  return {a.flags || b.flags, std::max(a.height, weight * b.height), std::max(a.time, weight * b.time),
          std::max(a.motion, weight * b.motion)};
}

/// `ours` may lack what its sweep was not asked to store.
Difference difference(const Outcome& ours, const Outcome& theirs, const Output& output = {}) {
  Difference d;
  d.flags = !same_flags(ours, theirs);
  if (d.flags) return d;
  for (const Field& field : map_fields()) {
    const auto* quantity = std::get_if<Quantity>(&field.source);
    if (!quantity) continue;
    const double a = ours.*quantity->member, b = theirs.*quantity->member;
    if (std::isnan(a) && std::isnan(b)) continue;
    const Measure measure = quantity->measure;
    double& most = measure == Measure::height ? d.height : measure == Measure::time ? d.time : d.motion;
    double error = std::abs(a - b);
    if (measure == Measure::time && b != 0.0) error = std::abs(a / b - 1.0);
    if (measure == Measure::other) error /= 1.0 + std::abs(b);
    if (!std::isnan(error)) {
      most = std::max(most, error);
    } else if (stores(output, field.name)) {
      most = std::numeric_limits<double>::infinity();
    }
  }
  return d;
}

/// The design with each parameter some relative distance away, either way; 0: one unit in the last place.
std::vector<Design> beside(const Design& design, const Spec& spec, double distance) {
  std::vector<Design> designs;
  for (const Option* parameter : design_parameters(spec)) {
    const auto member = std::get<ParameterSlot>(parameter->slot).member;
    const double value = design.*member;
    if (value == 0.0) continue;  // as written, and the number beside it is no rounding of it
    for (const double way : {-1.0, 1.0}) {
      Design nudged = design;
      nudged.*member =
          distance > 0.0 ? value * (1.0 + way * distance) : std::nextafter(value, way * HUGE_VAL);
      if (in_range(*parameter, nudged.*member)) designs.push_back(nudged);
    }
  }
  return designs;
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

std::vector<AuditSample> audit_samples(const MapReader& map, const Spec& spec, double share,
                                       const Tiling& tiling, const Tile& tile, const Solver& solve) {
  const std::vector<std::size_t> drawn = audit_draw(share, tiling, tile);
  std::vector<AuditSample> samples;
  const DesignSpace space(spec);
  for (const std::size_t index : drawn) {
    samples.push_back({tiling.number(tile, index), {}});
    const Design design = space.at(samples.back().number);
    solve({&design, 1}, {&samples.back().outcome, 1});
  }
  for (const Field& field : map_fields()) {
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
      const double unit = quantity->unit(time_unit(spec.scene));
      place(values, [&](Outcome& outcome, double value) { outcome.*quantity->member = value / unit; });
    } else {
      const auto& code = std::get<Code>(field.source);
      place(values,
            [&](Outcome& outcome, double value) { code.put(outcome, static_cast<std::uint8_t>(value)); });
    }
  }
  return samples;
}

std::string audit_method(const Numerics& numerics) {
  return resolved_method(numerics) == "exact" ? "gsl-rk8pd" : "exact";
}

void merge(AuditReport& report, const AuditReport& other) {
  const auto least = [](std::optional<std::size_t>& mine, const std::optional<std::size_t>& theirs) {
    if (theirs) mine = std::min(mine.value_or(*theirs), *theirs);
  };
  report.designs += other.designs;
  report.max_abs_height_error = std::max(report.max_abs_height_error, other.max_abs_height_error);
  report.max_rel_time_error = std::max(report.max_rel_time_error, other.max_rel_time_error);
  report.max_rel_motion_error = std::max(report.max_rel_motion_error, other.max_rel_motion_error);
  report.failed += other.failed;
  report.flag_mismatches += other.flag_mismatches;
  report.undecided += other.undecided;
  report.beyond_tolerance += other.beyond_tolerance;
  least(report.first_mismatch, other.first_mismatch);
  least(report.first_inaccurate, other.first_inaccurate);
}

namespace {

/// The attributes that count designs, each with its member.
constexpr std::array counts{std::pair{"audit_designs", &AuditReport::designs},
                            std::pair{"audit_flag_mismatches", &AuditReport::flag_mismatches},
                            std::pair{"audit_undecided", &AuditReport::undecided},
                            std::pair{"audit_beyond_tolerance", &AuditReport::beyond_tolerance},
                            std::pair{"audit_failed", &AuditReport::failed}};
constexpr std::array errors{std::pair{"audit_max_abs_height_error", &AuditReport::max_abs_height_error},
                            std::pair{"audit_max_rel_time_error", &AuditReport::max_rel_time_error},
                            std::pair{"audit_max_rel_motion_error", &AuditReport::max_rel_motion_error},
                            std::pair{"audit_allowed_error", &AuditReport::allowed_error}};
constexpr std::array firsts{std::pair{"audit_first_mismatch", &AuditReport::first_mismatch},
                            std::pair{"audit_first_inaccurate", &AuditReport::first_inaccurate}};

}  // namespace

std::vector<hdf5::Attribute> audit_attributes(const AuditReport& report) {
  std::vector<hdf5::Attribute> attributes;
  for (const auto& [name, member] : counts)
    attributes.emplace_back(name, static_cast<std::int64_t>(report.*member));
  for (const auto& [name, member] : errors) attributes.emplace_back(name, report.*member);
  for (const auto& [name, member] : firsts)
    attributes.emplace_back(
        name, (report.*member) ? static_cast<std::int64_t>(*(report.*member)) : std::int64_t{-1});
  return attributes;
}

AuditReport read_audit(const MapReader& map) {
  AuditReport report;
  report.method = map.attribute("audit_method");
  const auto designs = static_cast<std::int64_t>(Tiling(map.shape()).designs());
  const auto count = [&](const char* name, std::int64_t least, std::int64_t most) {
    const std::int64_t value = hdf5::read_integers(map.file(), name)[0];
    if (value < least || value > most) throw BrokenFile(fmt::format("is damaged: its {} is {}", name, value));
    return value;
  };
  for (const auto& [name, member] : counts)
    report.*member = static_cast<std::size_t>(count(name, 0, designs));
  for (const auto& [name, member] : errors)
    if (member != &AuditReport::max_rel_motion_error || hdf5::has_attribute(map.file(), name))
      report.*member = hdf5::read_number(map.file(), name);  // older maps have no error of the motion
  for (const auto& [name, member] : firsts)
    if (const std::int64_t design = count(name, -1, designs - 1); design >= 0)
      report.*member = static_cast<std::size_t>(design);
  return report;
}

Auditor::Auditor(const Spec& spec)
    : spec_(spec),
      space_(spec),
      second_(make_solver(spec, audit_method(spec.numerics), audit_tolerance)),
      coarser_(make_solver(spec, audit_method(spec.numerics), coarser_tolerance)) {
  const bool integrates = audit_method(spec.numerics) != "exact";
  const double rounding = spec.output.precision == "f4" ? std::numeric_limits<float>::epsilon() : 0.0;
  allowed_ = std::max(spec.numerics.tolerance * (integrates ? 1.0 : adaptive_slack), own_error) + rounding;
}

AuditReport Auditor::begin() const {
  AuditReport report;
  report.method = audit_method(spec_.numerics);
  report.allowed_error = allowed_;
  return report;
}

/// What the second method itself is in doubt about: what one unit in the last place of the inputs makes of
/// its answer, and what a coarser tolerance does, ten times either; for flags, whether they flip within its
/// own error. The solver under audit has no say in it.
Difference Auditor::doubt_of(const Design& design, const Outcome& theirs, bool of_flags) const {
  std::vector<Design> designs = beside(design, spec_, 0.0);
  if (of_flags) std::ranges::copy(beside(design, spec_, audit_reach), std::back_inserter(designs));
  std::vector<Outcome> outcomes(designs.size());
  second_(designs, outcomes);
  outcomes.emplace_back();
  coarser_({&design, 1}, {&outcomes.back(), 1});
  Difference doubt;
  for (const Outcome& outcome : outcomes) doubt = larger(doubt, difference(outcome, theirs), 10.0);
  return doubt;
}

void Auditor::look_at(const AuditSample& sample, AuditReport& report) const {
  const auto& [number, ours] = sample;
  ++report.designs;
  if (ours.status == Status::failed) {
    ++report.failed;
    return;
  }
  const Design design = space_.at(number);
  Outcome theirs;
  second_({&design, 1}, {&theirs, 1});
  const Difference d = difference(ours, theirs, spec_.output);
  const double height_allowed = allowed_ * (std::isnan(ours.jump_height) ? 1.0 : 1.0 + ours.jump_height);
  const auto exceeds = [&](const Difference& doubt) {
    return d.height > std::max(height_allowed, doubt.height) || d.time > std::max(allowed_, doubt.time) ||
           d.motion > std::max(allowed_, doubt.motion);
  };
  bool inaccurate = !d.flags && exceeds({});
  bool undecided = theirs.status == Status::failed;
  if ((d.flags || inaccurate) && !undecided) {
    const Difference doubt = doubt_of(design, theirs, d.flags);
    undecided = doubt.flags;
    inaccurate = inaccurate && exceeds(doubt);
  }
  if (undecided) {
    ++report.undecided;
    return;
  }
  if (d.flags) {
    ++report.flag_mismatches;
    report.first_mismatch = std::min(report.first_mismatch.value_or(number), number);
    return;
  }
  report.max_abs_height_error = std::max(report.max_abs_height_error, d.height);
  report.max_rel_time_error = std::max(report.max_rel_time_error, d.time);
  report.max_rel_motion_error = std::max(report.max_rel_motion_error, d.motion);
  if (!inaccurate) return;
  ++report.beyond_tolerance;
  report.first_inaccurate = std::min(report.first_inaccurate.value_or(number), number);
}

AuditReport audit(const Spec& spec, std::span<const AuditSample> samples, int threads,
                  const std::function<bool()>& stop_requested) {
  AuditReport report = Auditor(spec).begin();
  std::mutex reporting;
  parallel_for_each(samples.size(), threads, [&] {
    return [&, auditor = Auditor(spec)](std::size_t i) {
      AuditReport one;
      auditor.look_at(samples[i], one);
      const std::lock_guard lock(reporting);
      merge(report, one);
      return !(stop_requested && stop_requested());
    };
  });
  return report;
}

}  // namespace leapmap
