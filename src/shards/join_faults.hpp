// SPDX-License-Identifier: GPL-3.0-or-later
/// What keeps shards from being joined.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace leapmap {

/// What is wrong with shards, all of them told at once.
class JoinFaults {
 public:
  JoinFaults(std::string map, std::size_t shards);

  /// broken: the file is there, and has to go before it is made again.
  void note(std::size_t shard, std::string what, bool broken = false);
  /// Throws what was noted, as one line that says which to run again: BrokenFile if any is broken, else
  /// InputError.
  void tell() const;

 private:
  std::string map_;
  std::size_t shards_, unfinished_ = 0;
  std::vector<std::size_t> again_;
  std::vector<std::string> broken_, reasons_;
};

}  // namespace leapmap
