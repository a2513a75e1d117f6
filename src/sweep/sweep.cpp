// SPDX-License-Identifier: GPL-3.0-or-later
/// From a spec to a map: solves, encodes and audits tiles on all threads, and writes them in order.
#include "leapmap/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "audit/audit.hpp"
#include "engine/begin_map.hpp"
#include "engine/engine.hpp"
#include "engine/map_layout.hpp"
#include "engine/parallel.hpp"
#include "engine/provenance.hpp"
#include "map/schema.hpp"
#include "map/writer.hpp"
#include "proof/cells.hpp"
#include "request/request.hpp"
#include "shards/shard.hpp"
#include "spec/designs.hpp"
#include "support/output_file.hpp"

namespace leapmap {
namespace {

using SteadyClock = std::chrono::steady_clock;
double seconds_since(SteadyClock::time_point begin) {
  return std::chrono::duration<double>(SteadyClock::now() - begin).count();
}

/// What a tile adds to the map and to what is known of it.
struct FinishedTile {
  EncodedTile encoded;
  AuditReport audit;
  double audit_seconds = 0.0;
};

/// One sweep into a map that is open.
class Sweeping {
 public:
  Sweeping(const Spec& spec, const MapLayout& layout, const Tiling& tiling, const SweepOptions& options,
           MapWriter& writer)
      : spec_(spec),
        layout_(layout),
        tiling_(tiling),
        options_(options),
        writer_(writer),
        seconds_before_(writer.progress().seconds) {
    if (spec.numerics.audit > 0.0)
      audit_ = writer.progress().tiles > 0 ? read_audit(writer.reader()) : begin_audit(spec);
  }

  /// Solves and audits what is missing in the map, committing now and then.
  void run() {
    tell_progress();
    EngineOptions engine{options_.threads, writer_.progress().tiles, options_.stop_requested};
    run_sweep(spec_, request_of(spec_), tiling_, engine, [&] { return work(); });
    put_seconds();
  }
  /// Of what was solved so far.
  std::vector<hdf5::Attribute> attributes() const {
    return audit_ ? audit_attributes(*audit_) : std::vector<hdf5::Attribute>{};
  }

  const std::optional<AuditReport>& audit() const { return audit_; }
  /// Of this call, less what the audit took of the threads.
  double solving_seconds() const {
    const auto threads = static_cast<std::size_t>(thread_count(options_.threads));
    if (tiling_.size() == 0) return 0.0;
    return seconds_ - audit_seconds_ / static_cast<double>(std::min(threads, tiling_.size()));
  }

 private:
  bool stop_requested() const { return options_.stop_requested && options_.stop_requested(); }
  void tell_progress() const {
    if (options_.progress) options_.progress(writer_.progress().designs(), tiling_.designs());
  }

  /// A thread's way of finishing tiles.
  TileWork work() {
    const auto encoder = std::make_shared<TileEncoder>(layout_, tiling_);
    const auto auditor = audit_ ? std::make_shared<Auditor>(spec_) : nullptr;
    const auto proofs = wants_proofs(request_of(spec_)) ? std::make_shared<ProofColumns>(spec_) : nullptr;
    const auto drawn = std::make_shared<std::vector<AuditSample>>();  // of the tile in hand
    return {
        [this, encoder, drawn, auditor, proofs](const Tile& tile, std::size_t first, const Solved& solved) {
          if (proofs) proofs->prove(tiling_, tile, first, solved.outcomes.size());
          encoder->take(first, solved.outcomes, [&](const Field& field) {
            return field.of_proof ? proofs->column(field) : solved.column(field);
          });
          if (auditor)
            std::ranges::copy(audit_samples(spec_, tiling_, tile, first, solved.outcomes, solved.gradients),
                              std::back_inserter(*drawn));
        },
        [this, encoder, drawn, auditor](std::size_t number, const Tile&) -> Prepared {
          const auto finished = std::make_shared<FinishedTile>();
          finished->encoded = encoder->encode(number);
          const std::vector<AuditSample> samples = std::exchange(*drawn, {});
          if (auditor && !look_at(*auditor, samples, *finished)) return {};
          return {[this, finished] { store(*finished); }, finished->encoded.bytes() + sizeof(FinishedTile)};
        }};
  }

  /// A tile's share of the audit. False: a stop was requested meanwhile.
  bool look_at(const Auditor& auditor, const std::vector<AuditSample>& samples,
               FinishedTile& finished) const {
    const auto begin = SteadyClock::now();
    finished.audit = begin_audit(spec_);
    for (const AuditSample& sample : samples) {
      if (stop_requested()) return false;
      auditor.look_at(sample, finished.audit);
    }
    finished.audit_seconds = seconds_since(begin);
    return true;
  }

