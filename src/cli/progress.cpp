// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace leapmap::cli {
namespace {

volatile std::sig_atomic_t signal_noted = 0;  // a signal handler can reach nothing but a global

extern "C" void note_signal(int signal) { signal_noted = signal; }

}  // namespace

Progress::Progress(std::size_t total, bool quiet)
    : total_(total), shown_(!quiet && ::isatty(STDERR_FILENO)) {}

Progress::~Progress() {
  if (shown_) fmt::print(stderr, "\r\033[K");
}

void Progress::update(std::size_t done) {
  const auto now = Clock::now();
  if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
  last_ = now;
  const double passed = std::chrono::duration<double>(now - begin_).count();
  const double rate = static_cast<double>(done) / passed;
  fmt::print(stderr, "\r\033[K{} of {} designs, {:.0f} %, {:.4g} designs/s, {} to go", done, total_,
             100.0 * static_cast<double>(done) / static_cast<double>(total_), rate,
             spoken_duration(static_cast<double>(total_ - done) / rate));
  std::fflush(stderr);
}

std::string spoken_duration(double seconds) {
  if (seconds < 1.0) return fmt::format("{:.2g} s", seconds);
  if (seconds < 60.0) return fmt::format("{:.3g} s", seconds);
  const auto whole = static_cast<long long>(seconds + 0.5);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  if (whole < 86400) return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
  return fmt::format("{:.3g} days", seconds / 86400.0);
}

void note_signals() {
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int noted_signal() { return signal_noted; }

}  // namespace leapmap::cli
