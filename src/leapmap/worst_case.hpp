// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// The worst hoop within tolerances, proved.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "leapmap/prove.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

/// What is proved of all hoops within the uniform tolerances of a spec.
struct WorstCase {
  /// What is known of the goals.
  enum class Answer {
    proved,          ///< every hoop reaches every goal; without goals: every hoop jumps
    counterexample,  ///< one does not
    open             ///< neither is known yet
  };
  Answer answer = Answer::open;     ///< whether every hoop reaches every goal
  std::string open{};               ///< if open: what is too near, in words
  std::optional<Design> open_at{};  ///< if open: a hoop beside which that is
  Enclosure height{};  ///< of the lowest jump [hoop diameters]; NaN: some hoop does not jump, or not known
  std::optional<Design> worst{};  ///< the lowest jump found, or the hoop that misses a goal
  Outcome outcome{};              ///< of it
  long boxes = 0;                 ///< evaluated
};

/// Options of worst_case.
struct WorstCaseOptions {
  int threads = 0;           ///< number of threads; 0: all that OpenMP offers
  long most_boxes = 20'000;  ///< what is then not known stays open
  double resolution = 1e-3;  ///< how far the lowest height may stay unknown [hoop diameters]
  std::function<void(long boxes, long open)> progress{};  ///< receives boxes evaluated, and boxes in hand
  std::function<bool()> stop_requested{};                 ///< polled; true: what is known by then is returned
};

/// Throws InputError for a spec of which no worst case can be proved.
void check_worst_case(const Spec& spec);

/// Proves whether every hoop within the tolerances reaches the goals, and encloses the height of the lowest
/// jump. Throws InputError for tolerances that are not uniform or of numbers of [hoop], for goals but those
/// of jump_height, status, spurious_first_jump and candidates, and as prove does.
WorstCase worst_case(const Spec& spec, const WorstCaseOptions& options = {});

}  // namespace leapmap
