// SPDX-License-Identifier: GPL-3.0-or-later
/// The numbers that may differ from design to design: the parameters, and those of [hoop].
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hoop/body.hpp"
#include "leapmap/body.hpp"
#include "model/parameters.hpp"

namespace leapmap {

/// A number of a ring or of a weight, declared once.
struct BodyNumber {
  std::string_view name;
  std::variant<double Body::*, double Weight::*> member;
  std::string_view unit;  ///< of model/own_units.hpp
  bool needed;
  std::string_view meaning;  ///< of a weight: {} stands for its name
  Range range;               ///< of a weight's `at`: before the radius is known

  bool of_weight() const { return std::holds_alternative<double Weight::*>(member); }
  /// The meaning with the weight's name, or with "the weight".
  std::string meaning_of(std::string_view weight = "the weight") const;
};

/// All of them, the ring's first.
std::span<const BodyNumber> body_numbers();

/// The parameters that follow from a body.
inline constexpr std::array<double Design::*, 3> body_ratios{&Design::mass_ratio, &Design::offset_ratio,
                                                             &Design::inertia_factor};

inline bool follows_from_body(double Design::*parameter) {
  return std::find(body_ratios.begin(), body_ratios.end(), parameter) != body_ratios.end();
}

/// The row of "hoop.mass" or "hoop.NAME.mass", whatever the NAME; nullptr: it is no such key.
const BodyNumber* find_body_number(std::string_view key);

/// "slug" of "hoop.slug.mass"; empty: a number of the ring.
std::string_view weight_of(std::string_view key);

/// Whether a key is the mass of the ring or of a weight.
bool is_body_mass(std::string_view key);

/// The derivatives by the logarithms of the hoop's mass and size [the quantity's unit].
struct ByScale {
  double mass = 0.0, size = 0.0;

  /// in_seconds: the quantity itself, if it is a time or a speed, which grows with the root of the size; else
  /// 0. held: parameters that hoops share in the SI; the derivatives by them are by the nominal hoop's
  /// units.
  static ByScale of(const Design& design, const Design& by, double in_seconds,
                    std::span<const SameInSi> held) {
    ByScale found{0.0, 0.5 * in_seconds};
    for (const SameInSi& one : held) {
      if (design.*one.parameter == 0.0) continue;  // its derivative may be infinite
      const double by_logarithm =
          by.*one.parameter * design.*one.parameter / one.of_hoop(design.mass, design.size);
      found.mass += one.with_mass * by_logarithm, found.size += one.with_size * by_logarithm;
    }
    return found;
  }
};

/// A number that may vary, and where a design or its body keeps it.
class Variable {
 public:
  std::string key{};        ///< "slope", "hoop.slug.mass"
  std::string_view unit{};  ///< of model/own_units.hpp; "1": a pure number
  Range range{};
  std::size_t order = 0;  ///< of parameters and numbers of [hoop], whatever the order they are named in
  OnlyOf only_of{};

  bool of_body() const { return parameter_ == nullptr; }
  /// The member of a parameter; nullptr: it is of the body.
  double Design::*parameter() const { return parameter_; }
  double& in(Design& design, Body& body) const;
  double of(const Design& design, const Body& body) const;
  /// The derivative by it, from those by the parameters: of a number of the body, by way of the three ratios
  /// and of the hoop's mass and size.
  double derivative(const Design& by, const Body& body, const ByScale& by_scale = {}) const;

 private:
  friend std::optional<Variable> find_variable(std::string_view key, const Body* body);
  double Design::*parameter_ = nullptr;
  double Body::*ring_ = nullptr;
  std::size_t weight_ = 0;
  double Weight::*of_weight_ = nullptr;
};

/// The numbers of a body that may vary and that it gives, in the table's order.
std::vector<Variable> variables_of(const Body& body);

/// The parameters by which derivatives are needed for those by the variables, each once.
std::vector<Variable> parameters_of(std::span<const Variable> variables);

/// The variable of that key. body: of [hoop], or nullptr. Nothing: there is none, or it is the same for all
/// designs.
std::optional<Variable> find_variable(std::string_view key, const Body* body);

}  // namespace leapmap
