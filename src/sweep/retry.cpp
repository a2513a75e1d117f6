// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/retry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "audit/audit.hpp"
#include "engine/begin_map.hpp"
#include "engine/map_layout.hpp"
#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"
#include "map/reader.hpp"
#include "map/schema.hpp"
#include "map/writer.hpp"
#include "model/fields.hpp"
#include "request/solver.hpp"
#include "spec/designs.hpp"
#include "spec/map_spec.hpp"
#include "support/output_file.hpp"

namespace leapmap {
namespace {

constexpr auto failed = static_cast<double>(Status::failed);

/// A failed design: its tile, its place in it, and what it comes to now.
struct Failed {
  std::size_t tile, index;
  Outcome outcome;
};

/// Solves some designs on all threads, a few at a time.
void solve(const Spec& spec, const Tiling& tiling, std::vector<Failed>& designs, int threads,
           const std::function<bool()>& stop_requested) {
  constexpr std::size_t at_once = 64;
  const DesignSpace space(spec);
  parallel_for_each((designs.size() + at_once - 1) / at_once, threads, stop_requested, [&] {
    return [&, solver = make_solver(request_of(spec))](std::size_t group) {
      std::vector<Design> some;
      const std::size_t first = group * at_once, last = std::min(first + at_once, designs.size());
      for (std::size_t i = first; i < last; ++i)
        some.push_back(space.at(tiling.number(tiling.tile(designs[i].tile), designs[i].index)));
      std::vector<Outcome> outcomes(some.size());
      try {
        solver(some, outcomes);
      } catch (const Stopped&) {
        return false;
      }
      for (std::size_t i = first; i < last; ++i) designs[i].outcome = outcomes[i - first];
      return !(stop_requested && stop_requested());
    };
  });
}

/// The same for a field of words, of which a double would not hold every bit.
void store_words(hid_t dataset, const Word& word, const Tile& tile, std::span<const Failed> designs,
                 const std::string& what) {
  std::vector<std::uint64_t> values = hdf5::read_words(dataset, tile.start, tile.extent, what);
  for (const Failed& design : designs) values[design.index] = design.outcome.*word.member;
  hdf5::write_words(dataset, tile.start, tile.extent, values, what);
}

double stored_value(const Field& field, const Outcome& outcome) {
  const auto* code = std::get_if<Code>(&field.source);
  return code ? code->value(outcome) : number_of(field)->of(outcome);
}

/// Puts the outcomes of one tile's designs in their places in every field.
void store(hid_t file, const Spec& spec, const Tile& tile, std::span<const Failed> designs) {
  for (const Field* row : columns_of(spec)) {
    const Field& field = *row;
    if (std::holds_alternative<Derivative>(field.source) || std::holds_alternative<OfMade>(field.source) ||
        field.of_proof)
      continue;  // of a failed design there are none, and what is proved hangs on no method
    const std::string name(field.name), what = "retrying failed designs in " + name;
    hdf5::Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, what);
    if (const auto* word = std::get_if<Word>(&field.source)) {
      store_words(dataset, *word, tile, designs, what);
    } else {
      std::vector<double> values = hdf5::read_block(dataset, tile.start, tile.extent, what);
      for (const Failed& design : designs) values[design.index] = stored_value(field, design.outcome);
      hdf5::write_block(dataset, tile.start, tile.extent, values, what);
    }
    dataset.close(what);  // which writes the chunk
  }
}

/// Solves every failed design of the copy and says so in it. Nothing: a stop was requested.
std::optional<RetryReport> resolve_all(const hdf5::File& file, const std::string& path, const Spec& spec,
                                       int threads, const std::function<bool()>& stop_requested) {
  constexpr std::size_t most_at_once = 100'000;
  const MapReader map(path, file);
  if (!map.is_whole()) throw InputError(path + ": is incomplete; allowed: a complete map, by sweep --resume");
  if (!wants(request_of(spec), "status"))
    throw InputError(path + ": lacks the field status; allowed: a map with it");
  const MapLayout layout = layout_of(spec);
  const Tiling tiling =
      map.blocks(std::string(layout.fields.front()->name));  // as whoever wrote it has cut it
  check_layout(file, layout, tiling, path);
  if (!tiles_are_as_written(file, layout, tiling, tiling.size(), path))
    throw BrokenFile(path +
                     ": is damaged: its chunks are not what was written; leapmap check shows the place");
  RetryReport report;
  std::vector<Failed> waiting;
  const auto resolve = [&] {
    solve(spec, tiling, waiting, threads, stop_requested);
    for (auto first = waiting.begin(); first != waiting.end();) {
      const auto last =
          std::find_if(first, waiting.end(), [&](const Failed& f) { return f.tile != first->tile; });
      store(file, spec, tiling.tile(first->tile), {first, last});
      first = last;
    }
    report.retried += waiting.size();
    for (const Failed& design : waiting) ++report.statuses[static_cast<std::size_t>(design.outcome.status)];
    waiting.clear();
  };
  for (std::size_t t = 0; t < tiling.size(); ++t) {
    const std::vector<double> statuses = map.read("status", tiling.tile(t));
    const std::vector<double> ends =
        map.has("sequence_end") ? map.read("sequence_end", tiling.tile(t)) : statuses;
    for (std::size_t i = 0; i < statuses.size(); ++i) {
      if (statuses[i] == failed || ends[i] == failed) {
        waiting.push_back({t, i, {}});
      } else if (statuses[i] >= 0.0 && statuses[i] < status_count) {
        ++report.statuses[static_cast<std::size_t>(statuses[i])];
      }
    }
    if (waiting.size() >= most_at_once || t + 1 == tiling.size()) resolve();
    if (stop_requested && stop_requested()) return std::nullopt;
  }
  report.still_failed = static_cast<std::size_t>(report.statuses[static_cast<std::size_t>(Status::failed)]);
  write_tiles_checksum(file, layout, tiling, path);
  hdf5::write_attribute(file, "status_counts", report.statuses);
  const std::int64_t before =
      hdf5::has_attribute(file, "retry_designs") ? hdf5::read_integer(file, "retry_designs", 0) : 0;
  hdf5::write_attribute(file, "retry_designs", before + static_cast<std::int64_t>(report.retried));
  hdf5::write_attribute(file, "retry_method", resolved_method(spec));
  hdf5::write_attribute(file, "retry_tolerance", spec.numerics.tolerance);
  return report;
}

}  // namespace

