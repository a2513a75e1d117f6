// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/worst_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <vector>

#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/solve.hpp"
#include "model/fields.hpp"
#include "spec/options.hpp"

namespace leapmap {
namespace {

constexpr std::array<std::string_view, 4> provable{"jump_height", "status", "spurious_first_jump",
                                                   "candidates"};

/// The numbers that a hoop's goals ask for, from a design's outcome or from what is proved of many.
Enclosure number_of_goal(const Goal& goal, const Proof& proof) {
  const auto exactly = [](double value) { return Enclosure{value, value}; };
  if (goal.field == "jump_height") return proof.height;
  if (goal.field == "status") return exactly(static_cast<double>(proof.status));
  if (goal.field == "candidates" && proof.lift_offs < 0) return {-HUGE_VAL, HUGE_VAL};
  if (goal.field == "candidates") return exactly(static_cast<double>(proof.lift_offs));
  return exactly(proof.spurious_first_jump);
}

enum class Reached { all, none, some };

/// Whether all hoops of a box of one outcome reach the goals.
Reached reach(const std::vector<Goal>& goals, const Proof& proof) {
  if (proof.status != Status::jumped) {
    const bool asked_for = std::ranges::any_of(goals, [](const Goal& goal) {
      return goal.field == "status" && goal.at_least != static_cast<double>(Status::jumped);
    });
    if (!asked_for) return Reached::none;
  }
  Reached reached = Reached::all;
  for (const Goal& goal : goals) {
    const double unit = goal.unit_of_nominal > 0.0 ? goal.unit_of_nominal : 1.0;
    const double at_least = goal.at_least / unit, at_most = goal.at_most / unit;
    const Enclosure number = number_of_goal(goal, proof);
    if (number.low >= at_least && number.high <= at_most) continue;
    if (!(number.high >= at_least) || !(number.low <= at_most)) return Reached::none;
    reached = Reached::some;
  }
  return reached;
}

Proof of_one(const Outcome& outcome) {
  Proof proof;
  proof.proved = true;
  proof.status = outcome.status, proof.spurious_first_jump = outcome.spurious_first_jump;
  proof.lift_offs = outcome.candidates;
  proof.height = {outcome.jump_height, outcome.jump_height};
  return proof;
}

struct Part {
  DesignBox box;
  std::size_t cuts = 0;
  double low = -HUGE_VAL;  ///< no hoop is known to jump lower; of a part that is not proved nothing is known

  bool operator<(const Part& other) const { return low > other.low; }  // the lowest first
};

/// Tolerances as a box about the nominal design.
DesignBox box_of(const Spec& spec, std::vector<double Design::*>& varying) {
  DesignBox box{spec.design, spec.design};
  for (const Spread& spread : spec.scatter.spreads) {
    const auto refuse = [&](const std::string& what, const std::string& allowed) {
      throw InputError(
          fmt::format("{}: tolerances.{} {}; allowed: {}", origin_of(spec), spread.parameter, what, allowed));
    };
    if (spread.law != Spread::Law::uniform) refuse("is normal, which has no bounds", "uniform");
    const Option* option = find_option("design", spread.parameter);
    if (!option || !member_of(*option)) refuse("is a number of [hoop]", "parameters of a design");
    const auto member = member_of(*option);
    const double width = spread.percent ? std::abs(spec.design.*member) * spread.width / 100.0 : spread.width;
    box.from.*member = std::max(spec.design.*member - width, option->range.least);
    box.to.*member = std::min(spec.design.*member + width, option->range.most);
    if (width > 0.0) varying.push_back(member);
  }
  return box;
}

}  // namespace

void check_worst_case(const Spec& spec) {
  if (spec.scene.friction != Friction::sticking)
    throw InputError(fmt::format(
        "{}: friction = coulomb: nothing can be proved with friction; allowed: sticking", origin_of(spec)));
  for (const Goal& goal : spec.goals)
    if (std::ranges::find(provable, goal.field) == provable.end())
      throw InputError(fmt::format("{}: goal.{}: nothing can be proved of it; allowed: {}", origin_of(spec),
                                   goal.field, fmt::join(provable, ", ")));
  std::vector<double Design::*> varying;
  static_cast<void>(box_of(spec, varying));
}

namespace {

class Search {
 public:
  Search(const Spec& spec, const WorstCaseOptions& options) : spec_(spec), options_(options) {
    todo_.push({box_of(spec, varying_)});
  }

  WorstCase run() {
    while (!todo_.empty() && found_.answer != WorstCase::Answer::counterexample && !is_known() && goes_on())
      take(wave());
    finish();
    return found_;
  }

 private:
  struct Looked {
    Part part;
    Proof proof;
    Design design;  ///< in the middle, or a corner, whichever jumps lowest
    Outcome outcome;
  };

