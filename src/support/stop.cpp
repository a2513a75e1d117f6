// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/stop.hpp"

#include <chrono>
#include <optional>

#include "leapmap/errors.hpp"

namespace leapmap {
namespace {

using SteadyClock = std::chrono::steady_clock;
constexpr std::chrono::seconds grace{2};
constexpr unsigned between = 64;  // calls

// A thread's own, as solvers are.
thread_local const std::function<bool()>* asked_here = nullptr;
thread_local unsigned calls = 0;
thread_local std::optional<SteadyClock::time_point> since;

}  // namespace

StopScope::StopScope(const std::function<bool()>& asked) : before_(asked_here) {
  if (asked) asked_here = &asked;
  since.reset();
}

StopScope::~StopScope() { asked_here = before_; }

void throw_if_stopped() {
  if (!asked_here || ++calls % between != 0) return;
  if (!(*asked_here)()) return;
  if (!since) since = SteadyClock::now();
  if (SteadyClock::now() - *since > grace) throw Stopped("the work was stopped");
}

}  // namespace leapmap
