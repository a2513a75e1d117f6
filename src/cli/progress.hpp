// SPDX-License-Identifier: GPL-3.0-or-later
/// Progress on a terminal, and a request to stop by Ctrl-C.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace leapmap::cli {

/// One line on stderr, rewritten a few times a second, and only if stderr is a terminal: done, rate, time to
/// go.
class Progress {
 public:
  Progress(std::size_t total, bool quiet);
  /// Clears the line.
  ~Progress();
  void update(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;
  std::size_t total_;
  bool shown_;
  Clock::time_point begin_ = Clock::now(), last_ = begin_;
};

/// "1 h 02 min", "3 min 20 s", "4.2 s".
std::string spoken_duration(double seconds);

/// From now on the first SIGINT or SIGTERM is only noted, so that work can be brought to a good end; the
/// second one ends the program at once.
void note_signals();
/// The signal noted, or 0.
int noted_signal();

}  // namespace leapmap::cli