  void store(const FinishedTile& tile) {
    writer_.write(tile.encoded);
    if (audit_) merge(*audit_, tile.audit);
    audit_seconds_ += tile.audit_seconds;
    tell_progress();
    if (seconds_since(last_commit_) >= options_.commit_interval) commit();
  }

  void put_seconds() {
    seconds_ = seconds_since(begin_);
    writer_.set_seconds(seconds_before_ + seconds_);
  }
  void commit() {
    put_seconds();
    writer_.commit(attributes());
    last_commit_ = SteadyClock::now();
  }

  const Spec& spec_;
  const MapLayout& layout_;
  const Tiling& tiling_;
  const SweepOptions& options_;
  MapWriter& writer_;
  std::optional<AuditReport> audit_;
  double seconds_before_, seconds_ = 0.0, audit_seconds_ = 0.0;  // the last one summed over threads
  SteadyClock::time_point begin_ = SteadyClock::now(), last_commit_ = begin_;
};

/// The report on a map that is whole already.
Report report_on(const std::string& map, const Tiling& tiling, Locking locking) {
  const MapReader whole(map, locking, Accept::shards_too);
  Report report{.whole = true, .was_whole = true, .designs = tiling.designs()};
  report.done = report.designs;
  if (hdf5::has_attribute(whole.file(), "status_counts")) report.statuses = whole.status_counts();
  if (hdf5::has_attribute(whole.file(), "audit_first_mismatch")) report.audit = read_audit(whole);
  return report;
}

Report fill(const Spec& spec, const MapLayout& layout, const Tiling& tiling, const SweepOptions& options,
            MapWriter& writer) {
  const std::size_t already = writer.progress().designs();
  Sweeping sweeping(spec, layout, tiling, options, writer);
  sweeping.run();
  Report report{.designs = tiling.designs(), .done = writer.progress().designs()};
  report.solved = report.done - already;
  report.statuses = writer.progress().statuses;
  report.seconds = sweeping.solving_seconds();
  report.audit = sweeping.audit();
  report.whole = writer.progress().tiles == tiling.size();
  if (report.whole)
    report.durable = writer.finish(sweeping.attributes());
  else
    writer.keep(sweeping.attributes());
  return report;
}

}  // namespace

Report sweep(const Spec& spec, const std::string& path, const SweepOptions& asked) {
  check_spec(spec);
  if (wants_proofs(request_of(spec))) static_cast<void>(Cells(spec));  // before anything is written
  if (spec.numerics.audit > 0.0 && spec.numerics.audit_by == "proof") require_proofs();
  if (!spec.goals.empty() && spec.scatter.spreads.empty())
    throw InputError(
        fmt::format("{}: goal.{} has no effect in a map of nominal hoops; allowed: with a parameter in "
                    "[scatter]",
                    origin_of(spec), spec.goals.front().field));
  if (asked.shard) check_shard(*asked.shard);
  if (!(asked.commit_interval >= 0.0))
    throw InputError(fmt::format("commit_interval = {} is out of range; allowed: a number of seconds >= 0",
                                 asked.commit_interval));
  SweepOptions options = asked;
  options.stop_requested = latched(asked.stop_requested);
  if (path.empty())
    throw InputError(origin_of(spec) + ": output.file is not set; allowed: a file's name there or with -o");
  const std::string map = behind_links(asked.shard ? shard_path(path, *asked.shard) : path);
  const Locking locking = options.lock ? Locking::required : Locking::if_possible;
  const Tiling whole = tiling_of(spec),
               tiling = asked.shard ? shard_of(spec, whole, *asked.shard, options.threads) : whole;
  const MapLayout layout = layout_of(spec);
  refuse_own_input(spec, map);
  std::vector<hdf5::Attribute> opening =
      provenance(spec, asked.shard ? shard_filetype : map_filetype, title_of(spec));
  if (asked.shard) {
    opening.emplace_back(shard_attribute, text_of(*asked.shard));
    opening.emplace_back(shard_tiles_attribute, bits_of(tiling.chosen(), whole.size()));
  }
  opening.emplace_back("threads", std::int64_t{thread_count(options.threads)});
  if (spec.numerics.audit > 0.0) opening.emplace_back("audit_method", auditor_of(spec.numerics, spec.scene));
  if (is_done(map, spec, opening, options, locking)) return report_on(map, tiling, locking);
  MapWriter writer = begin_map(map, spec, layout, tiling, opening, options, locking);
  try {
    return fill(spec, layout, tiling, options, writer);
  } catch (const BrokenFile& error) {
    throw IoError(fmt::format(
        "{}; the disk or its driver loses data; start again by --overwrite, on another disk", error.what()));
  } catch (const IoError& error) {
    if (writer.committed() == 0) throw IoError(fmt::format("{}; nothing was kept", error.what()));
    throw KeptError(error.what(), writer.committed(), tiling.designs());
  }
}

}  // namespace leapmap
