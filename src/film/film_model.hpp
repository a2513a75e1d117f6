// SPDX-License-Identifier: GPL-3.0-or-later
/// What a camera or an encoder sees of a hoop's motion, with derivatives by design and camera.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "film/observations.hpp"
#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// A number of a camera, declared once.
struct CameraNumber {
  std::string_view name;
  double Camera::*member;
  std::string_view unit;  ///< "": that of the film's positions
  bool is_linear;         ///< follows from a motion by linear least squares
};

inline constexpr std::array camera_numbers{
    CameraNumber{"time_offset", &Camera::time_offset, "s", false},
    CameraNumber{"angle_offset", &Camera::angle_offset, "rad", true},
    CameraNumber{"scale", &Camera::scale, "m", true},
    CameraNumber{"tilt", &Camera::tilt, "rad", true},
    CameraNumber{"x", &Camera::x, "", true},
    CameraNumber{"y", &Camera::y, "", true},
};

/// nullptr: no such number.
const CameraNumber* find_camera_number(std::string_view name);

/// Whether a number of the film's camera is free. The origin always is.
bool is_free(const Film& film, std::string_view number);

class FilmModel {
 public:
  /// Keeps a reference to the film.
  FilmModel(const Film& film, const Scene& scene);

  const std::vector<Observation>& observations() const { return observations_; }

  /// What is asked of some of the numbers: model less measured, and, where it is asked for, the derivatives
  /// by parameters of the design, as numbered by `differentiable`, then by the camera's numbers; a row a
  /// number.
  struct Question {
    std::span<const std::size_t> numbers;  ///< ascending
    std::span<const std::size_t> by_design{};
    std::span<double Camera::*const> by_camera{};
  };
  /// Either may be empty: it is not asked for. False: the design cannot be solved.
  bool residuals(const Design& design, const Camera& camera, const Question& asked,
                 std::span<double> residuals, std::span<double> jacobian) const;

  /// Residuals as above but for a coarse search, to six digits, after those of the linear numbers that are
  /// free have been fitted to the motion: their values are put into the camera.
  bool residuals_with_camera(const Design& design, Camera& camera, std::span<double Camera::*const> free,
                             std::span<const std::size_t> numbers, std::span<double> residuals) const;

 private:
  template <class S>
  struct Seen;
  template <class S>
  bool see(const Design& design, const Camera& camera, const Question& asked, double accuracy,
           std::vector<Seen<S>>& seen) const;
  template <class S>
  bool compare(std::span<const Seen<S>> seen, const Design& design, const Camera& camera,
               const Question& asked, std::span<double> residuals, std::span<double> jacobian) const;
  /// The angle by which the plane descends in the film.
  double descent(const Design& design, const Camera& camera) const;

  const Film& film_;
  Scene scene_;
  std::vector<Observation> observations_;
};

}  // namespace leapmap
