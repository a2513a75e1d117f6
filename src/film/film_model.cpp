// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film_model.hpp"

#include <algorithm>
#include <cmath>

#include "film/motion_at.hpp"
#include "hoop/units.hpp"

namespace leapmap {
namespace {

// Relative errors of motions. Derivatives only lead to where residuals are least, and tell errors.
constexpr double fine = 1e-11, coarse = 1e-6, of_derivatives = 1e-7;

/// Means over numbers of one kind: of points in the plane's axes and of their positions.
struct Positions {
  double X = 0.0, Y = 0.0, value = 0.0, count = 0.0;
};

}  // namespace

const CameraNumber* find_camera_number(std::string_view name) {
  const auto found = std::ranges::find(camera_numbers, name, &CameraNumber::name);
  return found == camera_numbers.end() ? nullptr : &*found;
}

bool is_free(const Film& film, std::string_view number) {
  return std::ranges::find(film.free, number) != film.free.end();
}

/// What a number is of: an angle or a spin, or a point in the plane's own axes.
template <class S>
struct FilmModel::Seen {
  S a{0.0};             ///< angle [rad], spin [rad/s], or X: downhill along the plane [m]
  S b{0.0};             ///< Y: above the plane [m]
  double a_rate = 0.0;  ///< over the film's time; 0 before the release
  double b_rate = 0.0;
};

FilmModel::FilmModel(const Film& film, const Scene& scene)
    : film_(film), scene_(scene), observations_(observations_of(film)) {}

double FilmModel::descent(const Design& design, const Camera& camera) const {
  return camera.tilt + (film_.is_level ? design.slope : 0.0);
}

template <class S>
bool FilmModel::see(const Design& design, const Camera& camera, const Question& asked, double accuracy,
                    std::vector<Seen<S>>& seen) const {
  std::vector<double> times;  // after the release, each once
  for (const std::size_t number : asked.numbers) {
    const double t = observations_[number].t - camera.time_offset;
    if (t >= 0.0 && (times.empty() || t > times.back())) times.push_back(t);
  }
  const std::vector<MotionAt<S>> motion = motion_at<S>(design, scene_, times, accuracy, asked.by_design);
  if (motion.empty() && !times.empty()) return false;
  const S held_at = seeded<S>(design.release_angle, by_release_angle, asked.by_design);
  const MotionAt<S> held{held_at, S(0.0), S(0.0), S(0.0), 0.0, 0.0, 0.0};
  const double second = time_unit(scene_), R = scene_.radius;
  const S L = seeded<S>(design.offset_ratio, by_offset_ratio, asked.by_design);
  seen.clear();
  std::size_t at = 0;
  for (const std::size_t number : asked.numbers) {
    const Observation& one = observations_[number];
    const double t = one.t - camera.time_offset;
    while (at + 1 < times.size() && times[at] < t) ++at;
    const MotionAt<S>& now = t < 0.0 ? held : motion[at];
    const double spin = value_of(now.spin);
    if (one.kind == Measured::angle) {
      seen.push_back({now.phi, S(0.0), spin / second, 0.0});
    } else if (one.kind == Measured::spin) {
      seen.push_back({now.spin * (1.0 / second), S(0.0), now.spin_rate / (second * second), 0.0});
    } else {
      const Track& track = film_.tracks[one.track];
      const S l = std::isnan(track.at) ? L : S(track.at / R);
      const Trig<S> phi = trig(S(now.phi + S(track.angle)));  // the point is at (-l sin phi, -l cos phi)
      const double sine = value_of(phi.sin), cosine = value_of(phi.cos), l_spin = value_of(l) * spin;
      seen.push_back({(now.x - l * phi.sin) * R, (now.y + S(1.0) - l * phi.cos) * R,
                      (now.x_rate - l_spin * cosine) * R / second,
                      (now.y_rate + l_spin * sine) * R / second});
    }
  }
  return true;
}

template <class S>
bool FilmModel::compare(std::span<const Seen<S>> seen, const Design& design, const Camera& camera,
                        const Question& asked, std::span<double> residuals,
                        std::span<double> jacobian) const {
  const double a = descent(design, camera), c = std::cos(a) / camera.scale, s = std::sin(a) / camera.scale;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Observation& one = observations_[asked.numbers[i]];
    const bool point = is_position(one.kind), vertical = one.kind == Measured::y;
    // A number is along * a + across * b + offset.
    const double along = point ? (vertical ? -s : c) : 1.0, across = point ? (vertical ? c : s) : 0.0;
    const double offset = point                         ? (vertical ? camera.y : camera.x)
                          : one.kind == Measured::angle ? -camera.angle_offset
                                                        : 0.0;
    const double A = value_of(seen[i].a), B = value_of(seen[i].b), rotated = along * A + across * B;
    if constexpr (!has_derivatives<S>) residuals[i] = rotated + offset - one.value;
    if constexpr (has_derivatives<S>) {
      const double turned = point ? (vertical ? -c * A - s * B : -s * A + c * B) : 0.0;  // by the descent
      double* row = jacobian.data() + i * (asked.by_design.size() + asked.by_camera.size());
      for (std::size_t k = 0; k < asked.by_design.size(); ++k)
        *row++ = along * seen[i].a.by[k] + across * seen[i].b.by[k] +
                 (film_.is_level && asked.by_design[k] == by_slope ? turned : 0.0);
      for (double Camera::*const by : asked.by_camera)
        *row++ = by == &Camera::time_offset    ? -along * seen[i].a_rate - across * seen[i].b_rate
                 : by == &Camera::angle_offset ? (one.kind == Measured::angle ? -1.0 : 0.0)
                 : by == &Camera::scale        ? (point ? -rotated / camera.scale : 0.0)
                 : by == &Camera::tilt         ? turned
                 : by == &Camera::x            ? (one.kind == Measured::x ? 1.0 : 0.0)
                                               : (one.kind == Measured::y ? 1.0 : 0.0);
    }
  }
  const auto finite = [](double number) { return std::isfinite(number); };
  return std::ranges::all_of(residuals, finite) && std::ranges::all_of(jacobian, finite);
}

