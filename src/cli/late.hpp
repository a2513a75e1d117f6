// SPDX-License-Identifier: GPL-3.0-or-later
/// The module leapmap-late.so: what few commands need, with libraries that take as long to load as a hop to
/// solve.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "leapmap/prove.hpp"

namespace leapmap::cli {

/// What the module is asked for, by one C function; the program's own functions of these names ask it.
struct Late {
  const char* revision;  ///< of the sources: another one may lay out a design in another way
  /// may_stop: throws Stopped where a stop is asked for.
  Proof (*walked)(const DesignBox&, std::span<double Design::*const>, const Scene&, bool times,
                  void (*may_stop)());
  std::string (*unzipped)(const std::string&, std::string_view, std::size_t, std::string_view);
};
inline constexpr const char* late_entry = "leapmap_late";
using LateEntry = const Late* (*)();

}  // namespace leapmap::cli
