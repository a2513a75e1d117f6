// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <optional>
#include <utility>

#include "engine/parallel.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/scatter.hpp"
#include "numerics/nan.hpp"
#include "numerics/sobol_indices.hpp"
#include "request/solver.hpp"
#include "spec/spec.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap {
namespace {

constexpr double wanted_yield = 0.99;

/// Makes hoops after one design and solves them, on all threads.
class Workshop {
 public:
  Workshop(const Spec& spec, const ScatterOptions& options)
      : spec_(spec),
        options_(options),
        points_(points_of(spec.scatter, 2)),
        asked_(request_of_sample(request_of(spec))) {}

  /// The hoop as drawn.
  Outcome drawn() const {
    Outcome outcome;
    make_solver(asked_)({&spec_.design, 1}, {&outcome, 1});
    return outcome;
  }

  std::size_t samples() const { return points_->samples(); }
  std::size_t replicate(std::size_t hoop) const { return hoop / points_->a_replicate(); }

  /// take(first, designs, outcomes) of each block of hoops, from any thread.
  template <class Take>
  void make(const Scatter& scatter, std::span<const std::size_t> dimensions, const Take& take) const {
    parallel_for_each(
        (samples() + made_at_once - 1) / made_at_once, options_.threads, options_.stop_requested, [&] {
          MadeHoops hoops(scatter, spec_.hoop, held_in_si(spec_), points_);
          hoops.draw(spec_.design, nullptr, dimensions);
          return [&, hoops = std::move(hoops), solve = make_solver(asked_),
                  made = std::vector<Design>(made_at_once),
                  outcomes = std::vector<Outcome>(made_at_once)](std::size_t block) mutable {
            if (options_.stop_requested && options_.stop_requested()) throw Stopped("scatter was stopped");
            const std::size_t first = block * made_at_once, count = std::min(made_at_once, samples() - first);
            hoops.fill(first, std::span(made).first(count));
            solve(std::span(made).first(count), std::span(outcomes).first(count));
            take(first, std::span<const Design>(made).first(count),
                 std::span<const Outcome>(outcomes).first(count));
            return true;
          };
        });
  }

 private:
  const Spec& spec_;
  const ScatterOptions& options_;
  std::shared_ptr<const SobolPoints> points_;
  Request asked_;
};

/// What importance is told of, by what it is of a hoop; NaN: it is not known, or does not apply.
struct HoopValue {
  std::string of;
  std::function<double(const Design&, const Outcome&)> value;
};

/// The yield where spread k, or all, have a share of their width.
double yield_at(const Workshop& workshop, const MadeTally& goals, const Scatter& scatter,
                std::optional<std::size_t> k, double share) {
  Scatter smaller = scatter;
  for (std::size_t i = 0; i < smaller.spreads.size(); ++i)
    if (!k || i == *k) smaller.spreads[i].width *= share;
  std::atomic<std::size_t> reached{0};
  workshop.make(smaller, {}, [&](std::size_t, std::span<const Design> made, std::span<const Outcome> some) {
    std::size_t here = 0;
    for (std::size_t i = 0; i < some.size(); ++i) here += goals.reaches_all(made[i], some[i]);
    reached += here;
  });
  return static_cast<double>(reached) / static_cast<double>(workshop.samples());
}

/// The share of its width, to a thousandth of that, at which the yield is good while a bit above it is not:
/// of spread k, or of all. without: the yield at none of it.
double shrink(const Workshop& workshop, const MadeTally& goals, const Scatter& scatter,
              std::optional<std::size_t> k, double without) {
  constexpr double least = 1e-6;
  if (without < wanted_yield) return 0.0;
  double low = 0.0, high = 1.0;
  while (high - low > 1e-3 * high && high > least) {
    const double middle = 0.5 * (low + high);
    (yield_at(workshop, goals, scatter, k, middle) >= wanted_yield ? low : high) = middle;
  }
  return std::max(low, least);
}

Importance importance(std::string of, std::span<const std::vector<double>> outputs) {
  Importance told{.of = std::move(of), .first = {}, .total = {}};
  for (const SobolIndex& index : sobol_indices(outputs)) {
    told.first.push_back(index.first), told.total.push_back(index.total);
    told.pairs = std::min(told.pairs, index.pairs);
  }
  return told;
}

/// A number of each hoop that importance is told of: whether it reaches the goals, whether it jumps, and of
/// those that jump every quantity. The tally must outlive them.
std::vector<HoopValue> hoop_values(const Spec& spec, const std::vector<const Field*>& quantities,
                                   const MadeTally& tally) {
  const auto of_solved = [](const auto& holds) {
    return [holds](const Design& d, const Outcome& o) {
      return o.status == Status::failed ? nan : holds(d, o) ? 1.0 : 0.0;
    };
  };
  const auto jumps = [](const Design&, const Outcome& o) { return o.status == Status::jumped; };
  std::vector<HoopValue> values;
  if (!spec.goals.empty())
    values.push_back({"yield", of_solved([&tally](const Design& d, const Outcome& o) {
                        return tally.reaches_all(d, o);
                      })});
  values.push_back({"jumps", of_solved(jumps)});
  for (const Field* field : quantities)
    values.push_back({std::string(field->name),
                      [jumps, of = std::get<Quantity>(field->source).member](
                          const Design& d, const Outcome& o) { return jumps(d, o) ? o.*of : nan; }});
  return values;
}

/// Solves every sample of the pick-and-freeze plan; keeps the hoops and outcomes of the first one in the
/// report, and tells the importance of the tolerances.
void sample(const Workshop& workshop, const Spec& spec, const std::vector<HoopValue>& of,
            ScatterReport& report) {
  const auto plan = pick_and_freeze(spec.scatter.spreads.size());
  std::vector values(of.size(), std::vector(plan.size(), std::vector<double>(workshop.samples())));
  report.made.resize(workshop.samples()), report.outcomes.resize(workshop.samples());
  for (std::size_t s = 0; s < plan.size(); ++s)
    workshop.make(spec.scatter, plan[s],
                  [&](std::size_t first, std::span<const Design> made, std::span<const Outcome> outcomes) {
                    const auto place = static_cast<std::ptrdiff_t>(first);
                    for (std::size_t k = 0; k < of.size(); ++k)
                      std::ranges::transform(made, outcomes, values[k][s].begin() + place, of[k].value);
                    if (s != 0) return;
                    std::ranges::copy(made, report.made.begin() + place);
                    std::ranges::copy(outcomes, report.outcomes.begin() + place);
                  });
  for (std::size_t k = 0; k < of.size(); ++k) report.importance.push_back(importance(of[k].of, values[k]));
}

}  // namespace

