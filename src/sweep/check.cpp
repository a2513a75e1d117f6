// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "audit/audit_report.hpp"
#include "engine/map_layout.hpp"
#include "leapmap/errors.hpp"
#include "map/hdf5_virtual.hpp"
#include "map/layout.hpp"
#include "map/reader.hpp"
#include "map/schema.hpp"
#include "map/writer.hpp"
#include "request/solver.hpp"
#include "shards/shard.hpp"
#include "spec/map_spec.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace {

constexpr std::size_t most_findings = 20;
constexpr std::size_t most_samples_held = 10'000;
constexpr double beyond = 1e100;  // no quantity of a hoop is as large

/// A map being read through.
struct Check {
  const JournaledFile& bytes;
  const MapReader& map;
  const Spec& spec;
  const Tiling& tiling;
  const CheckOptions& options;
  CheckReport& report;
  StatusCounts statuses{};

  void find(const std::string& finding) {
    if (report.findings.size() < most_findings)
      report.findings.push_back(finding);
    else if (report.findings.size() == most_findings)
      report.findings.push_back("and more");
  }
  bool stopped() const { return options.stop_requested && options.stop_requested(); }
  std::string place(const Field& field, std::size_t tile) const {
    const Tile block = tiling.tile(tile);
    return fmt::format("{} in chunk {} ({} designs from number {})", field.name, tile, block.count,
                       tiling.number(block, 0));
  }
};

/// What is wrong with a field's values in a tile; empty: nothing.
std::string wrong_value(const Field& field, const std::vector<double>& values) {
  const auto* code = std::get_if<Code>(&field.source);
  if (!code && !std::holds_alternative<Quantity>(field.source)) return {};
  for (const double value : values) {
    const bool right = code ? (code->names.empty() && value >= 0.0 && value < 256.0) || value == code->fill ||
                                  (value >= 0.0 && value < static_cast<double>(code->names.size()))
                            : std::isnan(value) || std::abs(value) < beyond;
    if (!right) return fmt::format("holds {}, which no map does", value);
  }
  return {};
}

void check_tile(Check& check, const Field& field, std::size_t tile) {
  try {
    const std::vector<double> values = check.map.read(std::string(field.name), check.tiling.tile(tile));
    if (const std::string wrong = wrong_value(field, values); !wrong.empty())
      return check.find(fmt::format("{}: {}", check.place(field, tile), wrong));
    if (field.name == "status")
      for (const double value : values) ++check.statuses[static_cast<std::size_t>(value)];
  } catch (const IoError& error) {
    check.bytes.rethrow_failure();  // the system failed, and not the file to make sense
    check.find(fmt::format("{}: {}", check.place(field, tile), error.what()));
  }
}

/// The values of a virtual map are its shards', each of which tells what it has to be.
void check_shards(Check& check, const std::string& path) {
  CheckOptions options = check.options;
  options.sample = 0;
  for (const std::string& shard : check.map.shards()) {
    if (check.stopped()) return;
    const std::string beside = hdf5::path_beside(path, shard);
    if (!seal_holds(beside, options.locking).value_or(true))
      check.find(beside + ": its bytes are not those that were written");
    for (const std::string& finding : check_map(beside, options).findings)
      check.find(finding.starts_with(beside) ? finding : fmt::format("{}: {}", beside, finding));
  }
}

void check_tiles(Check& check, const MapLayout& layout) {
  for (std::size_t t = 0; t < check.report.tiles && !check.stopped(); ++t)
    for (const Field* field : layout.fields)
      if (!check.stopped()) check_tile(check, *field, t);
  const bool counted = std::ranges::any_of(layout.fields, [](const Field* f) { return f->name == "status"; });
  if (check.stopped() || !check.report.findings.empty()) return;
  if (counted && check.statuses != check.map.status_counts())
    check.find("status: the number of designs with each status differs from the map's counts");
  if (!tiles_are_as_written(check.map.file(), layout, check.tiling, check.report.tiles, "tiles"))
    check.find("the chunks are not those that were written: their checksum differs");
}

