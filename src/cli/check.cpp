// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap check: whether a map is what was written, and right.
#include "sweep/check.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/audit_lines.hpp"
#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/spoken.hpp"
#include "engine/parallel.hpp"
#include "support/posix.hpp"
#include "support/printable.hpp"

namespace leapmap::cli {
namespace {

struct CheckArguments {
  std::string path;
  CheckOptions options;
};

/// Prints what check_map finds. Returns whether that is nothing.
bool tell_findings(const CheckArguments& arguments, const CheckReport& report) {
  for (const std::string& finding : report.findings) say("WRONG    {}\n", printable(finding));
  if (!report.findings.empty()) return false;
  say("read     {} designs in {} chunks{}: all intact\n", grouped(report.designs), grouped(report.tiles),
      report.whole ? "" : ", all that the interrupted sweep left");
  if (report.sample) say_audit(*report.sample);
  if (report.whole && !report.sealed)
    say("note     its format is older than 1.4, which had no checksum of the whole file\n");
  say("right    {}\n", printable(arguments.path));
  return true;
}

/// Looks for what is wrong with a file whose bytes are known to have changed, in a process of its own: HDF5
/// itself crashes on some damaged files.
void tell_damage(const CheckArguments& arguments) {
  enum Found { something = 0, nothing = 1 };
  flush_out();
  const pid_t child = ::fork();
  if (child < 0) return;
  if (child == 0) {
    bool found = true;
    try {
      const CheckReport report = check_map(arguments.path, arguments.options);
      found = !report.findings.empty() || noted_signal() != 0;
      if (found) tell_findings(arguments, report);
      flush_out();
    } catch (const std::exception& error) {
      ::dprintf(STDOUT_FILENO, "WRONG    %s\n", printable(error.what()).c_str());
    }
    ::_exit(found ? something : nothing);
  }
  int status = 0;
  if (uninterrupted([&] { return ::waitpid(child, &status, 0); }) != child || !WIFEXITED(status))
    say("WRONG    HDF5 cannot read it\n");
  else if (WEXITSTATUS(status) == nothing)
    say("         the changed bytes hold no value: every design is intact; check the disk or the copy\n");
}

int run(const CheckArguments& arguments) {
  note_signals();
  const auto holds = seal_holds(arguments.path, arguments.options.locking);
  if (holds == false) {
    say("WRONG    the bytes of {} differ from what was written:\n", printable(arguments.path));
    tell_damage(arguments);
    return noted_signal() != 0 ? 128 + noted_signal() : 1;
  }
  const CheckReport report = check_map(arguments.path, arguments.options);
  if (noted_signal() != 0) return 128 + noted_signal();
  return tell_findings(arguments, report) ? 0 : 1;
}

}  // namespace

void add_check(CommandLine& line, int& status) {
  Command command = line.command("check", "verify a map: damage, and a sample of its designs");
  command.examples({{"leapmap check maps/slope_mass_ratio.h5", "every byte, and 200 designs"},
                    {"leapmap check maps/slope_mass_ratio.h5 --sample 10000", "more designs"}});
  auto arguments = std::make_shared<CheckArguments>();
  CheckOptions& options = arguments->options;
  options.stop_requested = [] { return noted_signal() != 0; };
  command.value("MAP", arguments->path, "a map, or the .part of an unfinished one (HDF5)")
      .required()
      .check(named_file());
  command
      .value("--sample", options.sample,
             "number of designs to solve again by another method; default: 200; 0: none")
      .check(whole_number(0, 1e15));
  add_threads(command, options.threads);
  add_no_lock(command, options.locking);
  command.footer(
      "Verifies the checksums of every chunk, of all chunks together and of the file; the range of every "
      "quantity; the number of designs with each status; axes and texts against the spec.\n"
      "Exit status 1: the map is wrong.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
