// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "leapmap/errors.hpp"
#include "leapmap/scatter.hpp"
#include "numerics/sobol_indices.hpp"
#include "sweep/parallel.hpp"
#include "sweep/scatter.hpp"
#include "sweep/solver.hpp"
#include "sweep/spec.hpp"

namespace leapmap {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double wanted_yield = 0.99;
constexpr std::array<double Outcome::*, 2> told{&Outcome::jump_height, &Outcome::jump_time};
constexpr std::array<const char*, 2> told_names{"jump_height", "jump_time"};

/// Hoops made after one design, solved on all threads.
class Workshop {
 public:
  Workshop(const Spec& spec, const ScatterOptions& options)
      : spec_(spec),
        options_(options),
        points_(points_of(spec.scatter, 2)),
        solved_(spec_of_made(spec, told)),
        goals_(goal_checks(spec.goals)) {}

  /// designs: where the hoops are kept, unless nullptr.
  std::vector<Outcome> make(const Scatter& scatter, std::span<const std::size_t> dimensions,
                            std::vector<Design>* designs = nullptr) const {
    constexpr std::size_t at_once = 1024;
    const std::size_t samples = points_->samples();
    std::vector<Outcome> outcomes(samples);
    if (designs) designs->resize(samples);
    parallel_for_each((samples + at_once - 1) / at_once, options_.threads, [&] {
      MadeHoops hoops(scatter, points_);
      hoops.draw(spec_.design, dimensions);
      return [&, hoops = std::move(hoops), solve = make_solver(solved_),
              made = std::vector<Design>(at_once)](std::size_t block) mutable {
        if (options_.stop_requested && options_.stop_requested()) throw Stopped("scatter was asked to stop");
        const std::size_t first = block * at_once;
        const std::span some = std::span(made).first(std::min(at_once, samples - first));
        hoops.fill(first, some);
        solve(some, std::span(outcomes).subspan(first, some.size()));
        if (designs) std::ranges::copy(some, designs->begin() + static_cast<std::ptrdiff_t>(first));
        return true;
      };
    });
    return outcomes;
  }

  bool reached(const Outcome& outcome) const {
    return std::ranges::all_of(goals_, [&](const GoalCheck& goal) { return goal.reached(outcome); });
  }

  /// The share of outcomes of which something is true.
  template <class Is>
  Estimate share(const std::vector<Outcome>& outcomes, const Is& is) const {
    MadeShare share(outcomes.size());
    for (std::size_t i = 0; i < outcomes.size(); ++i)
      if (is(outcomes[i])) share.count(i / points_->a_replicate());
    return share.share();
  }

  double yield(const Scatter& scatter) const {
    return share(make(scatter, {}), [&](const Outcome& outcome) { return reached(outcome); }).value;
  }

  const std::vector<GoalCheck>& goals() const { return goals_; }
  std::size_t a_replicate() const { return points_->a_replicate(); }

