// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/shard_name.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "leapmap/errors.hpp"

namespace leapmap {
namespace {

bool is_part(const Shard& shard) {
  return shard.number >= 1 && shard.number <= shard.of && shard.of <= most_shards;
}

[[noreturn]] void refuse_shard(std::string_view text) {
  throw InputError(
      fmt::format("--shard {}: is not a part of a map; allowed: I/N with I from 1 to N, N at most {}", text,
                  most_shards));
}

/// Two whole numbers I and N, 1 <= I <= N, with something between them.
std::optional<Shard> shard_in(std::string_view text, std::string_view between) {
  Shard shard{0, 0};
  const auto middle = text.find(between);
  const auto number = [&](std::string_view digits, std::size_t& into) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), into);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  if (middle == text.npos || !number(text.substr(0, middle), shard.number) ||
      !number(text.substr(middle + between.size()), shard.of) || !is_part(shard))
    return std::nullopt;
  return shard;
}

}  // namespace

Shard parse_shard(std::string_view text) {
  if (const auto shard = shard_in(text, "/")) return *shard;
  refuse_shard(text);
}

void check_shard(const Shard& shard) {
  if (!is_part(shard)) refuse_shard(text_of(shard));
}

std::string text_of(const Shard& shard) { return fmt::format("{}/{}", shard.number, shard.of); }

std::string shard_path(const std::string& map, const Shard& shard) {
  const std::filesystem::path path(map);
  return (path.parent_path() / fmt::format("{}.{}-of-{}{}", path.stem().string(), shard.number, shard.of,
                                           path.extension().string()))
      .string();
}

std::optional<Shard> shard_by_name(const std::string& file) {
  const std::filesystem::path path(file);
  for (const auto& words : {path.stem().extension(), path.extension()})  // the map's name may end in none
    if (const auto shard = words.empty() ? std::nullopt : shard_in(words.string().substr(1), "-of-"))
      return shard;
  return std::nullopt;
}

}  // namespace leapmap
