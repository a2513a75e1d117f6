// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/proof_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/output.hpp"
#include "cli/shown_units.hpp"
#include "cli/spoken.hpp"
#include "model/fields.hpp"
#include "spec/designs.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap::cli {
namespace {

/// In so many digits, not above the number, or not below it.
std::string rounded(double number, int digits, bool down) {
  const auto text = [&](double value) { return fmt::format("{:.{}g}", value, digits); };
  std::string found = text(number);
  for (double beside = number; down ? std::stod(found) > number : std::stod(found) < number;)
    found = text(beside -=
                 (down ? 0.5 : -0.5) * std::pow(10.0, std::ceil(std::log10(std::abs(number))) - digits));
  return found;
}

/// As many digits as both bounds share, and two more; outwards.
std::string told(const Enclosure& within) {
  const double width = within.high - within.low, size = std::max(std::abs(within.high), 1e-300);
  constexpr int most = 17;
  const int digits =
      width > 0.0 ? std::clamp(2 - static_cast<int>(std::floor(std::log10(width / size))), 3, most) : most;
  return fmt::format("[{}, {}]", rounded(within.low, digits, true), rounded(within.high, digits, false));
}

std::string in_diameters(const Enclosure& height, const Spec& spec) {
  const double mm = 2000.0 * spec.scene.radius;
  return fmt::format("{} diameters{}", told(height),
                     spec.hoop ? fmt::format(" ({} to {} mm)", rounded(mm * height.low, 4, true),
                                             rounded(mm * height.high, 4, false))
                               : "");
}

}  // namespace

std::string proof_lines(const Proof& proof, const Spec& spec) {
  if (!proof.proved) return fmt::format("Nothing is proved: {} is too near.\n", proof.open);
  std::string lines = fmt::format("Proved: {}", name_of(proof.status));
  if (proof.status == Status::jumped)
    lines += fmt::format(" at lift-off {}", proof.lift_offs);
  else if (proof.lift_offs > 0)
    lines += fmt::format(" after {} lift-offs below the threshold", proof.lift_offs);
  lines += ".\n";
  if (proof.status == Status::jumped)
    lines += fmt::format("Its height lies in {}, its time in {} s.\n", in_diameters(proof.height, spec),
                         told(proof.time));
  return lines;
}

Json proof_json(const Proof& proof) {
  const auto both = [](const Enclosure& within) {
    return std::isnan(within.low) ? Json() : Json::array({within.low, within.high});
  };
  if (!proof.proved) return {{"proved", false}, {"open", proof.open}};
  return {{"proved", true},
          {"status", name_of(proof.status)},
          {"lift_offs", proof.lift_offs},
          {"jump_height", both(proof.height)},
          {"jump_time", both(proof.time)},
          {"first_jump_height", both(proof.first_height)},
          {"first_jump_time", both(proof.first_time)}};
}

std::string worst_case_lines(const WorstCase& found, const Spec& spec) {
  const auto boxes =
      fmt::format("{} box{}", grouped(static_cast<std::size_t>(found.boxes)), found.boxes == 1 ? "" : "es");
  const std::string command = found.worst ? hop_command(spec, *found.worst) : "";
  const std::string what = spec.goals.empty() ? "jumps" : "reaches every goal";
  if (found.answer == WorstCase::Answer::counterexample)
    return fmt::format(
        "Counterexample: not every hoop within the tolerances {} ({}).\nThis one {}: {}\n", what, boxes,
        found.outcome.status == Status::jumped
            ? fmt::format("jumps {:.6g} diameters{}", found.outcome.jump_height,
                          spec.hoop ? fmt::format(" ({:.4g} mm)",
                                                  2000.0 * spec.scene.radius * found.outcome.jump_height)
                                    : "")
            : fmt::format("ends as {}", name_of(found.outcome.status)),
        command);
  std::string lines =
      found.answer == WorstCase::Answer::proved
          ? fmt::format("Proved: every hoop within the tolerances {} ({}).\n", what, boxes)
          : fmt::format("Open after {}: {}; not known is whether every hoop within the tolerances {}.\n",
                        boxes, found.open, what);
  if (found.answer == WorstCase::Answer::open && found.open_at)
    lines += fmt::format("It is near {}\n", hop_command(spec, *found.open_at));
  if (!std::isnan(found.height.low))
    lines += fmt::format("The lowest jump lies in {}.\nNearest to it: {}\n", in_diameters(found.height, spec),
                         command);
  return lines;
}

std::string worst_case_line(const WorstCase& found) {
  if (!std::isnan(found.height.low))
    return fmt::format("worst case: proved, the lowest jump within the tolerances lies in {} diameters",
                       told(found.height));
  return found.answer == WorstCase::Answer::counterexample
             ? "worst case: a hoop within the tolerances does not jump, or misses a goal"
         : found.answer == WorstCase::Answer::proved
             ? "worst case: proved, every hoop within the tolerances reaches the goals"
             : fmt::format("worst case: open, {}", found.open);
}

Json worst_case_json(const WorstCase& found) {
  const bool known = !std::isnan(found.height.low);
  return {{"proved", found.answer == WorstCase::Answer::proved},
          {"jump_height", known ? Json::array({found.height.low, found.height.high}) : Json()},
          {"open", found.open}};
}

void say_findings(const MapReader& map, std::string_view of) {
  const Field& field = *find_field("proof");
  const auto& names = std::get<Code>(field.source).names;
  std::array<std::size_t, 4> counts{};
  const Tiling blocks = map.blocks("proof");
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (const double value : map.read("proof", blocks.tile(b)))
      ++counts[static_cast<std::size_t>(value) % 4];
  const auto all = static_cast<double>(blocks.designs());
  for (std::size_t k = 1; k < counts.size(); ++k)
    say("{:<8} {} of {} {}, {:.2f} %\n", names[k], grouped(counts[k]), grouped(blocks.designs()), of,
        100.0 * static_cast<double>(counts[k]) / all);
}

}  // namespace leapmap::cli
