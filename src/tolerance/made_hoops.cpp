// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/made_hoops.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "numerics/normal_law.hpp"

namespace leapmap {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The value nearest to this one that a parameter may have.
double inside(const Range& range, double value) {
  if (value <= range.least) return range.least_allowed ? range.least : std::nextafter(range.least, infinity);
  if (value >= range.most) return range.most_allowed ? range.most : std::nextafter(range.most, -infinity);
  return value;
}

}  // namespace

MadeHoops::MadeHoops(const Scatter& scatter, std::shared_ptr<const SobolPoints> points)
    : points_(std::move(points)) {
  assert(points_->dimensions() >= scatter.spreads.size());
  for (const Spread& spread : scatter.spreads) {
    const auto all = parameters();
    const auto parameter = std::find_if(all.begin(), all.end(),
                                        [&](const Parameter& each) { return each.name == spread.parameter; });
    spreads_.push_back({&*parameter, std::get<double Design::*>(parameter->member), spread.law, spread.width,
                        spread.percent, 0});
  }
  for (Made& spread : spreads_)
    spread.dimension =
        static_cast<std::size_t>(std::count_if(spreads_.begin(), spreads_.end(), [&](const Made& other) {
          return other.parameter < spread.parameter;
        }));
  columns_.assign(spreads_.size(), std::vector<Column>(points_->dimensions()));
  now_.resize(spreads_.size());
}

/// NaN: it follows mu_static, from where that is drawn.
double MadeHoops::value_drawn(const Made& spread, const Design& drawn) const {
  const double value = drawn.*spread.member;
  return std::isnan(value) ? drawn.mu_static : value;
}

double MadeHoops::width_of(const Made& spread, const Design& drawn) const {
  return spread.percent ? 0.01 * spread.width * std::abs(value_drawn(spread, drawn)) : spread.width;
}

CutLaw MadeHoops::law(std::size_t k, const Design& drawn) const {
  const Made& spread = spreads_[k];
  const double value = value_drawn(spread, drawn), width = width_of(spread, drawn);
  const Range& range = spread.parameter->range;
  // Beyond eight deviations there is less of a normal law than a double tells from nothing.
  const double end = spread.law == Spread::Law::normal ? 8.5 : 1.0;
  CutLaw cut{-end, end, 1.0};
  if (width == 0.0) return cut;
  cut.from = std::clamp((range.least - value) / width, -end, end);
  cut.to = std::clamp((range.most - value) / width, -end, end);
  cut.left = spread.law == Spread::Law::normal ? normal_share(cut.to) - normal_share(cut.from)
                                               : 0.5 * (cut.to - cut.from);
  return cut;
}

bool MadeHoops::can_make(const Design& drawn) const {
  for (std::size_t k = 0; k < spreads_.size(); ++k)
    if (!(law(k, drawn).left >= least_left)) return false;
  return true;
}

const std::vector<double>& MadeHoops::deviations(std::size_t k, std::size_t dimension, const CutLaw& law) {
  Column& column = columns_[k][dimension];
  if (!column.deviations.empty() && column.law.from == law.from && column.law.to == law.to)
    return column.deviations;
  column.law = law;
  column.deviations.resize(samples());
  const bool normal = spreads_[k].law == Spread::Law::normal;
  const double before = normal ? normal_share(law.from) : 0.0;
  const auto along = points_->column(dimension);
  std::transform(along.begin(), along.end(), column.deviations.begin(), [&](double u) {
    return normal ? normal_quantile(before + u * law.left) : law.from + u * (law.to - law.from);
  });
  return column.deviations;
}

double MadeHoops::draw(const Design& drawn, std::span<const std::size_t> from_dimension) {
  drawn_ = drawn;
  double left = 1.0;
  for (std::size_t k = 0; k < spreads_.size(); ++k) {
    const CutLaw cut = law(k, drawn);
    left *= cut.left;
    const std::size_t sample = from_dimension.empty() ? 0 : from_dimension[k] / spreads_.size();
    now_[k] = &deviations(k, sample * spreads_.size() + spreads_[k].dimension, cut);
  }
  return 1.0 - left;
}

void MadeHoops::fill(std::size_t first, std::span<Design> made) const {
  std::fill(made.begin(), made.end(), drawn_);
  for (std::size_t k = 0; k < spreads_.size(); ++k) {
    const Made& spread = spreads_[k];
    const double value = value_drawn(spread, drawn_), width = width_of(spread, drawn_);
    const double* deviation = now_[k]->data() + first;
    for (std::size_t i = 0; i < made.size(); ++i)
      made[i].*spread.member = inside(spread.parameter->range, value + width * deviation[i]);
  }
}

}  // namespace leapmap