/// A sample of the finished tiles against another method.
void check_sample(Check& check) {
  if (check.options.sample == 0 || check.report.designs == 0) return;
  const double share =
      std::min(1.0, static_cast<double>(check.options.sample) / static_cast<double>(check.tiling.designs()));
  Spec sampled = check.spec;
  sampled.numerics.audit = share;  // what is compared of each design hangs on how many there are
  const Solver solve = make_solver(request_of(sampled));
  AuditReport audited = begin_audit(sampled);
  std::vector<AuditSample> samples;
  const auto look_at_samples = [&] {
    constexpr std::size_t by_referee_all = 1;
    merge(audited,
          audit(sampled, samples, check.options.threads, check.options.stop_requested, by_referee_all));
    samples.clear();
  };
  const StopScope scope(check.options.stop_requested);
  for (std::size_t t = 0; t < check.report.tiles && !check.stopped(); ++t) try {
      std::ranges::move(
          audit_samples(check.map, check.spec, share, check.tiling, check.tiling.tile(t), solve),
          std::back_inserter(samples));
      if (samples.size() >= most_samples_held) look_at_samples();
    } catch (const Stopped&) {
      return;
    }
  look_at_samples();
  check.bytes.rethrow_failure();
  for (const std::string& disagreement : disagreements(check.spec, audited)) check.find(disagreement);
  check.report.sample = audited;
}

/// How many tiles are there.
std::size_t tiles_of(const MapReader& map, const Tiling& tiling) {
  if (map.is_whole()) return tiling.size();
  const std::int64_t done = hdf5::read_integer(map.file(), "tiles_done", 0);
  if (static_cast<std::size_t>(done) > tiling.size())
    throw BrokenFile("tiles_done exceeds the number of chunks");
  return static_cast<std::size_t>(done);
}

/// The numbers and texts that the root has beside its datasets are of the kinds that they should be.
void check_attributes(Check& check) {
  const hid_t root = check.map.file();
  const auto look_at = [&](const char* name, const auto& read) {
    if (!hdf5::has_attribute(root, name)) return;
    try {
      read(name);
    } catch (const IoError& error) {
      check.bytes.rethrow_failure();
      check.find(error.what());
    }
  };
  for (const char* text : {"title", "program_version", "git_revision", "instruction_set", "math_library",
                           "date", "host", "method", "audit_method"})
    look_at(text, [&](const char* name) { hdf5::read_text(root, name); });
  for (const auto& [whole, least] :
       {std::pair{"threads", std::int64_t{1}}, {"shards", 1}, {"retry_designs", 0}, {"tiles_checksum", 0}})
    look_at(whole, [&, from = least](const char* name) { hdf5::read_integer(root, name, from); });
  for (const char* number : {"wall_time", "tolerance"})
    look_at(number, [&](const char* name) {
      if (!(hdf5::read_number(root, name) >= 0.0))
        throw BrokenFile(fmt::format("reading attribute {}: it is negative", name));
    });
  look_at("audit_designs", [&](const char*) { read_audit(check.map); });
}

void check_content(const JournaledFile& bytes, const MapReader& map, const std::string& path,
                   const CheckOptions& options, CheckReport& report) {
  const Spec spec = spec_of(map, path);
  const MapLayout layout = layout_of(spec);
  if (shape_of(spec) != map.shape()) throw BrokenFile(path + ": its spec describes other designs");
  const Tiling whole =
      map.blocks(std::string(layout.fields.front()->name));  // as it was cut by whoever wrote it
  const bool is_shard = hdf5::has_attribute(map.file(), shard_tiles_attribute);
  const Tiling tiling = is_shard ? whole.part(tiles_held(map.file(), whole.size())) : whole;
  report.whole = map.is_whole();
  report.tiles = tiles_of(map, tiling);
  report.designs = designs_in(map.status_counts());
  Check check{bytes, map, spec, tiling, options, report};
  check_attributes(check);
  check_layout(map.file(), layout, tiling, path);
  map.shards().empty() ? check_tiles(check, layout) : check_shards(check, path);
  if (report.findings.empty() && !check.stopped()) check_sample(check);
  constexpr std::array first_sealed{std::int64_t{1}, std::int64_t{4}};
  report.sealed = bytes.is_sealed();
  if (report.whole && !report.sealed &&
      !std::ranges::lexicographical_compare(hdf5::read_integers(map.file(), "version"), first_sealed))
    check.find("the checksum at its end is missing: another program changed the file, or it is truncated");
}

}  // namespace

std::optional<bool> seal_holds(const std::string& path, Locking locking) {
  return JournaledFile(path, JournaledFile::Access::read, locking).seal_holds();
}

CheckReport check_map(const std::string& path, const CheckOptions& options) {
  CheckReport report;
  hdf5::File file;
  try {
    file = hdf5::File::open(path, options.locking);
  } catch (const BrokenFile& error) {
    report.findings.push_back(error.what());
    return report;
  }
  try {
    check_content(file.bytes(), MapReader(path, file, Accept::shards_too), path, options, report);
  } catch (const InputError& error) {  // of its spec
    report.findings.push_back(error.what());
  } catch (const IoError& error) {
    file.bytes().rethrow_failure();
    report.findings.push_back(error.what());
  }
  return report;
}

}  // namespace leapmap
