// SPDX-License-Identifier: GPL-3.0-or-later
/// What the library asks of the system to change files, seen by a test on its way there: the linker puts
/// wrappers in place of pwrite, fsync and ftruncate (tests/CMakeLists.txt).
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace leapmap::testing {

struct SystemCall {
  enum class Kind { write, sync, truncate } kind;
  int descriptor;
  std::uint64_t offset;              ///< of a write; of a truncation: the new size
  std::span<const std::byte> bytes;  ///< of a write
};

/// Called before each call is made; unset: nothing.
extern std::function<void(const SystemCall&)> before_system_call;

/// Runs f in a process of its own that ends like one killed just before its `number`-th call, from 0, or in
/// the middle of it if that is a write. False: f came to its end before.
bool dies_at_call(long number, const std::function<void()>& f);

}  // namespace leapmap::testing
