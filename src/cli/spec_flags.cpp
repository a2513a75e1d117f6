// SPDX-License-Identifier: GPL-3.0-or-later
/// Flags that several commands share, and the spec that they change.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"

namespace leapmap::cli {
namespace {

/// The flag of a spec's key, which adds KEY=VALUE to overrides.
void add_flag_of(Command& command, const Option& option, std::vector<std::string>& overrides) {
  const bool is_word = option.choices != nullptr;
  const std::string unit = option.unit.empty() || option.unit == "1" ? "" : fmt::format(" [{}]", option.unit);
  command
      .value(
          flag_of(option),
          [&option, &overrides](const std::string& value) {
            overrides.push_back(fmt::format("{}.{}={}", option.section, option.key, value));
          },
          fmt::format("{}{}; {}", option.meaning, unit, allowed_values(option)))
      .shown_as(is_word                ? "WORD"
                : option.unit == "rad" ? "ANGLE"
                                       : "NUMBER");
}

}  // namespace

void add_no_lock(Command& command, Locking& locking) {
  command.flag(
      "--no-lock", [&locking] { locking = Locking::if_possible; },
      "do not lock files on a file system without locks; make sure that nothing else uses them");
}

void add_set(Command& command, std::vector<std::string>& overrides, const std::string& example) {
  command
      .value("--set", overrides,
             "override a key of the spec" + example + "; of [hoop] also --hoop.NAME.mass VALUE")
      .shown_as("KEY=VALUE");
}

Spec read_given_spec(const std::string& path, const std::vector<std::string>& overrides,
                     const std::function<void(const Spec&)>& check) {
  // "slope" of "design.slope=0.4"; of [hoop] with the weight's name.
  const auto key_of = [](const std::string& set) {
    const std::string name = set.substr(0, set.find('='));
    const std::size_t dot = name.find('.');
    if (dot == std::string::npos || name.starts_with("hoop.")) return name;
    const Option* option = find_option(name.substr(0, dot), name.substr(dot + 1));
    return option && find_option("", option->key) == option ? std::string(option->key) : name;
  };
  Spec spec = read_spec(path, overrides);  // first, so that what is wrong is said alone
  if (check) check(spec);
  for (const std::string& note : spec.notes) tell(note);
  std::vector<std::string> keys;
  for (const std::string& set : overrides) keys.push_back(key_of(set));
  for (auto key = keys.begin(); key != keys.end(); ++key) {
    if (std::find(keys.begin(), key, *key) != key) continue;  // reported at its first place
    const auto last = std::find(keys.rbegin(), keys.rend(), *key).base() - 1;
    if (last != key)
      tell(fmt::format("{} is given twice on the command line: {} is used", *key,
                       overrides[static_cast<std::size_t>(last - keys.begin())]));
  }
  constexpr double largest_usual = 20.0;  // [rad]: a whole number beyond that is rather one of degrees
  if (const double angle = spec.design.release_angle;
      std::abs(angle) > largest_usual && angle == std::round(angle))
    tell(fmt::format("release_angle = {0:g} is in rad; for degrees write {0:g}deg", angle));
  return spec;
}

void refuse_scatter(const std::vector<std::string>& overrides, const std::string& why) {
  for (const std::string& set : overrides)
    for (const std::string_view begin : {"scatter.", "tolerances.", "goal.", "samples=", "seed="})
      if (set.starts_with(begin)) throw InputError("--set " + set + ": has no effect here; " + why);
}

void add_flags_of_the_scene(Command& command, std::vector<std::string>& overrides, std::string_view without) {
  command.group("Scene");
  for (const Option* option : hop_options())
    if (option->section == "scene" && option->key != without) add_flag_of(command, *option, overrides);
}

void add_flags_of_a_hoop(Command& command, std::vector<std::string>& overrides, std::string_view without) {
  command.group("Hoop and release");
  for (const Option* option : hop_options())
    if (option->section == "design") add_flag_of(command, *option, overrides);
  add_flags_of_the_scene(command, overrides, without);
}

void add_threads(Command& command, int& threads) {
  command.value("--threads", threads, "number of threads; default: all").check(whole_number(1, most_threads));
}

}  // namespace leapmap::cli
