// SPDX-License-Identifier: GPL-3.0-or-later
/// Numbers and command lines as people read and type them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace leapmap::cli {

/// Goes with results of the model without slip.
inline constexpr std::string_view never_slips =
    "The contact never slips in this model; a hoop that you build may.\n";

/// "61,696".
std::string grouped(std::uint64_t number);
/// "4.2 MB".
std::string spoken_bytes(double bytes);
/// "1 h 02 min", "3 min 20 s", "4.2 s".
std::string spoken_duration(double seconds);

}  // namespace leapmap::cli
