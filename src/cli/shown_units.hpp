// SPDX-License-Identifier: GPL-3.0-or-later
/// --units "mm g deg ms": the units in which reports and tables show numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/fields.hpp"
#include "model/own_units.hpp"

namespace leapmap::cli {

/// How a number is shown: so many times what leapmap has, in that unit.
struct ShownUnit {
  std::string unit{};  ///< empty: a pure number, or words
  double factor = 1.0;
};

/// The units asked for. Each number takes the first that fits; without one it stays in leapmap's own.
class ShownUnits {
 public:
  /// Throws InputError for a unit that UDUNITS does not know.
  ShownUnits(const std::string& text, const Scales& scales);
  /// The same units for a hoop of another size or mass.
  void scale(const Scales& scales) { scales_ = scales; }

  bool are_asked_for() const { return !units_.empty(); }
  /// Of a quantity; derivatives stay in the map's units.
  ShownUnit of(const Field& field);
  /// Of a parameter, or a number of [hoop], by its name; of any other name none.
  ShownUnit of(std::string_view parameter);
  /// A value with its unit: the one asked for; if none fits, leapmap's own, and beside it one of a drawing
  /// where the scale is known: "0.5 (60 mm)".
  std::string told(double value, const Field& field);
  std::string told(double value, std::string_view parameter);
  /// The value in the unit of a drawing, where the scale is known and no unit asked for fits: " (60 mm)";
  /// else empty.
  std::string beside(double value, const Field& field);
  std::string beside(double value, std::string_view parameter);
  /// A value in the unit asked for, or in leapmap's own and that of a drawing: "0.5 hoop diameters (60 mm)".
  std::string with_unit(double value, const Field& field);
  /// A line for each number of an outcome, in the units asked for.
  std::string lines_of(const Outcome& outcome, const Scene& scene);
  /// Throws InputError if a unit fits neither a field of the scene nor one of these parameters.
  void refuse_unusable(const Scene& scene, const std::vector<std::string>& parameters = {});
  /// Throws InputError if a unit has fitted nothing.
  void refuse_unused() const;
  /// The units that have fitted nothing, though some quantity of a hoop of that size and mass is in them.
  /// Throws InputError for one that no quantity is in.
  std::vector<std::string> without_column() const;

 private:
  ShownUnit choose(std::string_view own, bool is_torque);
  std::string told(double value, std::string_view own, bool is_torque);
  /// "60 mm" of a value in leapmap's own unit; empty: the scale is not known, or there is no better unit.
  std::string in_drawing(double value, std::string_view own, bool is_torque) const;

  std::vector<std::string> units_;
  std::vector<bool> used_;
  Scales scales_;
};

}  // namespace leapmap::cli
