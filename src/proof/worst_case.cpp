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
#include "proof/acting.hpp"
#include "proof/cells.hpp"
#include "spec/options.hpp"
#include "tolerance/made_hoops.hpp"

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
  if (!proof.proved) {  // what is known is that all jump, and between which heights
    const bool others = std::ranges::any_of(
        goals, [](const Goal& goal) { return goal.field != "jump_height" && goal.field != "status"; });
    if (!proof.all_jump || others) return Reached::some;
    Proof jumped = proof;
    jumped.proved = true, jumped.status = Status::jumped;
    return reach(goals, jumped);
  }
  if (proof.status == Status::failed) return Reached::some;  // nothing is known of it
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
    if (!option || !member_of(*option))
      refuse("is a number of [hoop]",
             "mass_ratio, offset_ratio, inertia_factor and other parameters of a design");
    const auto member = member_of(*option);
    const double width = spread.percent ? std::abs(spec.design.*member) * spread.width / 100.0 : spread.width;
    box.from.*member = inside(option->range, spec.design.*member - width);
    box.to.*member = inside(option->range, spec.design.*member + width);
    if (width > 0.0) varying.push_back(member);
  }
  return box;
}

}  // namespace

void check_worst_case(const Spec& spec) {
  refuse_unprovable(spec.scene, origin_of(spec));
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
    try {
      while (!todo_.empty() && found_.answer != WorstCase::Answer::counterexample && !is_known() && goes_on())
        take(wave());
    } catch (const Stopped&) {  // inside a proof that takes long
      ++unproved_;
    }
    finish();
    return found_;
  }

 private:
  struct Looked {
    Part part;
    Proof proof;
    Design design;    ///< in the middle, or a corner, whichever jumps lowest, or misses a goal
    Outcome outcome;  ///< of it; not computed if none jumps, and none misses

    double lowest() const { return outcome.status == Status::jumped ? outcome.jump_height : HUGE_VAL; }
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
    parallel_for_each(parts.size(), options_.threads, options_.stop_requested, [&] {
      return [&](std::size_t i) {
        looked[i] = look(parts[i]);
        return true;
      };
    });
    for (const Looked& one : looked) settle(one);
    if (options_.progress) options_.progress(found_.boxes, static_cast<long>(todo_.size()));
  }

  Looked look(const Part& part) const {
    Looked looked{part, prove(part.box, spec_.scene), {}, {}};
    for (const Design& design : sample(part.box)) {
      const Outcome outcome = solve(design, spec_.scene);
      const bool misses = reach(spec_.goals, of_one(outcome)) == Reached::none;
      if (!misses && !(outcome.jump_height < looked.lowest())) continue;
      looked.design = design, looked.outcome = outcome;
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
    const bool misses = looked.outcome.status != Status::not_computed &&
                        reach(spec_.goals, of_one(looked.outcome)) == Reached::none;
    if (misses || looked.lowest() < lowest_found_) {
      found_.worst = looked.design, found_.outcome = looked.outcome;
      if (!misses) lowest_found_ = looked.lowest();
    }
    if (misses) {
      const Proof proof = prove(looked.design, spec_.scene);
      if (proof.proved && reach(spec_.goals, proof) == Reached::none)
        found_.answer = WorstCase::Answer::counterexample;
    }
    const Proof& proof = looked.proof;
    const bool reaches = reach(spec_.goals, proof) == Reached::all;
    if (!reaches) {
      event_ = proof.proved ? "a height beside a goal" : proof.open;
      found_.open_at = sample(looked.part.box).front();
    }
    const bool may_be_lower = proof.height.low < lowest_found_ - options_.resolution;
    if (reaches && (varying_.empty() || !may_be_lower)) {
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
    if (!(box.from.*member < middle && middle < box.to.*member)) {  // no double lies between
      lowest_done_ = reaches ? std::min(lowest_done_, proof.height.low) : -HUGE_VAL;
      return;
    }
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
      found_.open = found_.boxes >= options_.most_boxes ? fmt::format("after that many boxes {}", event_)
                    : !todo_.empty()                    ? "the search was stopped"
                                                        : event_;
      return;
    }
    found_.answer = WorstCase::Answer::proved;
    if (!found_.worst) return;
    // That hoop jumps no higher than is proved of it, or of those about it, if it is beside a discontinuity.
    Proof worst = prove(*found_.worst, spec_.scene);
    if (!worst.proved) worst = prove(within_rounding(*found_.worst), spec_.scene);
    if (worst.all_jump) found_.height = {low, worst.height.high};
  }

  const Spec& spec_;
  const WorstCaseOptions& options_;
  std::vector<double Design::*> varying_;
  std::priority_queue<Part> todo_;
  WorstCase found_;
  long unproved_ = 1;  ///< parts to be looked at of which no bound is known
  double lowest_found_ = HUGE_VAL, lowest_done_ = HUGE_VAL;  ///< of hoops found; bound of parts that are done
  std::string event_ = "a height beside a goal";             ///< why a part was not proved last
};

}  // namespace

WorstCase worst_case(const Spec& spec, const WorstCaseOptions& options) {
  check_worst_case(spec);
  return Search(spec, options).run();
}

}  // namespace leapmap