bool FilmModel::residuals(const Design& design, const Camera& camera, const Question& asked,
                          std::span<double> residuals, std::span<double> jacobian) const {
  const auto run = [&]<class S>(S, double accuracy) {
    std::vector<Seen<S>> seen;
    return see<S>(design, camera, asked, accuracy, seen) &&
           compare<S>(seen, design, camera, asked, residuals, jacobian);
  };
  if (!residuals.empty() && !run(0.0, fine)) return false;
  if (jacobian.empty()) return true;
  return asked.by_design.size() <= FewDual::derivatives ? run(FewDual(0.0), of_derivatives)
                                                        : run(DesignDual(0.0), of_derivatives);
}

bool FilmModel::residuals_with_camera(const Design& design, Camera& camera,
                                      std::span<double Camera::*const> free,
                                      std::span<const std::size_t> numbers,
                                      std::span<double> residuals) const {
  std::vector<Seen<double>> seen;
  if (!see<double>(design, camera, {numbers}, coarse, seen)) return false;
  const auto fits = [&](double Camera::*number) { return std::ranges::find(free, number) != free.end(); };
  double angle = 0.0;
  std::size_t angles = 0;
  for (std::size_t i = 0; i < seen.size(); ++i)
    if (const Observation& one = observations_[numbers[i]]; one.kind == Measured::angle)
      angle += seen[i].a - one.value, ++angles;
  if (angles > 0 && fits(&Camera::angle_offset)) camera.angle_offset = angle / static_cast<double>(angles);
  const auto mean = [&](Measured kind) {
    Positions sum;
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (const Observation& one = observations_[numbers[i]]; one.kind == kind)
        sum.X += seen[i].a, sum.Y += seen[i].b, sum.value += one.value, sum.count += 1.0;
    return Positions{sum.X / sum.count, sum.Y / sum.count, sum.value / sum.count, sum.count};
  };
  const Positions of_x = mean(Measured::x), of_y = mean(Measured::y);
  if (of_x.count > 0.0 && of_y.count > 0.0) {
    // The similarity that takes points to positions, x = p X + q Y, y = p Y - q X: its normal equations.
    double pp = 0.0, pq = 0.0, qq = 0.0, p = 0.0, q = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Observation& one = observations_[numbers[i]];
      if (!is_position(one.kind)) continue;
      const Positions& middle = one.kind == Measured::x ? of_x : of_y;
      const double X = seen[i].a - middle.X, Y = seen[i].b - middle.Y, value = one.value - middle.value;
      const double by_p = one.kind == Measured::x ? X : Y, by_q = one.kind == Measured::x ? Y : -X;
      pp += by_p * by_p, pq += by_p * by_q, qq += by_q * by_q, p += by_p * value, q += by_q * value;
    }
    double a = descent(design, camera);
    if (const double determinant = pp * qq - pq * pq; fits(&Camera::tilt) && determinant > 0.0) {
      const double turned = std::atan2(pp * q - pq * p, qq * p - pq * q);
      camera.tilt += turned - a, a = turned;
    }
    const double c = std::cos(a), s = std::sin(a), along = p * c + q * s;
    if (fits(&Camera::scale) && along > 0.0)
      camera.scale = (pp * c * c + 2.0 * pq * c * s + qq * s * s) / along;
    camera.x = of_x.value - (c * of_x.X + s * of_x.Y) / camera.scale;
    camera.y = of_y.value - (c * of_y.Y - s * of_y.X) / camera.scale;
  }
  return compare<double>(seen, design, camera, {numbers}, residuals, {});
}

}  // namespace leapmap