Numerics retry_numerics(const Numerics& there, const Numerics& here, const Scene& scene) {
  const bool other = resolved_method(there, scene) != resolved_method(here, scene) ||
                     there.tolerance != here.tolerance ||
                     there.absolute_tolerance != here.absolute_tolerance ||
                     there.fixed_step != here.fixed_step || there.max_steps != here.max_steps;
  if (other) return here;
  Numerics numerics;
  numerics.method = audit_method(there, scene);
  numerics.tolerance = std::min(there.tolerance, 1e-12);
  return numerics;
}

std::optional<RetryReport> retry_with(const std::string& path, const Spec& spec, int threads, Locking locking,
                                      const std::function<bool()>& stop_requested) {
  const JournaledFile original(path, JournaledFile::Access::read, locking);
  std::optional<hdf5::File> file =
      hdf5::File::copy(original, path + ".retry", map_filetype, locking, stop_requested);
  if (!file) return std::nullopt;
  try {
    auto report = resolve_all(*file, path, spec, threads, stop_requested);
    if (!report || report->retried == 0) {
      file->discard();
      return report;
    }
    if (!original.is_named(path)) throw IoError(path + ": another program has replaced or removed it");
    report->durable = file->finish(path, true, [&](hid_t written) {
      const MapLayout layout = layout_of(spec);
      const Tiling tiling = MapReader(path, written).blocks(std::string(layout.fields.front()->name));
      check_layout(written, layout, tiling, path + ".retry");
      if (!tiles_are_as_written(written, layout, tiling, tiling.size(), path))
        throw BrokenFile(path + ".retry: its chunks are not what was written");
    });
    return report;
  } catch (...) {
    file->discard();
    throw;
  }
}

std::optional<RetryReport> retry_failed(const std::string& path, const RetryOptions& options) {
  if (options.how) {
    Spec asked;
    asked.numerics = *options.how;
    check_spec(asked);
  }
  const Locking locking = options.lock ? Locking::required : Locking::if_possible;
  const std::string map = behind_links(path);
  Spec spec = [&] {
    const MapReader reader(map, locking);
    return spec_of(reader, map);
  }();
  spec.numerics = retry_numerics(spec.numerics, options.how.value_or(spec.numerics), spec.scene);
  return retry_with(map, spec, options.threads, locking, latched(options.stop_requested));
}

}  // namespace leapmap
