// SPDX-License-Identifier: GPL-3.0-or-later
/// Measurements and a model that is to explain them: free parameters, residuals and their derivatives.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "design/least_squares.hpp"
#include "design/question.hpp"
#include "leapmap/fit.hpp"
#include "support/pool.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {

class Explained {
 public:
  /// Keeps a reference to the measurements. Throws InputError if the spec does not fit the model, or nothing
  /// is free.
  Explained(const Measurements& measured, const Spec& spec, Friction friction);

  bool is_film() const { return measured_.events.empty(); }
  const Scene& scene() const { return spec_.scene; }
  const std::vector<FreeParameter>& free() const { return free_; }
  /// Parameters: the free ones, and of markers the origin x, y [m] besides. Residuals are over the errors.
  const LeastSquares& problem() const { return problem_; }
  Design design_at(std::span<const double> at) const;

  /// The sums of squares at places of the free parameters alone, over as few of a film's lines as tell much.
  void coarse_sums(std::span<const std::vector<double>> places, std::span<double> sums) const;
  /// A place with the origin that suits it best added.
  std::vector<double> with_origin(std::span<const double> at) const;

  /// Whether the measurements say how good they are; if not, residuals are over unit_error().
  bool errors_known() const;
  double unit_error() const;
  /// What the model has in place of every number measured.
  std::vector<double> model_at(std::span<const double> residuals) const;

 private:
  /// Residuals of these lines of a film; the origin is 0 where it is not among the parameters given.
  template <class S>
  bool film_residuals(std::span<const double> at, std::span<const std::size_t> lines,
                      std::span<double> residuals, std::span<double> jacobian) const;
  bool event_residuals(std::span<const double> at, std::span<double> residuals,
                       std::span<double> jacobian) const;
  /// A solver of the events' fields, with derivatives by the free parameters or without. f(EventSolver&).
  struct EventSolver {
    GradientSolver solve;
    Gradients gradients;
  };
  template <class F>
  auto with_event_solver(bool derivatives, const F& f) const;
  bool has_markers() const { return !measured_.film.markers[0].empty(); }
  std::size_t a_line() const { return has_markers() ? 4 : 1; }
  double error_of(std::size_t number) const;
  double measured_at(std::size_t number) const;
  void free_by_default();

  const Measurements& measured_;
  Spec spec_;
  std::vector<FreeParameter> free_;
  std::vector<std::size_t> all_lines_, few_lines_;
  LeastSquares problem_;
  mutable std::array<Pool<EventSolver>, 2> event_solvers_;  ///< without derivatives, with them
};

}  // namespace leapmap
