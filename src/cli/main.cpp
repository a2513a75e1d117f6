// SPDX-License-Identifier: GPL-3.0-or-later
/// The program leapmap: reads the command line and runs a command.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

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
  add_hop(line, status);
  add_sweep(line, status);
  add_info(line, status);
  add_boundaries(line, status);
  add_design(line, status);
  add_fit(line, status);
  add_gait(line, status);
  add_check(line, status);
  add_prove(line, status);
  add_export(line, status);
  add_join(line, status);
  add_precision(line, status);
  add_stability(line, status);
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

}  // namespace
}  // namespace leapmap::cli

int main(int argc, char** argv) {
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
