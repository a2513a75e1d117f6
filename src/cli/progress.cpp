// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "cli/output.hpp"
#include "cli/spoken.hpp"

namespace leapmap::cli {
namespace {

volatile std::sig_atomic_t signal_noted = 0;  // a signal handler can reach nothing but a global

extern "C" void note_signal(int signal) {
  // After Ctrl-C a second signal, whichever, ends the program; after SIGTERM only Ctrl-C does: batch systems
  // send SIGTERM to a job's script and to its processes, and the script sends it on.
  signal_noted = signal;
  std::signal(SIGINT, SIG_DFL);
  if (signal == SIGINT) std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

Progress::Progress(std::size_t total, std::size_t already, bool quiet)
    : total_(total), already_(already), quiet_(quiet), terminal_(::isatty(STDERR_FILENO)) {}

Progress::~Progress() {
  if (terminal_ && !quiet_) std::fputs("\r\033[K", stderr);
}

void Progress::update(std::size_t done) {
  const auto now = Clock::now();
  if (quiet_ || now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(10))) return;
  last_ = now;
  const double passed = std::chrono::duration<double>(now - begin_).count();
  const double rate = static_cast<double>(done - already_) / passed;
  const std::string line =
      fmt::format("{} of {} designs, {:.0f} %, {:.4g} designs/s, {} to go", grouped(done), grouped(total_),
                  100.0 * static_cast<double>(done) / static_cast<double>(total_), rate,
                  spoken_duration(static_cast<double>(total_ - done) / rate));
  terminal_ ? static_cast<void>(std::fputs(("\r\033[K" + line).c_str(), stderr)) : tell(line);
  std::fflush(stderr);
}

void note_signals() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int noted_signal() { return signal_noted; }

}  // namespace leapmap::cli
