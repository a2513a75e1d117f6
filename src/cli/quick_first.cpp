// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/quick_first.hpp"

#include <fmt/format.h>

#include "cli/output.hpp"
#include "cli/progress.hpp"

namespace leapmap::cli {

void add_quick_and_thorough(Command& command, bool& thorough, const std::string& fewer) {
  command.flag(
      "--quick", [] {}, fmt::format("fewer {}: ten seconds or so; the default", fewer));
  command
      .flag("--thorough", thorough,
            "the quick table first, then one with all of them: minutes; Ctrl-C keeps the quick one")
      .excludes("--quick");
}

int run_quick_first(bool thorough, const std::string& table, const std::function<bool(bool quick)>& run) {
  const auto interrupted = [](const std::string& what) {
    tell(fmt::format("interrupted; {}", what));
    return 128 + noted_signal();
  };
  if (!run(true)) return interrupted("nothing was written");
  if (!thorough) return 0;
  say("thorough now; Ctrl-C keeps the quick table\n");
  flush_out();
  return run(false) ? 0 : interrupted(table + " holds the quick run");
}

}  // namespace leapmap::cli
