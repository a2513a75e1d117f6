// SPDX-License-Identifier: GPL-3.0-or-later
/// How good designs are, many at once on all threads.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "design/question.hpp"
#include "request/solver.hpp"
#include "trajectory/solver.hpp"

namespace leapmap {

struct Verdict {
  /// 0: every goal is reached, and every objective applies. Else a sum over those that are missed, at most 1
  /// for each: how far it is missed over that and the bound itself.
  double violation = HUGE_VAL;
  std::array<double, 2> cost{};  ///< the objectives, less is better; where the violation is 0
  std::uint64_t outcome = 0;     ///< designs with the same discrete outcome have the same number

  bool feasible() const { return violation == 0.0; }
};

/// By the first objective; of two that miss a goal, whichever misses less.
inline bool better(const Verdict& a, const Verdict& b) {
  return a.feasible() && b.feasible() ? a.cost[0] < b.cost[0] : a.violation < b.violation;
}

/// A goal kept by a hair: the last digits of a quantity hang on the instruction set, those of a time on which
/// designs were solved together.
Goal tightened(const Goal& goal, double tolerance);

/// One thread's means of judging.
class Bench {
 public:
  /// threads: on which hoops made after one design are solved.
  Bench(const Question& question, const std::shared_ptr<const SobolPoints>& points, int threads = 1);
  /// values: rows of the free parameters' values.
  void judge(std::span<const double> values, std::span<Verdict> verdicts);

 private:
  Verdict verdict_of(const Design& design, const Outcome& outcome) const;
  void judge_made(std::size_t design, Verdict& verdict);
  /// Adds what an objective costs.
  void weigh(std::size_t objective, double value, Verdict& verdict) const;

  const Question& question_;
  std::vector<GoalCheck> goals_;
  Solver solver_;
  std::vector<Design> designs_;
  std::vector<Body> bodies_;  // none unless they vary and hoops are made
  std::vector<Outcome> outcomes_;
  std::optional<ScatterSolver> scatter_;
  MadeColumns columns_;
};

class Judge {
 public:
  /// Keeps a reference to the question. stop_requested: asked between blocks of designs; true: judge throws
  /// Stopped.
  Judge(const Question& question, int threads, std::function<bool()> stop_requested);

  /// places: rows of coordinates, question.dimensions() each. What a verdict is hangs on its place alone but
  /// for the last digits of times.
  void judge(std::span<const double> places, std::span<Verdict> verdicts);
  Verdict judge(std::span<const double> place);
  /// The same of values of the free parameters, as many a row.
  void judge_values(std::span<const double> values, std::span<Verdict> verdicts);

  const Question& question() const { return question_; }
  std::size_t dimensions() const { return question_.dimensions(); }
  /// Whether each verdict takes many hoops made.
  bool makes_hoops() const { return points_ != nullptr; }
  int threads() const { return threads_; }
  /// Another judge of the same question, for one thread.
  std::unique_ptr<Judge> alone() const;
  /// Designs judged, by those made alone as well.
  std::size_t evaluations() const { return *evaluations_; }

 private:
  Judge(const Judge& other, int threads);  // of the same question

  const Question& question_;
  int threads_;
  std::function<bool()> stop_requested_;
  std::shared_ptr<const SobolPoints> points_;  // none if no goal and no objective is of hoops as made
  std::shared_ptr<std::atomic<std::size_t>> evaluations_ = std::make_shared<std::atomic<std::size_t>>(0);
  std::vector<std::unique_ptr<Bench>> benches_;  // one a thread, made when first needed
  std::unique_ptr<Bench> wide_;                  // for few designs at a time: on all threads
  std::vector<double> values_;                   // of the places in hand
};

}  // namespace leapmap
