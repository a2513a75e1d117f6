// SPDX-License-Identifier: GPL-3.0-or-later
#include "hoop/three_coordinates.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace leapmap {
namespace {

using Vector = Eigen::Matrix<double, 5, 1>;  // (x'', y'', phi'', lambda_f, lambda_n)
using Matrix = Eigen::Matrix<double, 5, 5>;

/// a: from the hoop's centre to the reference point; d: from there to the centre of mass.
struct Lengths {
  double a, d;
};

Lengths lengths_of(const ThreeCoordinates& model) {
  return {model.reference, model.hoop.rho - model.reference};
}

/// Masses and constraints, (M -J^T; J 0): M of (7) to (9), J of (1) and (2) differentiated.
Matrix saddle_point(const ThreeCoordinates& model, double s, double c) {
  const auto [a, d] = lengths_of(model);
  Matrix A;
  A << 1, 0, -d * c, -1, 0,                                    // (7)
      0, 1, d * s, 0, -1,                                      // (8)
      -d * c, d * s, model.hoop.Ic + d * d, 1 - a * c, a * s,  // (9)
      1, 0, a * c - 1, 0, 0,                                   // (1): x' = (1 - a c) w
      0, 1, -a * s, 0, 0;                                      // (2): y' = a s w
  return A;
}

Vector loads(const ThreeCoordinates& model, double s, double c, double w) {
  const auto [a, d] = lengths_of(model);
  const Hoop<double>& hoop = model.hoop;
  return {hoop.sin_slope - d * s * w * w, -hoop.cos_slope - d * c * w * w,
          hoop.drive - d * (hoop.sin_slope * c + hoop.cos_slope * s), a * s * w * w, a * c * w * w};
}

/// The system factored, and its solution.
struct Solved {
  Eigen::PartialPivLU<Matrix> factored;
  Vector z;
};

/// Not inlined: one piece of code for all who ask, that they be told the same to the last bit.
[[gnu::noinline]] Solved solved(const ThreeCoordinates& model, double s, double c, double w) {
  const Eigen::PartialPivLU<Matrix> factored(saddle_point(model, s, c));
  return {factored, factored.solve(loads(model, s, c, w))};
}

struct Residuals {
  double x, y;
};

/// (1) and (2), and their derivatives.
Residuals position_residuals(const ThreeCoordinates& model, const ThreeState& y) {
  const double a = model.reference;
  return {y[0] - (y[2] - a * std::sin(y[2])), y[1] + a * std::cos(y[2])};
}
Residuals velocity_residuals(const ThreeCoordinates& model, const ThreeState& y) {
  const double a = model.reference;
  return {y[3] - (1.0 - a * std::cos(y[2])) * y[5], y[4] - a * std::sin(y[2]) * y[5]};
}

/// Corrects three components of the state, from `first` on, by their residuals.
void correct(const ThreeCoordinates& model, const Residuals& residuals, ThreeState& y, std::size_t first) {
  const Vector off{0.0, 0.0, 0.0, -residuals.x, -residuals.y};
  const Vector step = saddle_point(model, std::sin(y[2]), std::cos(y[2])).partialPivLu().solve(off);
  for (std::size_t i = 0; i < 3; ++i) y[first + i] += step[static_cast<Eigen::Index>(i)];
}

}  // namespace

ThreeState ThreeCoordinates::rolling(double angle, double spin) const {
  const double s = std::sin(angle), c = std::cos(angle), a = reference;
  return {angle - a * s, -a * c, angle, (1.0 - a * c) * spin, a * s * spin, spin};
}

ConstrainedMotion ThreeCoordinates::motion(const ThreeState& y) const {
  const auto [a, d] = lengths_of(*this);
  const double s = std::sin(y[2]), c = std::cos(y[2]), w = y[5];
  const auto [factored, z] = solved(*this, s, c, w);
  // A z = b along the motion: A z' = b' - A' z.
  const double turned = c * w * w * w + 2.0 * s * w * z[2];   // of s w^2
  const double tilted = -s * w * w * w + 2.0 * c * w * z[2];  // of c w^2
  const Vector rates{-d * turned - d * s * w * z[2], -d * tilted - d * c * w * z[2],
                     -d * (hoop.cos_slope * c - hoop.sin_slope * s) * w -
                         w * (d * (s * z[0] + c * z[1]) + a * (s * z[3] + c * z[4])),
                     a * turned + a * s * w * z[2], a * tilted + a * c * w * z[2]};
  return {{z[0], z[1], z[2]}, z[3], z[4], factored.solve(rates)[4]};
}

std::array<double, 3> ThreeCoordinates::acceleration(const ThreeState& y) const {
  const Vector z = solved(*this, std::sin(y[2]), std::cos(y[2]), y[5]).z;
  return {z[0], z[1], z[2]};
}

void ThreeCoordinates::project(ThreeState& y) const {
  correct(*this, position_residuals(*this, y), y, 0);
  correct(*this, velocity_residuals(*this, y), y, 3);
}

double ThreeCoordinates::drift(const ThreeState& y) const {
  const Residuals position = position_residuals(*this, y), velocity = velocity_residuals(*this, y);
  return std::max({std::abs(position.x), std::abs(position.y), std::abs(velocity.x), std::abs(velocity.y)});
}

}  // namespace leapmap