 private:
  const Spec& spec_;
  const ScatterOptions& options_;
  std::shared_ptr<const SobolPoints> points_;
  Spec solved_;
  std::vector<GoalCheck> goals_;
};

MadeQuantity quantity(const std::vector<Outcome>& outcomes, std::size_t a_replicate, std::size_t which) {
  MadeSample sample;
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (const double value = outcomes[i].*told[which]; outcomes[i].status == Status::jumped && value == value)
      sample.add(value, i / a_replicate);
  const auto tell = [&](Statistic statistic) { return sample.tell_with_error(statistic); };
  return {told_names[which],    tell(Statistic::mean), tell(Statistic::sd),
          tell(Statistic::q05), tell(Statistic::q50),  tell(Statistic::q95)};
}

/// outputs: of each sample of pick_and_freeze, what value(outcome) is.
template <class Value>
Importance importance(std::string of, const std::vector<std::vector<Outcome>>& samples, const Value& value) {
  std::vector<std::vector<double>> outputs;
  for (const std::vector<Outcome>& outcomes : samples) {
    outputs.emplace_back(outcomes.size());
    std::ranges::transform(outcomes, outputs.back().begin(), value);
  }
  Importance told_of{.of = std::move(of), .first = {}, .total = {}};
  for (const SobolIndex& index : sobol_indices(outputs)) {
    told_of.first.push_back(index.first), told_of.total.push_back(index.total);
    told_of.pairs = std::min(told_of.pairs, index.pairs);
  }
  return told_of;
}

/// The largest share of its width, to a thousandth, at which the yield is good: of spread k, or of all.
double shrink(const Workshop& workshop, const Scatter& scatter, std::optional<std::size_t> k) {
  const auto good = [&](double width) {
    Scatter smaller = scatter;
    for (std::size_t i = 0; i < smaller.spreads.size(); ++i)
      if (!k || i == *k) smaller.spreads[i].width *= width;
    return workshop.yield(smaller) >= wanted_yield;
  };
  if (good(1.0)) return 1.0;
  if (!good(0.0)) return 0.0;
  double low = 0.0, high = 1.0;
  while (high - low > 1e-3) (good(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low;
}

}  // namespace

ScatterReport scatter(const Spec& spec, const ScatterOptions& asked) {
  check_spec(spec);
  if (!spec.axes.empty() || !spec.points.empty() || !spec.list.columns.empty())
    throw InputError(
        fmt::format("{}: is of many designs; allowed: one design, whose hoops are made", origin_of(spec)));
  if (spec.scatter.spreads.empty())
    throw InputError(fmt::format(
        "{}: nothing scatters; allowed: a parameter in [scatter], slope = {{ normal = \"1 deg\" }} say",
        origin_of(spec)));
  ScatterOptions options = asked;
  options.stop_requested = latched(asked.stop_requested);
  const Workshop workshop(spec, options);
  const auto jumps = [](const Outcome& outcome) { return outcome.status == Status::jumped; };
  const auto reached = [&](const Outcome& outcome) { return workshop.reached(outcome); };

  ScatterReport report;
  std::vector<std::vector<Outcome>> samples;
  for (const std::vector<std::size_t>& dimensions : pick_and_freeze(spec.scatter.spreads.size()))
    samples.push_back(workshop.make(spec.scatter, dimensions, samples.empty() ? &report.made : nullptr));
  const std::vector<Outcome>& outcomes = samples[0];
  report.samples = outcomes.size();
  report.jumps = workshop.share(outcomes, jumps);
  for (const GoalCheck& goal : workshop.goals())
    report.missed.push_back(workshop.share(outcomes, [&](const Outcome& o) { return !goal.reached(o); }));
  for (std::size_t i = 0; i < told.size(); ++i)
    report.quantities.push_back(quantity(outcomes, workshop.a_replicate(), i));
  const MadeHoops hoops(spec.scatter, points_of({spec.scatter.spreads, SobolPoints::replicates, 0}));
  for (std::size_t k = 0; k < hoops.spreads(); ++k)
    report.cut_off.push_back(1.0 - hoops.law(k, spec.design).left);

  if (!spec.goals.empty()) {
    report.yield = workshop.share(outcomes, reached);
    report.importance.push_back(
        importance("yield", samples, [&](const Outcome& o) { return reached(o) ? 1.0 : 0.0; }));
  }
  report.importance.push_back(
      importance("jumps", samples, [&](const Outcome& o) { return jumps(o) ? 1.0 : 0.0; }));
  for (std::size_t i = 0; i < told.size(); ++i)
    report.importance.push_back(
        importance(told_names[i], samples, [&](const Outcome& o) { return jumps(o) ? o.*told[i] : nan; }));
  if (!spec.goals.empty()) {
    for (std::size_t k = 0; k < spec.scatter.spreads.size(); ++k)
      report.shrink.push_back(shrink(workshop, spec.scatter, k));
    report.shrink_all = shrink(workshop, spec.scatter, std::nullopt);
  }
  report.outcomes = std::move(samples[0]);
  return report;
}

}  // namespace leapmap
