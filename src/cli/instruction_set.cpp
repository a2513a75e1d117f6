// SPDX-License-Identifier: GPL-3.0-or-later
/// Refuses a machine that lacks the instructions the program was compiled for, before any of them is met:
/// compiled for the oldest machine there is, and run before everything else. LEAPMAP_FEATURES comes from
/// CMakeLists.txt.
#include <unistd.h>

#include <cstdlib>

namespace {

#ifdef LEAPMAP_FEATURES
[[gnu::constructor(101)]] void refuse_older_machines() {
  __builtin_cpu_init();
  if (LEAPMAP_FEATURES) return;
  constexpr char message[] =
      "leapmap: was built for -march=" LEAPMAP_ARCH
      ", which this machine does not have; build it here, or with cmake -DLEAPMAP_ARCH=x86-64\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, message, sizeof message - 1);
  _exit(EXIT_FAILURE);
}
#endif

}  // namespace
