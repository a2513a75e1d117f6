// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shown_units.hpp"

#include <fmt/format.h>

#include <sstream>
#include <variant>

#include "leapmap/errors.hpp"
#include "spec/options.hpp"
#include "spec/quantity.hpp"

namespace leapmap::cli {
namespace {

constexpr std::string_view example = "\"mm deg ms rpm N.m\"";

}  // namespace

/// A unit of several words is written with points: "N.m".
ShownUnits::ShownUnits(const std::string& text, const Scales& scales) : scales_(scales) {
  std::istringstream words(text);
  for (std::string word; words >> word;) units_.push_back(word);
  used_.resize(units_.size());
  try {
    for (const std::string& unit : units_) static_cast<void>(units_in_own(unit, "m", scales));
  } catch (const InputError& error) {
    throw InputError(fmt::format("--units: {}; allowed: units with blanks between them, for example {}",
                                 error.what(), example));
  }
}

/// J and N.m measure the same: J is better for energies, N.m for torques.
ShownUnit ShownUnits::choose(std::string_view own, bool is_torque) {
  ShownUnit shown{own == "1" ? "" : std::string(own), 1.0};
  bool found = false, is_odd = true;
  for (std::size_t k = 0; k < units_.size(); ++k) {
    const auto factor = units_in_own(units_[k], own, scales_);
    if (!factor) continue;
    used_[k] = true;
    const bool odd = own == "(m + m_p) g R" && units_[k].ends_with('J') == is_torque;
    if (found && (odd || !is_odd)) continue;
    found = true, is_odd = odd;
    shown = {units_[k], *factor};
  }
  return shown;
}

ShownUnit ShownUnits::of(const Field& field) {
  if (std::holds_alternative<Derivative>(field.source))
    return {field.unit == "1" ? "" : std::string(field.unit), 1.0};
  return choose(own_unit(field), false);
}

ShownUnit ShownUnits::of(std::string_view parameter) {
  const Option* option = find_option("", parameter);
  return choose(option ? option->unit : "1", true);
}

void ShownUnits::refuse_unused() const {
  for (std::size_t k = 0; k < units_.size(); ++k)
    if (!used_[k])
      throw InputError(fmt::format(
          "--units: no column can be given in {}{}; allowed: units of the columns with "
          "blanks between them, for example {}",
          units_[k], scales_.mass > 0.0 ? "" : " (no total mass is known, by scene.mass or [hoop])",
          example));
}

}  // namespace leapmap::cli
