// SPDX-License-Identifier: GPL-3.0-or-later
/// A map judged by proofs: whether what it stores of its designs lies within what is proved of them.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "map/reader.hpp"
#include "spec/spec.hpp"

namespace leapmap {

struct JudgedMap {
  std::size_t looked_at = 0, proved = 0;
  std::size_t failed = 0;                          ///< stored as failed, of which nothing is judged
  std::map<std::string, std::size_t> undecided{};  ///< by what is too near
  std::size_t wrong = 0;
  std::vector<std::string> findings{};  ///< of the first of them, a line each
  double widest_height = 0.0;           ///< enclosure [hoop diameters]
  double widest_time = 0.0;             ///< relative
};

struct JudgeOptions {
  double share = 1.0;  ///< of the map's designs, in (0, 1]
  int threads = 0;
  std::function<bool()> stop_requested{};
  std::function<void(std::size_t done, std::size_t total)> progress{};
};

/// Throws InputError for a map of which nothing can be proved, IoError.
JudgedMap judge_map(const MapReader& map, const Spec& spec, const JudgeOptions& options);

}  // namespace leapmap