  bool goes_on() const {
    return found_.boxes < options_.most_boxes && !(options_.stop_requested && options_.stop_requested());
  }
  /// The lowest jump is known well enough, and every hoop is known to reach the goals.
  bool is_known() const {
    return unproved_ == 0 && lowest_found_ - std::min(todo_.top().low, lowest_done_) < options_.resolution;
  }

  std::vector<Part> wave() {
    constexpr std::size_t most = 32;
    std::vector<Part> parts;
    while (!todo_.empty() && parts.size() < most) {
      parts.push_back(todo_.top());
      if (todo_.top().low == -HUGE_VAL) --unproved_;
      todo_.pop();
    }
    return parts;
  }

  void take(const std::vector<Part>& parts) {
    std::vector<Looked> looked(parts.size());
    parallel_for_each(parts.size(), options_.threads, {}, [&] {
      return [&](std::size_t i) {
        looked[i] = look(parts[i]);
        return true;
      };
    });
    for (const Looked& one : looked) settle(one);
  }

  Looked look(const Part& part) const {
    Looked looked{part, prove(part.box, spec_.scene), {}, {}};
    std::vector<Design> designs = sample(part.box);
    for (std::size_t i = 0; i < designs.size(); ++i) {
      const Outcome outcome = solve(designs[i], spec_.scene);
      const bool misses = reach(spec_.goals, of_one(outcome)) == Reached::none;
      if (i > 0 && !misses && !(outcome.jump_height < looked.outcome.jump_height)) continue;
      looked.design = designs[i], looked.outcome = outcome;
      if (misses) break;
    }
    return looked;
  }

  /// The middle of a box, and its corners.
  std::vector<Design> sample(const DesignBox& box) const {
    Design middle = box.from;
    for (const auto member : varying_) middle.*member += 0.5 * (box.to.*member - box.from.*member);
    std::vector<Design> all{middle};
    for (std::size_t corner = 0; corner < std::size_t{1} << varying_.size(); ++corner) {
      Design design = box.from;
      for (std::size_t k = 0; k < varying_.size(); ++k)
        if (corner >> k & 1u) design.*varying_[k] = box.to.*varying_[k];
      all.push_back(design);
    }
    return all;
  }

  void settle(const Looked& looked) {
    ++found_.boxes;
    if (found_.answer == WorstCase::Answer::counterexample) return;
    const bool misses = reach(spec_.goals, of_one(looked.outcome)) == Reached::none;
    if (misses || looked.outcome.jump_height < lowest_found_) {
      found_.worst = looked.design, found_.outcome = looked.outcome;
      if (!misses) lowest_found_ = looked.outcome.jump_height;
    }
    if (misses) {
      const Proof proof = prove(looked.design, spec_.scene);
      if (proof.proved && reach(spec_.goals, proof) == Reached::none)
        found_.answer = WorstCase::Answer::counterexample;
    }
    const Proof& proof = looked.proof;
    const bool reaches = proof.proved && reach(spec_.goals, proof) == Reached::all;
    if (!proof.proved) event_ = proof.open;
    if (reaches && (varying_.empty() || proof.height.low >= lowest_found_ - options_.resolution)) {
      lowest_done_ = std::min(lowest_done_, proof.height.low);
      return;
    }
    if (varying_.empty()) {
      lowest_done_ = -HUGE_VAL;
      return;
    }
    const auto member = varying_[looked.part.cuts % varying_.size()];
    const DesignBox& box = looked.part.box;
    const double middle = box.from.*member + 0.5 * (box.to.*member - box.from.*member);
    Part low = looked.part, high = low;
    low.box.to.*member = high.box.from.*member = middle;
    for (Part* half : {&low, &high}) {
      ++half->cuts;
      half->low = reaches ? proof.height.low : -HUGE_VAL;
      if (!reaches) ++unproved_;
      todo_.push(*half);
    }
  }

  void finish() {
    if (found_.answer == WorstCase::Answer::counterexample) return;
    const double low = std::min(lowest_done_, todo_.empty() ? HUGE_VAL : todo_.top().low);
    if (unproved_ > 0 || low == -HUGE_VAL) {
      found_.open = event_.empty() ? "a height beside a goal" : event_;
      return;
    }
    found_.answer = WorstCase::Answer::proved;
    if (std::isfinite(lowest_found_)) found_.height = {low, lowest_found_};
  }

  const Spec& spec_;
  const WorstCaseOptions& options_;
  std::vector<double Design::*> varying_;
  std::priority_queue<Part> todo_;
  WorstCase found_;
  long unproved_ = 1;  ///< parts still to be looked at for the first time
  double lowest_found_ = HUGE_VAL, lowest_done_ = HUGE_VAL;  ///< of hoops found; bound of parts that are done
  std::string event_;
};

}  // namespace

WorstCase worst_case(const Spec& spec, const WorstCaseOptions& options) {
  check_worst_case(spec);
  return Search(spec, options).run();
}

}  // namespace leapmap
