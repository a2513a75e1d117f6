// SPDX-License-Identifier: GPL-3.0-or-later
/// What find_designs is asked: which parameters are free, what a hoop must do, and what is best.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "model/fields.hpp"
#include "spec/designs.hpp"
#include "spec/spacing.hpp"
#include "spec/spec.hpp"
#include "tolerance/made_sample.hpp"

namespace leapmap {

struct FreeParameter {
  std::string name;
  Variable variable;
  Side side;
};

/// What is to be as large or as small as can be: a free parameter, or a field.
struct Objective {
  std::string name;
  bool maximize;
  const Field* field;     ///< nullptr: a parameter
  std::size_t parameter;  ///< its number among the free ones; no meaning for a field

  bool is_of_made() const { return field && std::holds_alternative<OfMade>(field->source); }
  bool is_of_drawn() const { return field && !is_of_made(); }
};

struct Question {
  Spec one;                         ///< of one design: [scene], numerics, [scatter] and the goals of a hoop
  std::vector<FreeParameter> free;  ///< in the order of the spec
  std::vector<Goal> made_goals;     ///< of yield: what many hoops made must come to
  std::vector<Objective> objectives;

  VariedDesigns designs;  ///< by the values of the free parameters

  std::size_t dimensions() const { return free.size(); }
  /// The values of the free parameters at a place of the box: coordinates from 0 to 1 along each.
  std::vector<double> values(std::span<const double> place) const;
  /// The same box as a coarse grid, for what asks for one.
  Spec grid() const;
};

/// Whether a goal or an objective is the worst hoop within the tolerances, which is proved of what is found.
bool asks_for_worst_case(const Question& question);

/// Other samples than those of the search, which has favoured designs that do well with its own: for the
/// report.
Scatter fresh_samples(const Scatter& scatter);

/// The axes of a spec as what is free, in its order. Throws InputError for lists of values and for axes of
/// one.
std::vector<FreeParameter> free_parameters(const Spec& spec);

/// Throws InputError for a spec that asks nothing: without a free parameter or without an objective, with
/// more than two, with goals that contradict themselves or each other; and as check_spec does.
Question question_of(const Spec& spec);

}  // namespace leapmap
