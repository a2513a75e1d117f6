// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap: which slope, mass ratio and L/R make a passive hoop jump, how high and how soon.
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

namespace {

enum ExitStatus { done = 0, other_failure = 1, bad_input = 2, io_failure = 3 };

/// Tells what went wrong in one line.
int complain(int status, std::string_view what) noexcept {
  try {
    leapmap::cli::tell(std::string(what));
  } catch (const std::bad_alloc&) {
    std::fputs("leapmap: out of memory\n", stderr);
  }
  return status;
}

/// Reads the command line, runs its command, and turns errors into a line and a status.
int run(int argc, char** argv) {
  int status = done;
  leapmap::cli::CommandLine line(
      "leapmap maps the jumps of passive hoops: thin hoops with an off-centre mass that roll down a plane "
      "and leap.",

      "Examples:\n"
      "  leapmap hop                                       the paper's hoop: phases, times, the jump\n"
      "  leapmap hop --slope 30deg --trace hop.h5          another slope, its motion written to a file\n"
      "  leapmap sweep sweeps/slope_mass_ratio.toml        a map of 61,696 designs\n"
      "  leapmap info maps/slope_mass_ratio.h5             what is in it\n"
      "  leapmap boundaries sweeps/slope_mass_ratio.toml   where its outcomes jump, to rounding\n"
      "  leapmap design sweeps/questions/highest.toml      the hoop that does what you need, best\n"
      "  leapmap fit film.csv                              release and friction that explain a measured "
      "motion\n"
      "  leapmap check maps/slope_mass_ratio.h5            whether it is what was written, and right\n"
      "Exit status: 0 done, 1 failure or failed audit, 2 bad usage or input, 3 input/output, 130/143 "
      "interrupted.",
      fmt::format("leapmap {} (git {}), using {}", leapmap::program_version(), leapmap::git_revision(),
                  leapmap::instruction_set()));
  line.shared()
      .value(
          "--instruction-set", [](const std::string& name) { leapmap::use_instruction_set(name); },
          fmt::format(
              "solve by a lower instruction set than the best of this machine, where bits should agree "
              "with another machine's; one of {}",
              fmt::join(leapmap::instruction_sets(), ", ")))
      .at_once();
  leapmap::cli::add_sweep(line, status);
  leapmap::cli::add_hop(line, status);
  leapmap::cli::add_info(line, status);
  leapmap::cli::add_boundaries(line, status);
  leapmap::cli::add_design(line, status);
  leapmap::cli::add_fit(line, status);
  leapmap::cli::add_gait(line, status);
  leapmap::cli::add_join(line, status);
  leapmap::cli::add_check(line, status);
  leapmap::cli::add_precision(line, status);
  leapmap::cli::add_stability(line, status);
  try {
    line.run(argc, argv);
    leapmap::cli::flush_out();
  } catch (const leapmap::InputError& error) {
    return complain(bad_input, error.what());
  } catch (const leapmap::IoError& error) {
    return complain(io_failure, error.what());
  } catch (const std::bad_alloc&) {
    return complain(other_failure, "out of memory");
  } catch (const std::exception& error) {
    return complain(other_failure, error.what());
  }
  return status;
}

}  // namespace

void leapmap::cli::add_no_lock(Command& command, Locking& locking) {
  command.flag(
      "--no-lock", [&locking] { locking = Locking::if_possible; },
      "do without locks on a file system that has none; make sure that nothing else uses the file. Elsewhere "
      "a file in use is refused all the same");
}

void leapmap::cli::add_set(Command& command, std::vector<std::string>& overrides,
                           const std::string& example) {
  command.value("--set", overrides, "KEY=VALUE: override a key of the spec" + example);
}

leapmap::Spec leapmap::cli::read_given_spec(const std::string& path,
                                            const std::vector<std::string>& overrides) {
  const auto key_of = [](const std::string& set) -> const Option* {
    const std::string name = set.substr(0, set.find('='));
    const std::size_t dot = name.find('.');
    return dot == std::string::npos ? find_option("", name)
                                    : find_option(name.substr(0, dot), name.substr(dot + 1));
  };
  Spec spec = read_spec(path, overrides);  // first, so that what is wrong is said alone
  std::vector<const Option*> keys;
  for (const std::string& set : overrides) keys.push_back(key_of(set));
  for (auto key = keys.begin(); key != keys.end(); ++key) {
    if (!*key || std::find(keys.begin(), key, *key) != key) continue;  // told of where it is first
    const auto last = std::find(keys.rbegin(), keys.rend(), *key).base() - 1;
    if (last != key)
      tell(fmt::format("{} is given twice on the command line: {} is used", (*key)->key,
                       overrides[static_cast<std::size_t>(last - keys.begin())]));
  }
  return spec;
}

void leapmap::cli::refuse_scatter(const std::vector<std::string>& overrides, const std::string& why) {
  for (const std::string& set : overrides)
    for (const std::string_view begin : {"scatter.", "goal.", "samples=", "seed="})
      if (set.starts_with(begin)) throw InputError("--set " + set + ": has no use here; " + why);
}

void leapmap::cli::add_flag_of(Command& command, const Option& option, std::vector<std::string>& overrides) {
  command.value(
      flag_of(option),
      [&option, &overrides](const std::string& value) {
        overrides.push_back(fmt::format("{}.{}={}", option.section, option.key, value));
      },
      fmt::format("{}; {}", option.meaning, allowed_values(option)));
}

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow (ulimit -f) is an error of the write, not an end
  try {
    if (!leapmap::open_standard_streams()) return io_failure;  // and nowhere to say why
    return run(argc, argv);
  } catch (...) {  // the command line itself found no memory
    return complain(other_failure, "out of memory");
  }
}
