// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/made_sample.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "numerics/nan.hpp"

namespace leapmap {
namespace {

/// Between the two values on either side, of values in any order, which it rearranges.
double quantile(std::vector<double>& values, double share) {
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(place);
  const auto at = values.begin() + below;
  std::nth_element(values.begin(), at, values.end());
  if (at + 1 == values.end()) return *at;
  return *at + (place - static_cast<double>(below)) * (*std::min_element(at + 1, values.end()) - *at);
}

/// The share of values below a quantile; 0: it is none.
double quantile_of(Statistic statistic) {
  return statistic == Statistic::q05   ? 0.05
         : statistic == Statistic::q50 ? 0.5
         : statistic == Statistic::q95 ? 0.95
                                       : 0.0;
}

/// To what a share is known at best. Laplace's: where all of n are of one kind, the share of the other is 0
/// to within 1 / (n + 2).
double resolution(double n) { return 1.0 / (n + 2.0); }

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double deviation(std::span<const double> values) {
  if (values.size() < 2) return nan;
  const double middle = mean(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

}  // namespace

double GoalCheck::value(const Design& design, const Outcome& outcome) const {
  const auto* word = std::get_if<Word>(&field->source);
  const double value = word ? static_cast<double>(outcome.*word->member) : stored_number(*field, outcome);
  if (!unit) return value;
  // Units are products of powers: how much larger one is does not depend on what the nominal hoop is.
  return value * unit_of_nominal *
         (unit->size({design.size, 1.0, design.mass}) / unit->size({1.0, 1.0, 1.0}));
}

bool GoalCheck::reached(const Design& design, const Outcome& outcome) const {
  const double now = value(design, outcome);
  return now >= at_least && now <= at_most;
}

GoalCheck goal_check(const Goal& goal) {
  const Field* field = find_field(goal.field);
  return {field, goal.at_least, goal.at_most, goal.unit_of_nominal,
          goal.unit_of_nominal > 0.0 ? find_own_unit(own_unit(*field)) : nullptr};
}

std::vector<GoalCheck> goal_checks(const std::vector<Goal>& goals) {
  std::vector<GoalCheck> checks;
  for (const Goal& goal : goals) checks.push_back(goal_check(goal));
  return checks;
}

std::size_t MadeShare::counted() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

Estimate MadeShare::share() const {
  const auto all = static_cast<double>(samples_), each = all / SobolPoints::replicates;
  const double whole = static_cast<double>(counted()) / all;
  std::array<double, SobolPoints::replicates> parts;
  std::transform(counts_.begin(), counts_.end(), parts.begin(),
                 [&](std::size_t n) { return static_cast<double>(n) / each; });
  std::array<std::size_t, SobolPoints::replicates> alike;
  alike.fill(1);
  return {whole, std::hypot(error_of(whole, parts, alike), resolution(all))};
}

void MadeSample::clear() {
  values_.clear();
  counts_.fill(0);
}

void MadeSample::add(double value, std::size_t replicate) {
  assert(std::all_of(counts_.begin() + static_cast<std::ptrdiff_t>(replicate) + 1, counts_.end(),
                     [](std::size_t count) { return count == 0; }));
  values_.push_back(value);
  ++counts_[replicate];
}

double MadeSample::tell(Statistic statistic) {
  if (values_.empty()) return nan;
  if (statistic == Statistic::mean) return mean(values_);
  if (statistic == Statistic::sd) return deviation(values_);
  scratch_.assign(values_.begin(), values_.end());
  return quantile(scratch_, quantile_of(statistic));
}

/// How far quantiles lie away whose share differs by the error with which that share is known (Woodruff): of
/// two sides the larger, as beside a gap, where hoops pass a cliff, one side is far.
double MadeSample::error_of_quantile(double share) {
  scratch_.assign(values_.begin(), values_.end());
  const double whole = quantile(scratch_, share);
  std::array<double, SobolPoints::replicates> parts{};
  std::size_t first = 0;
  for (std::size_t r = 0; r < parts.size(); ++r) {
    const auto some = std::span(values_).subspan(first, counts_[r]);
    const auto below =
        static_cast<double>(std::count_if(some.begin(), some.end(), [&](double v) { return v <= whole; }));
    parts[r] = counts_[r] > 0 ? below / static_cast<double>(counts_[r]) : 0.0;
    first += counts_[r];
  }
  const double known =
      std::hypot(error_of(share, parts, counts_), resolution(static_cast<double>(values_.size())));
  const double low = quantile(scratch_, std::max(share - known, 0.0)),
               high = quantile(scratch_, std::min(share + known, 1.0));
  return std::max(whole - low, high - whole);
}

double MadeSample::error_of_moments(Statistic statistic) {
  struct Moments {
    double count = 0.0, sum = 0.0, squares = 0.0;
  };
  std::array<Moments, SobolPoints::replicates> parts;
  Moments whole;
  double fourths = 0.0;
  const double middle = mean(values_);  // about which sums lose no digits
  std::size_t first = 0;
  for (std::size_t r = 0; r < parts.size(); ++r) {
    for (const double value : std::span(values_).subspan(first, counts_[r])) {
      const double square = (value - middle) * (value - middle);
      parts[r].sum += value - middle, parts[r].squares += square, fourths += square * square;
    }
    parts[r].count = static_cast<double>(counts_[r]);
    whole.count += parts[r].count, whole.sum += parts[r].sum, whole.squares += parts[r].squares;
    first += counts_[r];
  }
  std::array<double, SobolPoints::replicates> without;
  std::transform(parts.begin(), parts.end(), without.begin(), [&](const Moments& part) {
    const double count = whole.count - part.count, average = (whole.sum - part.sum) / count;
    return statistic == Statistic::mean
               ? average
               : std::sqrt(((whole.squares - part.squares) - count * average * average) / (count - 1.0));
  });
  const bool known = statistic == Statistic::mean || fourths == 0.0 ||
                     carries_replicates(whole.squares * whole.squares / fourths, whole.count);
  return known ? jackknife_error(without) : nan;
}

double MadeSample::error(Statistic statistic) {
  const auto told =
      std::count_if(counts_.begin(), counts_.end(), [](std::size_t count) { return count > 0; });
  if (2 * static_cast<std::size_t>(told) < counts_.size()) return nan;
  const double share = quantile_of(statistic);
  return share > 0.0 ? error_of_quantile(share) : error_of_moments(statistic);
}

MadeTally::MadeTally(const std::vector<Goal>& goals, const std::vector<const Field*>& quantities,
                     std::size_t samples)
    : goals_(goal_checks(goals)),
      reached_(samples),
      jumped_(samples),
      failed_(samples),
      missed_(goals.size(), MadeShare(samples)),
      samples_(quantities.size()) {
  for (const Field* field : quantities) quantities_.push_back(std::get<Quantity>(field->source).member);
}

void MadeTally::clear() {
  for (MadeShare* share : {&reached_, &jumped_, &failed_}) share->clear();
  for (MadeShare& share : missed_) share.clear();
  for (MadeSample& sample : samples_) sample.clear();
}

bool MadeTally::reaches_all(const Design& design, const Outcome& outcome) const {
  return std::all_of(goals_.begin(), goals_.end(),
                     [&](const GoalCheck& goal) { return goal.reached(design, outcome); });
}

void MadeTally::add(const Design& design, const Outcome& outcome, std::size_t replicate) {
  bool all = true;
  for (std::size_t k = 0; k < goals_.size(); ++k) {
    const bool reached = goals_[k].reached(design, outcome);
    all = all && reached;
    if (!reached) missed_[k].count(replicate);
  }
  if (all) reached_.count(replicate);
  if (outcome.status == Status::failed) failed_.count(replicate);
  if (outcome.status != Status::jumped) return;
  jumped_.count(replicate);
  for (std::size_t i = 0; i < quantities_.size(); ++i)
    if (const double value = outcome.*quantities_[i]; value == value) samples_[i].add(value, replicate);
}

Estimate MadeTally::known(const Estimate& share) const {
  return {share.value, failed_.counted() > 0 ? std::hypot(share.error, failed()) : share.error};
}

MadeSample& MadeTally::of(double Outcome::*quantity) {
  const auto found = std::find(quantities_.begin(), quantities_.end(), quantity);
  assert(found != quantities_.end());
  return samples_[static_cast<std::size_t>(found - quantities_.begin())];
}

double MadeTally::tell(Statistic statistic, double Outcome::*quantity) {
  return of(quantity).tell(statistic);
}

double MadeTally::error(Statistic statistic, double Outcome::*quantity) {
  return failed_.counted() > 0 ? nan : of(quantity).error(statistic);
}

}  // namespace leapmap
