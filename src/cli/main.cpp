// SPDX-License-Identifier: GPL-3.0-or-later
/// The program leapmap: reads the command line and runs a command.
#include <fmt/format.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <string_view>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/version.hpp"
#include "support/posix.hpp"

namespace leapmap::cli {
namespace {

enum ExitStatus { done = 0, other_failure = 1, bad_input = 2, io_failure = 3 };

/// Reports what went wrong in one line.
int complain(int status, std::string_view what) noexcept {
  try {
    tell(std::string(what));
  } catch (const std::bad_alloc&) {
    std::fputs("leapmap: out of memory\n", stderr);
  }
  return status;
}

/// In the order of --help.
struct Named {
  std::string_view name;
  void (*add)(CommandLine& line, int& status);
};
constexpr std::array commands{Named{"hop", add_hop},
                              Named{"sweep", add_sweep},
                              Named{"info", add_info},
                              Named{"boundaries", add_boundaries},
                              Named{"design", add_design},
                              Named{"fit", add_fit},
                              Named{"gait", add_gait},
                              Named{"check", add_check},
                              Named{"prove", add_prove},
                              Named{"export", add_export},
                              Named{"join", add_join},
                              Named{"precision", add_precision},
                              Named{"stability", add_stability}};

/// Reads the command line, runs its command, and turns errors into a line and a status.
int run(int argc, char** argv) {
  int status = done;
  CommandLine line(
      "jumps of hoops with an off-centre mass: which designs jump, how high, how far, how soon",
      fmt::format("leapmap {} (git {}), using {}", program_version(), git_revision(), instruction_set()));
  Command shared = line.shared();
  shared.examples({{"leapmap hop", "the paper's hoop: phases, times, the jump"},
                   {"leapmap hop --slope 30deg --trace hop.h5", "another slope; its motion in a file"},
                   {"leapmap sweep sweeps/slope_mass_ratio.toml", "a map of 61,696 designs"},
                   {"leapmap info maps/slope_mass_ratio.h5", "its summary"},
                   {"leapmap boundaries maps/slope_mass_ratio.h5", "its discontinuities"},
                   {"leapmap design sweeps/questions/highest.toml", "the best design for given goals"},
                   {"leapmap fit film.csv", "release and friction from a measured motion"},
                   {"leapmap check maps/slope_mass_ratio.h5", "verify a map"},
                   {"leapmap prove maps/slope_mass_ratio.h5", "prove its designs"}});
  shared.footer(
      "leapmap COMMAND --help describes a command.\n"
      "Exit status: 0 done; 1 failure, or a cross-check found a difference; 2 invalid usage or input; 3 "
      "input/output; 130 or 143 interrupted.");
  shared
      .value(
          "--instruction-set", [](const std::string& name) { use_instruction_set(name); },
          fmt::format("use a lower instruction set than this machine's best, so that results agree with "
                      "another machine's bit for bit; one of {}",
                      fmt::join(instruction_sets(), ", ")))
      .at_once()
      .shown_as("NAME");
  // One that is named first is all that there is to know.
  const auto named = std::ranges::find(commands, std::string_view(argc > 1 ? argv[1] : ""), &Named::name);
  for (const Named& command : commands)
    if (named == commands.end() || &command == &*named) command.add(line, status);
  try {
    line.run(argc, argv);
    flush_out();
  } catch (const InputError& error) {
    return complain(bad_input, error.what());
  } catch (const IoError& error) {
    return complain(io_failure, error.what());
  } catch (const std::bad_alloc&) {
    return complain(other_failure, "out of memory");
  } catch (const std::exception& error) {
    return complain(other_failure, error.what());
  }
  return status;
}

/// Keeps what is freed for whoever asks next, and takes the first of it at once. Else every block above 128
/// kB would go back to the system, which clears it page by page as it is touched again: HDF5 takes half a
/// megabyte for each file that it opens, and a fault for each page takes longer than all the rest of a small
/// sweep.
void keep_memory() {
  constexpr std::size_t MiB = std::size_t{1} << 20, first = 2 * MiB;
  ::mallopt(M_MMAP_THRESHOLD, 32 * MiB);  // the largest that malloc comes to by itself
  ::mallopt(M_TRIM_THRESHOLD, 64 * MiB);
  ::mallopt(M_TOP_PAD, MiB);
#ifdef MADV_POPULATE_WRITE
  void* memory = std::malloc(first);
  std::size_t room = first;
  void* pages = memory;
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  // Where that is not known to the system nothing happens.
  if (std::align(page, first - page, pages, room)) ::madvise(pages, first - page, MADV_POPULATE_WRITE);
  std::free(memory);
#endif
}

}  // namespace
}  // namespace leapmap::cli

int main(int argc, char** argv) {
  leapmap::cli::keep_memory();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow (ulimit -f) is an error of the write, not an end
  try {
    if (!leapmap::open_standard_streams()) return leapmap::cli::io_failure;  // and nowhere to say why
    return leapmap::cli::run(argc, argv);
  } catch (const std::bad_alloc&) {  // while the command line was set up
    return leapmap::cli::complain(leapmap::cli::other_failure, "out of memory");
  } catch (const std::exception& error) {
    return leapmap::cli::complain(leapmap::cli::other_failure, error.what());
  }
}
