// SPDX-License-Identifier: GPL-3.0-or-later
/// Each field of an outcome as maps store it, declared once: name, type, unit, meaning, and where its value
/// comes from. The encoder, retry, audit, hop, JSON, the FORMAT page, the web page and Python read these
/// rows.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "model/parameters.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

/// What an error of a quantity is: that of a height is absolute, of a time relative, of any other relative to
/// one more than its size.
enum class Measure { height, time, other };

/// A measured quantity, stored as f8, NaN where it does not apply.
struct Quantity {
  double Outcome::*member;
  Measure measure = Measure::other;
};

/// A small code, stored as u1.
struct Code {
  std::uint8_t (*value)(const Outcome&);    ///< nullptr: it is no part of an outcome
  void (*put)(Outcome&, std::uint8_t);      ///< the inverse
  std::uint8_t fill;                        ///< what a design not computed shows
  std::span<const std::string_view> names;  ///< flag_meanings of 0, 1, 2, ...; empty: a count
};

/// A word of bits, stored as u8 of HDF5's (64 bits).
struct Word {
  std::uint64_t Outcome::*member;
};

/// A quantity of a later jump, stored as f8, NaN where there is no such jump.
struct OfJump {
  OutcomeNumber number;
  Measure measure;
};

/// A derivative of a quantity by a parameter of the design, stored as f8, NaN where the quantity does not
/// apply or the derivative is infinite.
struct Derivative {
  OutcomeNumber of;
  double Design::*by;       ///< nullptr: by a number of [hoop]
  std::string_view hoop{};  ///< its key, "hoop.slug.mass"
};

/// What is told of the hoops made after a drawing, of those that jump where it is of a quantity.
enum class Statistic : std::uint8_t { yield, cut_off, unsolved, mean, sd, q05, q50, q95, worst_case };

/// One of these, or its standard error, stored as f8.
struct OfMade {
  Statistic statistic;
  double Outcome::*of;  ///< nullptr: of all hoops made
  bool error;
};

/// What is proved of a cell of a map.
enum class CellFinding : std::uint8_t {
  none,     ///< nothing was looked at
  proved,   ///< all designs have one outcome
  crossed,  ///< two designs have different ones
  open      ///< neither is known
};

/// What a map may hold of that: the finding itself, stored as u1, and bounds of all jumps, stored as f8.
enum class ProofColumn : std::uint8_t { finding, height_low, height_high, time_low, time_high };
inline constexpr std::size_t proof_columns = 5;

/// Where a field is found if nobody names the fields wanted: in maps and in what solve and hop tell; in the
/// latter only; or nowhere, as it costs too much.
enum class ByDefault : std::uint8_t { stored, told, left_out };

struct Field {
  std::string_view name;
  std::variant<Quantity, Code, Word, OfJump, Derivative, OfMade, ProofColumn> source;
  std::string_view unit;  ///< as UDUNITS reads it; "1": a pure number
  std::string_view long_name;
  int since = 0;             ///< the minor version of the map's format that brought it
  OnlyOf only_of{};          ///< the scenes that fill it
  bool of_sequence = false;  ///< of scenes with more jumps than one
  bool of_gait = false;      ///< of scenes that look for gaits
  ByDefault by_default = ByDefault::stored;
  bool of_wall = false;                   ///< of scenes with a clear_height
  bool of_way = false;                    ///< of the way to a jump, for which the design is solved once more
  bool Wanted::*needs = nullptr;          ///< what a solver has to be asked for; nullptr: nothing
  std::optional<ProofColumn> of_proof{};  ///< what it tells of what is proved
};

/// Whether a design of the scene has it.
bool has(const Scene& scene, const Field& field);

/// The unit of a field's numbers, of model/own_units.hpp: "hoop diameters", "sqrt(g R)", "s", "1" and so on.
std::string_view own_unit(const Field& field);

/// A field's value where it is a number, NaN where it does not apply. Words have none.
double stored_number(const Field& field, const Outcome& outcome);

/// Every field of a map, in the order of the file, but for those of later jumps, derivatives and what is of
/// hoops as made.
std::span<const Field> map_fields();

/// jump_height_2, jump_time_2 and so on: the same fields for each jump, those of jump 2 first.
std::span<const Field> jump_fields();

/// Those of both that a scene has.
std::vector<const Field*> fields_of(const Scene& scene);

/// The number that a field stores of an outcome, if it stores one.
std::optional<OutcomeNumber> number_of(const Field& field);

/// Whether that number's derivatives can be told: not of gaits, nor of how errors grow.
bool can_be_differentiated(const Field& field);
/// Likewise, in that scene: what a wall in metres decides has none by the hoop's size.
bool can_be_differentiated(const Field& field, const Scene& scene);

/// The derivatives that a map may hold besides, jump_height_by_slope and so on: of each quantity, in the
/// order of map_fields, by each parameter of a design, in the order of parameters.
std::span<const Field> gradient_fields();
/// One of these; nullptr: the member is no quantity, or no parameter.
const Field* find_gradient(const OutcomeNumber& of, double Design::*by);

/// The derivative by a number of [hoop], jump_height_by_hoop.slug.mass. Weights have names of their own, so
/// that such a row is made when it is first asked for; it lives as long as the program.
const Field* find_body_gradient(const OutcomeNumber& of, std::string_view key);

/// What a map may hold of hoops as made: yield, jump_height_mean and so on, each followed by its error.
std::span<const Field> scatter_fields();

/// What a map may hold of what is proved of its cells.
std::span<const Field> proof_fields();

/// The quantities of which these are statistics, in the order of map_fields.
std::vector<const Field*> quantities_of(const std::vector<const Field*>& statistics);

/// The field of that name, of any of these kinds, or nullptr.
const Field* find_field(std::string_view name);

}  // namespace leapmap
