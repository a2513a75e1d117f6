// SPDX-License-Identifier: GPL-3.0-or-later
/// What the explorer's page asks of leapmap, compiled to WebAssembly, and what it is told: hoop.cpp one hoop,
/// hoops.cpp many, made.cpp hoops as made.
///
/// The page writes parameter_values() in place, calls a function that solves, and reads the rest, all of it
/// the last solve's. Names and units are those of `leapmap hop --json`.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "leapmap/body.hpp"
#include "leapmap/design.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scene.hpp"
#include "model/fields.hpp"
#include "model/parameters.hpp"
#include "model/variable.hpp"
#include "trajectory/sequence.hpp"
#include "trajectory/solver.hpp"

#define LEAPMAP_EXPORT extern "C" __attribute__((visibility("default"), used))

namespace leapmap::web {

/// The page's one design, what it asks of a hoop, and its maps.
struct Page {
  Page();

  Design design() const;
  /// friction: a Friction's number.
  Scene scene(int friction) const;

  std::vector<double> parameters;
  std::optional<Body> drawing;  // from which the parameters follow
  std::vector<SameInSi> held;   // parameters in the units of its hoop
  long jumps = 1, settle = 0;
  bool tells_growth = false;
  std::vector<double> places;  // of a map: two parameters of each design
  std::vector<double> rows;    // of a map: what is told of each design
};
extern Page page;

/// Those that hoops have, which are the first of the table: the page solves no pendulums.
std::span<const Parameter> hoop_parameters();

/// The parameter of a number.
const Parameter& parameter_of(int number);

/// The key of a number that may vary: first the parameters, then those of the drawing's ring and of each of
/// its weights.
std::string variable_key(int number);
/// Nothing: it is the same for all designs, or the page has no drawing.
std::optional<Variable> variable_of(int number);

/// The field of a number among map_fields().
const Field& field_of(int number);

/// The name of the row of that number in a table, null after the last.
template <class Row>
const char* name_at(std::span<const Row> rows, int i) {
  return i >= 0 && static_cast<std::size_t>(i) < rows.size() ? rows[static_cast<std::size_t>(i)].name.data()
                                                             : nullptr;
}

/// What a map computed on the page tells of each design: all numbers and codes.
const std::vector<const Field*>& row_fields();

/// Designs that differ from the page's in two numbers, and the number of each among the page's places.
struct PlacedDesigns {
  std::vector<Design> designs;
  std::vector<Body> bodies;  // from which they follow; none without a drawing
  std::vector<std::size_t> which;
};
/// Those of the page's places, but for what no design can have. first, second: of variable_of.
PlacedDesigns placed_designs(int first, int second);

JumpSolver<double> jump_solver(const Scene& scene, double tolerance, const Wanted& wanted = {});

/// Solves first jumps, or as many as the scene has.
Solver solver_of(const Scene& scene, double tolerance);

/// Fills in what was asked for besides jumps: gaits, and how errors grow.
void tell_more(const Scene& scene, double tolerance, std::span<const Design> designs,
               std::span<Outcome> outcomes);

}  // namespace leapmap::web
