// SPDX-License-Identifier: GPL-3.0-or-later
#include "tolerance/made_hoops.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "hoop/body.hpp"
#include "numerics/normal_law.hpp"

namespace leapmap {
double inside(const Range& range, double value) {
  if (value <= range.least) return range.least_allowed ? range.least : std::nextafter(range.least, HUGE_VAL);
  if (value >= range.most) return range.most_allowed ? range.most : std::nextafter(range.most, -HUGE_VAL);
  return value;
}

MadeHoops::MadeHoops(const Scatter& scatter, const std::optional<Body>& hoop, std::vector<SameInSi> held,
                     std::shared_ptr<const SobolPoints> points)
    : points_(std::move(points)), nominal_(hoop.value_or(Body{})), held_(std::move(held)) {
  assert(points_->dimensions() >= scatter.spreads.size());
  for (const Spread& spread : scatter.spreads) {
    spreads_.push_back(
        {*find_variable(spread.parameter, &nominal_), spread.law, spread.width, spread.percent, 0});
    makes_bodies_ = makes_bodies_ || spreads_.back().variable.of_body();
  }
  for (Made& spread : spreads_)
    spread.dimension =
        static_cast<std::size_t>(std::count_if(spreads_.begin(), spreads_.end(), [&](const Made& other) {
          return other.variable.order < spread.variable.order;
        }));
  columns_.assign(spreads_.size(), std::vector<Column>(points_->dimensions()));
  now_.resize(spreads_.size());
}

/// NaN: it follows mu_static, from where that is drawn.
double MadeHoops::value_drawn(const Made& spread, const Design& drawn, const Body& body) const {
  const double value = spread.variable.of(drawn, body);
  return std::isnan(value) ? drawn.mu_static : value;
}

double MadeHoops::width_of(const Made& spread, const Design& drawn, const Body& body) const {
  if (spread.percent) return 0.01 * spread.width * std::abs(value_drawn(spread, drawn, body));
  return spread.width * held_unit(held_, spread.variable.parameter(), drawn);
}

CutLaw MadeHoops::law(std::size_t k, const Design& drawn, const Body* given) const {
  const Made& spread = spreads_[k];
  const Body& body = given ? *given : nominal_;
  const double value = value_drawn(spread, drawn, body), width = width_of(spread, drawn, body);
  const Range& range = spread.variable.range;
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

bool MadeHoops::can_make(const Design& drawn, const Body* body) const {
  for (std::size_t k = 0; k < spreads_.size(); ++k)
    if (!(law(k, drawn, body).left >= least_left)) return false;
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

double MadeHoops::draw(const Design& drawn, const Body* body, std::span<const std::size_t> from_dimension) {
  drawn_ = drawn;
  if (makes_bodies_) body_ = body ? *body : nominal_;
  double left = 1.0;
  for (std::size_t k = 0; k < spreads_.size(); ++k) {
    const CutLaw cut = law(k, drawn, body);
    left *= cut.left;
    const std::size_t sample = from_dimension.empty() ? 0 : from_dimension[k] / spreads_.size();
    now_[k] = &deviations(k, sample * spreads_.size() + spreads_[k].dimension, cut);
  }
  return 1.0 - left;
}

void MadeHoops::take_body(const Body& made, const ReducedBody& nominal, Design& design) const {
  const ReducedBody reduced = reduce_checked(made);
  apply_ratios(reduced, design);
  // The release is that of the drawing: it counts from where the centre of mass should be. The torques are
  // too. Weights that balance have no direction but that of a rounding.
  constexpr double balanced = 1e-12;
  if (nominal.eccentricity > balanced && reduced.eccentricity > balanced)
    design.release_angle += std::remainder(reduced.direction - nominal.direction, 2.0 * std::numbers::pi);
  const double larger = made.diameter / body_.diameter;
  const double heavier = reduced.total_mass / nominal.total_mass;
  design.size *= larger, design.mass *= heavier;
  hold_in_si(same_in_si, heavier, larger, design);
}

template <class Deviation>
void MadeHoops::make(std::span<Design> made, const Deviation& deviation) const {
  std::fill(made.begin(), made.end(), drawn_);
  for (std::size_t k = 0; k < spreads_.size(); ++k) {
    const Made& spread = spreads_[k];
    double Design::*const member = spread.variable.parameter();
    if (!member) continue;
    const double value = value_drawn(spread, drawn_, body_), width = width_of(spread, drawn_, body_);
    for (std::size_t i = 0; i < made.size(); ++i)
      made[i].*member = inside(spread.variable.range, value + width * deviation(k, i));
  }
  if (!makes_bodies_) return;
  const ReducedBody nominal = reduce_checked(body_);
  Body body = body_;
  for (std::size_t i = 0; i < made.size(); ++i) {
    for (std::size_t k = 0; k < spreads_.size(); ++k) {
      const Made& spread = spreads_[k];
      if (!spread.variable.of_body()) continue;
      const double value = value_drawn(spread, drawn_, body_), width = width_of(spread, drawn_, body_);
      spread.variable.in(made[i], body) = inside(spread.variable.range, value + width * deviation(k, i));
    }
    take_body(body, nominal, made[i]);
  }
}

void MadeHoops::fill(std::size_t first, std::span<Design> made) const {
  make(made, [&](std::size_t k, std::size_t i) { return (*now_[k])[first + i]; });
}

void MadeHoops::corners(std::vector<Design>& made) const {
  constexpr std::size_t most = 6;
  made.resize(std::size_t{1} << std::min(spreads_.size(), most));
  std::vector<CutLaw> laws;
  for (std::size_t k = 0; k < spreads_.size(); ++k)
    laws.push_back(law(k, drawn_, makes_bodies_ ? &body_ : nullptr));
  make(made, [&](std::size_t k, std::size_t i) { return i >> (k % most) & 1u ? laws[k].to : laws[k].from; });
}

}  // namespace leapmap
