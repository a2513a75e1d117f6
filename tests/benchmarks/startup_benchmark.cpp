// SPDX-License-Identifier: GPL-3.0-or-later
/// What it costs to start the program: one hop, and a sweep of eight designs into a new map.
///
/// cpu_ms is the processor time of the whole process, its own and the system's for it, the median of the
/// repetitions. Compare it with the row of True, a process that does nothing, and with that of H5Dump, which
/// loads the HDF5 library to say its version. LEAPMAP names the program; OTHER_LEAPMAP, if set, another one,
/// as of another revision, that is run in turn with it.
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using Command = std::vector<std::string>;

/// Processor seconds of a command run to its end, its output thrown away; -1: it failed.
double cpu_seconds(const Command& command) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const bool started = posix_spawnp(&child, words[0], &quiet, nullptr, words.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&quiet);
  int status = 0;
  rusage used{};
  if (!started || wait4(child, &status, 0, &used) != child || status != 0) return -1.0;
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// made: a file that the command makes anew, or none.
void start(benchmark::State& state, const Command& command, const std::string& made) {
  for (auto _ : state) {
    std::filesystem::remove(made);
    const double seconds = cpu_seconds(command);
    if (seconds < 0.0) {
      state.SkipWithError(("cannot run " + command[0]).c_str());
      return;
    }
    state.SetIterationTime(seconds);
    state.counters["cpu_ms"] = 1e3 * seconds;
  }
}

void add(const std::string& name, const Command& command, const std::string& made = {}) {
  benchmark::RegisterBenchmark(name.c_str(), start, command, made)
      ->Iterations(1)
      ->Repetitions(101)
      ->ReportAggregatesOnly()
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

void add_leapmap(const std::string& name, const std::string& program, const std::string& map) {
  add(name + "/hop", {program, "hop", "--slope", "0.6", "--mass-ratio", "3"});
  add(name + "/sweep", {program, "sweep", "--set", "slope={from=0.1,to=0.8,count=8}", "-o", map, "--quiet"},
      map);
}

}  // namespace

int main(int count, char** words) {
  benchmark::Initialize(&count, words);
  const char* named = std::getenv("LEAPMAP");
  const std::string program = named ? named : "leapmap";
  if (cpu_seconds({program, "--version"}) < 0.0) {
    std::fprintf(stderr, "startup-benchmark: cannot run %s; LEAPMAP must name the program\n",
                 program.c_str());
    return 2;
  }
  const std::string map = std::filesystem::temp_directory_path() / "leapmap_startup_benchmark.h5";
  add("True", {"true"});
  add("H5Dump", {"h5dump", "-V"});
  add_leapmap("Leapmap", program, map);
  if (const char* other = std::getenv("OTHER_LEAPMAP")) add_leapmap("Other", other, map);
  benchmark::RunSpecifiedBenchmarks();
  std::filesystem::remove(map);
}
