// SPDX-License-Identifier: GPL-3.0-or-later
/// Measurements and a model that is to explain them: free parameters, residuals and their derivatives.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "design/least_squares.hpp"
#include "design/question.hpp"
#include "film/film_model.hpp"
#include "leapmap/fit.hpp"
#include "support/pool.hpp"
#include "trajectory/gradient.hpp"

namespace leapmap {

/// A number of the camera that is free.
struct FreeCamera {
  const CameraNumber* number;
  Side side;
};

class Explained {
 public:
  /// Keeps a reference to the measurements. free: names of parameters that are free beside the spec's axes,
  /// within usual bounds. Throws InputError if the spec does not fit the model, or nothing is free.
  Explained(const Measurements& measured, const Spec& spec, Friction friction,
            std::span<const std::string> free = {});

  bool is_film() const { return measured_.events.empty(); }
  const Scene& scene() const { return spec_.scene; }
  const std::vector<FreeParameter>& free() const { return free_; }
  const std::vector<FreeCamera>& camera() const { return camera_; }
  /// Parameters: the free ones, then the camera's. Residuals are over the errors.
  const LeastSquares& problem() const { return problem_; }
  /// The same over as few of a film's numbers as suffice to follow starting points.
  const LeastSquares& small_problem() const { return is_film() ? small_problem_ : problem_; }
  /// How many of the parameters are searched for on a coarse map: all but those of the camera that follow
  /// from a motion.
  std::size_t searched() const { return searched_; }
  Design design_at(std::span<const double> at) const;
  Camera camera_at(std::span<const double> at) const;

  /// The sums of squares at places of the parameters searched for, over as few of a film's numbers as
  /// suffice.
  void coarse_sums(std::span<const std::vector<double>> places, std::span<double> sums) const;
  /// A place with those of the camera that suit it best added.
  std::vector<double> with_camera(std::span<const double> at) const;

  /// Whether the measurements say how good they are; if not, residuals are over error_of().
  bool errors_known() const;
  /// How many of the film's units of positions are a metre, by its first estimate.
  double units_per_metre() const { return 1.0 / measured_.film.camera.scale; }
  /// The error that a number's residual is over.
  double error_of(std::size_t number) const;
  /// What the model has in place of every number measured.
  std::vector<double> model_at(std::span<const double> residuals) const;
  const std::vector<Observation>& observations() const { return film_.observations(); }

 private:
  bool film_residuals(std::span<const double> at, std::span<const std::size_t> numbers,
                      std::span<double> residuals, std::span<double> jacobian) const;
  bool event_differences(std::span<const double> at, std::span<double> residuals,
                         std::span<double> jacobian) const;
  bool event_residuals(std::span<const double> at, std::span<double> residuals,
                       std::span<double> jacobian) const;
  /// A solver of the events' fields, with derivatives by the free parameters or without. f(EventSolver&).
  struct EventSolver {
    GradientSolver solve;
    Gradients gradients;
  };
  template <class F>
  auto with_event_solver(bool derivatives, const F& f) const;
  double measured_at(std::size_t number) const;
  void free_by_default();
  void free_by_name(std::span<const std::string> names);
  FreeParameter release_angle_of_film() const;
  void free_camera();
  /// The numbers of a film that coarse maps use, and the errors of all.
  void choose_numbers();

  const Measurements& measured_;
  Spec spec_;
  FilmModel film_;
  std::vector<FreeParameter> free_;
  std::vector<FreeCamera> camera_;
  std::vector<double Camera::*> by_camera_;
  std::vector<std::size_t> by_design_;  ///< places of the free parameters among `differentiable`
  std::size_t searched_ = 0;
  std::vector<std::size_t> all_numbers_, few_numbers_;
  std::array<double, 3> errors_{};  ///< of angles, spins and positions
  LeastSquares problem_, small_problem_;
  mutable std::array<Pool<EventSolver>, 2> event_solvers_;  ///< without derivatives, with them
};

}  // namespace leapmap
