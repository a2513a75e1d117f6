// SPDX-License-Identifier: GPL-3.0-or-later
/// What writing a map costs: 1e8 designs, jump_height in f4, spurious_first_jump and status, all threads,
/// without any file and with one at several levels of compression, in one run.
///
/// Compare items_per_second of the rows: they are designs a second. bytes is of the file, a design. Space for
/// a file of 0.8 GB is needed in the folder for temporary files (TMPDIR).
#include <benchmark/benchmark.h>

#include <filesystem>

#include "engine/map_layout.hpp"
#include "map/writer.hpp"
#include "spec/designs.hpp"
#include "support/sweep_into.hpp"

namespace leapmap {
namespace {

Spec grid(long compression) {
  return read_spec(
      "", {"runway=4", "slope={from=0.1,to=0.8,count=1000}",
           "mass_ratio={from=0.5,to=10,count=1000,scale=\"log\"}", "offset_ratio={from=0.3,to=1,count=100}",
           "precision=f4", "fields=[\"jump_height\",\"spurious_first_jump\",\"status\"]",
           "compression=" + std::to_string(compression)});
}

void WithoutFile(benchmark::State& state) {
  const Spec spec = grid(0);
  const Tiling tiling(shape_of(spec));
  for (auto _ : state)
    run_sweep(spec, request_of(spec), tiling, {}, [] {
      return TileWork{[](const Tile&, std::size_t, const Solved&) {},
                      [](std::size_t, const Tile&) { return Prepared{[] {}}; }};
    });
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(tiling.designs()));
}

void WithFile(benchmark::State& state) {
  const Spec spec = grid(state.range(0));
  const Tiling tiling(shape_of(spec));
  const MapLayout layout = layout_of(spec);
  const std::string path = std::filesystem::temp_directory_path() / "leapmap_benchmark.h5";
  for (auto _ : state) {
    MapWriter writer = MapWriter::begin(path, layout, tiling, {}, true);
    testing::sweep_into(writer, spec, layout, tiling);
    if (!writer.finish({})) state.SkipWithError("the folder cannot be synced");
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(tiling.designs()));
  state.counters["bytes"] =
      static_cast<double>(std::filesystem::file_size(path)) / static_cast<double>(tiling.designs());
  std::filesystem::remove(path);
}

BENCHMARK(WithoutFile)
    ->Iterations(1)
    ->Repetitions(3)
    ->ReportAggregatesOnly()
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(WithFile)
    ->Arg(0)
    ->Arg(1)
    ->Arg(6)
    ->Iterations(1)
    ->Repetitions(3)
    ->ReportAggregatesOnly()
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace leapmap

BENCHMARK_MAIN();
