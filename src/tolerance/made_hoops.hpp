// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops as they are made after a drawing: each scattered number differs from what is drawn by its law,
/// cut off where the number may not be.
///
/// The same random numbers serve every drawing, so that what is told of hoops as made is smooth over a map.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "leapmap/spec.hpp"
#include "model/variable.hpp"
#include "numerics/sobol_points.hpp"

namespace leapmap {

/// A law cut off at both ends of what is allowed, in widths from the value drawn.
struct CutLaw {
  double from, to;
  double left;  ///< the share of the law between them
};

/// How much of a law has to be left at least: what is drawn at the end of a range, as L/R = 1, loses half.
inline constexpr double least_left = 0.499;

/// The value nearest to this one that a parameter may have: hoops are made within its range.
double inside(const Range& range, double value);

/// One a thread. Needs points of at least as many dimensions as the scatter has spreads.
class MadeHoops {
 public:
  /// hoop: the nominal body, if the spec has [hoop]. held: parameters whose values and
  /// widths are in its units.
  MadeHoops(const Scatter& scatter, const std::optional<Body>& hoop, std::vector<SameInSi> held,
            std::shared_ptr<const SobolPoints> points);

  std::size_t samples() const { return points_->samples(); }
  std::size_t a_replicate() const { return points_->a_replicate(); }
  std::size_t spreads() const { return spreads_.size(); }
  /// Whether they differ in size or mass.
  bool makes_bodies() const { return makes_bodies_; }

  /// What is made after this drawing from now on. Each spread takes a dimension of the points of its own, by
  /// the order of parameters, whatever that of the spreads; from_dimension[k]: k, or k plus the number of
  /// spreads for another sample of spread k. By default k. body: from which the drawing follows; by default
  /// the nominal one. Returns the share cut off.
  double draw(const Design& drawn, const Body* body = nullptr,
              std::span<const std::size_t> from_dimension = {});
  /// Hoops first, first + 1, ...
  void fill(std::size_t first, std::span<Design> made) const;

  /// Hoops at the ends of the laws: every corner of the first few, the others' ends in turn.
  void corners(std::vector<Design>& made) const;

  /// The law of spread k around this drawing.
  CutLaw law(std::size_t k, const Design& drawn, const Body* body = nullptr) const;
  /// The width of the spread of a parameter around this drawing; 0: it has none. is_it(member): whether it is
  /// that one.
  template <class F>
  double width_of(const Design& drawn, const F& is_it) const {
    for (const Made& spread : spreads_)
      if (double Design::*const member = spread.variable.parameter(); member && is_it(member))
        return width_of(spread, drawn, nominal_);
    return 0.0;
  }
  /// Whether of each law as much is left as has to be.
  bool can_make(const Design& drawn, const Body* body = nullptr) const;

 private:
  struct Made {
    Variable variable;
    Spread::Law law;
    double width;
    bool percent;
    std::size_t dimension;
  };
  /// Deviations along one dimension of the points, in widths, as the last drawing had them.
  struct Column {
    CutLaw law{};
    std::vector<double> deviations;
  };
  /// deviation(k, i): of spread k from the drawing, in widths, of hoop i.
  template <class Deviation>
  void make(std::span<Design> made, const Deviation& deviation) const;
  double value_drawn(const Made& spread, const Design& drawn, const Body& body) const;
  double width_of(const Made& spread, const Design& drawn, const Body& body) const;
  /// What the made body comes to: its ratios, and what the turn of its centre of mass and its mass change.
  void take_body(const Body& made, const ReducedBody& nominal, Design& design) const;
  const std::vector<double>& deviations(std::size_t spread, std::size_t dimension, const CutLaw& law);

  std::shared_ptr<const SobolPoints> points_;
  std::vector<Made> spreads_;
  std::vector<std::vector<Column>> columns_;  // of each spread along each dimension
  Body nominal_;
  std::vector<SameInSi> held_;
  bool makes_bodies_ = false;
  Design drawn_;
  Body body_;  // of what is drawn
  std::vector<const std::vector<double>*> now_;
};

}  // namespace leapmap
