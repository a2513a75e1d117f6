// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shown_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <variant>

#include "leapmap/errors.hpp"
#include "spec/options.hpp"
#include "spec/quantity.hpp"

namespace leapmap::cli {
namespace {

constexpr std::string_view example = "\"mm deg ms rpm N.m N.s\"";

}  // namespace

/// A unit of several words is written with points: "N.m".
ShownUnits::ShownUnits(const std::string& text, const Scales& scales) : scales_(scales) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!units_.empty() && units_.back() == "N" && (word == "s" || word == "m"))
      throw InputError(
          fmt::format("--units: 'N {0}' may be one unit or two; allowed: N.{0}, or {0} before N", word));
    units_.push_back(word);
  }
  used_.resize(units_.size());
  try {
    for (const std::string& unit : units_) static_cast<void>(units_in_own(unit, "m", scales));
  } catch (const InputError& error) {
    throw InputError(fmt::format("--units: {}; allowed: units with blanks between them, for example {}",
                                 error.what(), example));
  }
}

/// J and N.m measure the same: J is better for energies, and no torque is in J.
ShownUnit ShownUnits::choose(std::string_view own, bool is_torque) {
  ShownUnit shown{own == "1" ? "" : std::string(own), 1.0};
  bool found = false, is_odd = true;
  for (std::size_t k = 0; k < units_.size(); ++k) {
    const auto factor = units_in_own(units_[k], own, scales_);
    const bool odd = own == "(m + m_p) g R" && units_[k].ends_with('J') == is_torque;
    if (!factor || (odd && is_torque)) continue;
    used_[k] = true;
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

std::string ShownUnits::told(double value, std::string_view own, bool is_torque) {
  const ShownUnit asked = choose(own, is_torque);
  if (asked.unit != own && !asked.unit.empty())
    return fmt::format("{:.6g} {}", value * asked.factor, asked.unit);
  if (own == "rad") return in_drawing(value, own, is_torque);
  const OwnUnit* row = find_own_unit(own);
  if (!row) return fmt::format("{:.6g}", value);
  const std::string text =
      own == row->si ? fmt::format("{:.6g} {}", value, own) : fmt::format("{:.6g}", value);
  const std::string drawn = in_drawing(value, own, is_torque);
  return drawn.empty() ? text : fmt::format("{} ({})", text, drawn);
}

std::string ShownUnits::in_drawing(double value, std::string_view own, bool is_torque) const {
  const OwnUnit* row = find_own_unit(own);
  if (!row) return {};
  if (own == "rad") return fmt::format("{:.6g} deg", value * 180.0 / std::numbers::pi);
  if (own == row->si && own != "m" && own != "kg") return {};
  const std::string drawn(own == "(m + m_p) g R" && !is_torque ? "J" : row->example);
  const auto factor = units_in_own(drawn, own, scales_);
  return factor ? fmt::format("{:.4g} {}", value * *factor, drawn) : std::string();
}

std::string ShownUnits::beside(double value, const Field& field) {
  if (std::holds_alternative<Derivative>(field.source)) return {};
  const std::string_view own = own_unit(field);
  const std::string drawn = in_drawing(value, own, false);
  return drawn.empty() || choose(own, false).unit != own ? "" : " (" + drawn + ")";
}

std::string ShownUnits::beside(double value, std::string_view parameter) {
  const Option* option = find_option("", parameter);
  const std::string drawn = option ? in_drawing(value, option->unit, true) : "";
  return drawn.empty() ? "" : " (" + drawn + ")";
}

std::string ShownUnits::with_unit(double value, const Field& field) {
  const ShownUnit shown = of(field);
  return fmt::format("{:.6g}{}{}{}", value * shown.factor, shown.unit.empty() ? "" : " ", shown.unit,
                     beside(value, field));
}

std::string ShownUnits::told(double value, const Field& field) { return told(value, own_unit(field), false); }

std::string ShownUnits::told(double value, std::string_view parameter) {
  const Option* option = find_option("", parameter);
  return told(value, option ? option->unit : "1", true);
}

std::string ShownUnits::lines_of(const Outcome& outcome, const Scene& scene) {
  std::string lines;
  for (const Field* field : fields_of(scene)) {
    const std::optional<OutcomeNumber> number = number_of(*field);
    if (!number) continue;
    const ShownUnit shown = of(*field);
    if (const double value = number->of(outcome); !std::isnan(value))
      lines += fmt::format("  {:<26} {:<14.8g} {}\n", field->name, value * shown.factor, shown.unit);
  }
  return lines;
}

void ShownUnits::refuse_unusable(const Scene& scene, const std::vector<std::string>& parameters) {
  for (const std::string& parameter : parameters) of(parameter);
  for (const Field* field : fields_of(scene)) of(*field);
  refuse_unused();
}

std::vector<std::string> ShownUnits::without_column() const {
  std::vector<std::string> without;
  for (std::size_t k = 0; k < units_.size(); ++k) {
    if (used_[k]) continue;
    const bool fits = std::ranges::any_of(map_fields(), [&](const Field& field) {
      return units_in_own(units_[k], own_unit(field), scales_).has_value();
    });
    if (!fits) refuse_unused();
    without.push_back(units_[k]);
  }
  return without;
}

void ShownUnits::refuse_unused() const {
  for (std::size_t k = 0; k < units_.size(); ++k)
    if (!used_[k])
      throw InputError(fmt::format(
          "--units: no column can be given in {}{}; allowed: units of the columns with "
          "blanks between them, for example {}",
          units_[k],
          scales_.mass > 0.0 && scales_.radius > 0.0 ? ""
                                                     : " (the total mass or the size is not known, or each "
                                                       "design has its own: leapmap export converts "
                                                       "those)",
          example));
}

}  // namespace leapmap::cli
