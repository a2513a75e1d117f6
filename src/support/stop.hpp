// SPDX-License-Identifier: GPL-3.0-or-later
/// The request to stop, as seen from inside a design: a hoop may roll for a million revolutions, or jump for
/// as many times before its gait is looked at, and whoever waits for it should not have to.
#pragma once

#include <functional>

namespace leapmap {

/// While it lives, loops inside designs on this thread ask `asked`; empty: they ask as before.
class StopScope {
 public:
  explicit StopScope(const std::function<bool()>& asked);
  ~StopScope();
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  const std::function<bool()>* before_;
};

/// Throws Stopped some seconds after a stop was asked for: what takes less is brought to its end. To be
/// called in every loop inside a design that may be long; most calls cost next to nothing.
void throw_if_stopped();

}  // namespace leapmap