ScatterReport scatter(const Spec& spec, const ScatterOptions& asked) {
  check_spec(spec);
  if (!spec.axes.empty() || !spec.points.empty() || !spec.list.columns.empty())
    throw InputError(fmt::format("{}: has several designs; allowed: one design", origin_of(spec)));
  if (spec.scatter.spreads.empty())
    throw InputError(
        fmt::format("{}: has no tolerances; allowed: a spec with [scatter], or --set "
                    "'scatter.slope={{normal=\"1 deg\"}}'",
                    origin_of(spec)));
  ScatterOptions options = asked;
  options.stop_requested = latched(asked.stop_requested);
  const std::vector<const Field*> quantities = quantities_of(statistics_of(request_of(spec)));
  const Workshop workshop(spec, options);
  MadeTally tally(spec.goals, quantities, workshop.samples());
  ScatterReport report;
  report.samples = workshop.samples();

  sample(workshop, spec, hoop_values(spec, quantities, tally), report);
  for (std::size_t i = 0; i < report.outcomes.size(); ++i)
    tally.add(report.made[i], report.outcomes[i], workshop.replicate(i));
  report.jumps = tally.jumps();
  report.unsolved = tally.failed();
  for (std::size_t k = 0; k < spec.goals.size(); ++k) report.missed.push_back(tally.missed(k));
  for (const Field* field : quantities) {
    const auto of = std::get<Quantity>(field->source).member;
    const auto tell = [&](Statistic statistic) {
      return Estimate{tally.tell(statistic, of), tally.error(statistic, of)};
    };
    report.quantities.push_back({std::string(field->name), tell(Statistic::mean), tell(Statistic::sd),
                                 tell(Statistic::q05), tell(Statistic::q50), tell(Statistic::q95)});
  }
  const MadeHoops hoops(spec.scatter, spec.hoop, held_in_si(spec),
                        points_of({spec.scatter.spreads, SobolPoints::replicates, 0}));
  for (std::size_t k = 0; k < hoops.spreads(); ++k)
    report.cut_off.push_back(1.0 - hoops.law(k, spec.design).left);
  if (spec.goals.empty()) return report;

  report.yield = tally.yield();
  const bool good = report.yield.value >= wanted_yield;
  const auto shrunk = [&](std::optional<std::size_t> k, double without) {
    return good ? 1.0 : shrink(workshop, tally, spec.scatter, k, without);
  };
  for (std::size_t k = 0; k < spec.scatter.spreads.size(); ++k) {
    report.without.push_back(yield_at(workshop, tally, spec.scatter, k, 0.0));
    report.shrink.push_back(shrunk(k, report.without.back()));
  }
  report.shrink_all = shrunk(std::nullopt, tally.reaches_all(spec.design, workshop.drawn()) ? 1.0 : 0.0);
  return report;
}

}  // namespace leapmap
