// SPDX-License-Identifier: GPL-3.0-or-later
#include "shards/join_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "leapmap/errors.hpp"
#include "map/shard_name.hpp"

namespace leapmap {
namespace {

/// Numbers as Slurm's --array takes them: 3,5-7.
std::string array_of(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0, j = 0; i < numbers.size(); i = j) {
    for (j = i + 1; j < numbers.size() && numbers[j] == numbers[j - 1] + 1;) ++j;
    text += fmt::format("{}{}", text.empty() ? "" : ",", numbers[i]);
    if (j > i + 1) text += fmt::format("-{}", numbers[j - 1]);
  }
  return text;
}

}  // namespace

JoinFaults::JoinFaults(std::string map, std::size_t shards) : map_(std::move(map)), shards_(shards) {}

void JoinFaults::note(std::size_t shard, std::string what, bool broken) {
  again_.push_back(shard);
  if (broken) {
    broken_.push_back(shard_path(map_, {shard, shards_}));
    if (reasons_.size() < 3) reasons_.push_back(std::move(what));
  } else {
    unfinished_ += !what.empty();
  }
}

void JoinFaults::tell() const {
  if (again_.empty()) return;
  std::vector<std::size_t> again = again_;
  std::ranges::sort(again);
  std::string text = fmt::format("{}: ", map_);
  if (const std::size_t missing = again_.size() - broken_.size(); missing > 0)
    text += fmt::format("{} of its {} shards {} missing{}; ", missing, shards_, missing == 1 ? "is" : "are",
                        unfinished_ > 0 ? fmt::format(", {} of them unfinished", unfinished_) : "");
  for (const std::string& reason : reasons_) text += reason + "; ";
  if (broken_.size() > reasons_.size())
    text += fmt::format("and {} more; ", broken_.size() - reasons_.size());
  if (!broken_.empty()) text += "remove what is broken, then ";
  text += fmt::format("run them again, with --resume: --array={}", array_of(again));
  if (broken_.empty()) throw InputError(text);
  throw BrokenFile(text);
}

}  // namespace leapmap
