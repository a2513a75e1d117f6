// SPDX-License-Identifier: GPL-3.0-or-later
/// Progress on a terminal or in a log, and a request to stop by Ctrl-C.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace leapmap::cli {

/// Done, rate and time to go, on stderr: on a terminal one line, rewritten a few times a second; in a log a
/// new line every ten seconds.
class Progress {
 public:
  /// already: of the total, what an earlier session did; it does not count for the rate.
  Progress(std::size_t total, std::size_t already, bool quiet);
  /// Clears a terminal's line.
  ~Progress();
  void update(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::size_t total_, already_;
  bool quiet_, terminal_;
  Clock::time_point begin_ = Clock::now(), last_ = begin_;
};

/// From now on the first SIGINT or SIGTERM is only noted, so that work can be brought to a good end; the
/// second one ends the program at once.
void note_signals();
/// The signal noted, or 0.
int noted_signal();

}  // namespace leapmap::cli
