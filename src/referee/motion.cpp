// SPDX-License-Identifier: GPL-3.0-or-later
#include "referee/motion.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace leapmap::referee {
namespace {

using Vector = Eigen::Matrix<double, 5, 1>;  // (x'', y'', phi'', lambda_f, lambda_n)
using Matrix = Eigen::Matrix<double, 5, 5>;

Matrix equations(const Body& body, const Mode& mode, double phi) {
  const auto& [m, m_p, R, L, I, g, g_along, g_across, motor, resisting, turn] = body;
  const double s = std::sin(phi), c = std::cos(phi);
  Matrix A;
  A << m + m_p, 0, -m_p * L * c, -1, 0,                  // (7)
      0, m + m_p, m_p * L * s, 0, -1,                    // (8)
      -m_p * L * c, m_p * L * s, I + m_p * L * L, R, 0,  // (9)
      0, 0, 0, 0, 0,                                     //
      0, 0, 0, 0, 0;
  if (mode.kind == Mode::rolls) A.row(3) << 1, 0, -R, 0, 0;  // (1), twice differentiated
  if (mode.kind == Mode::slides) A.row(3) << 0, 0, 0, 1, -mode.drag;
  const bool is_free = mode.kind == Mode::flies || mode.kind == Mode::unheld;
  if (is_free) A.row(3) << 0, 0, 0, 1, 0;
  if (is_free)
    A.row(4) << 0, 0, 0, 0, 1;
  else
    A.row(4) << 0, 1, 0, 0, 0;  // (2), twice differentiated
  return A;
}

}  // namespace

Body body_of(const Design& design, const Scene& scene) {
  Body body{};
  body.m = 1.0;
  body.m_p = design.mass_ratio * body.m;
  body.R = scene.radius;
  body.L = design.offset_ratio * body.R;
  body.I = design.inertia_factor * body.m * body.R * body.R;
  body.g = scene.gravity;
  body.g_along = body.g * std::sin(design.slope), body.g_across = body.g * std::cos(design.slope);
  body.motor = design.drive_torque * body.mass() * body.g * body.R;
  body.resisting = design.resisting_torque * body.mass() * body.g * body.R;
  if (scene.motor_in_flight && body.motor != 0.0) body.turn = forces_of(body, {Mode::flies}, {}).phi;
  return body;
}

/// What gravity and the motor turn a hoop at rest with, about the contact [N m].
double moment(const Body& body, double phi) {
  return body.motor + body.mass() * body.R * body.g_along -
         body.m_p * body.L * (body.g_along * std::cos(phi) + body.g_across * std::sin(phi));
}

/// The torque of the bearing: against the rotation, at rest against the moment, and no larger than that.
double resistance(const Body& body, const Mode& mode, const Motion& at) {
  if (mode.kind == Mode::flies || body.resisting == 0.0) return 0.0;
  if (at.spin != 0.0) return std::copysign(body.resisting, at.spin);
  return std::clamp(moment(body, at.phi), -body.resisting, body.resisting);
}

Forces forces_of(const Body& body, const Mode& mode, const Motion& at) {
  const auto& [m, m_p, R, L, I, g, g_along, g_across, motor, resisting, turn] = body;
  const double s = std::sin(at.phi), c = std::cos(at.phi), w2 = at.spin * at.spin;
  const Eigen::RowVector3d along{m + m_p, 0.0, -m_p * L * c}, upwards{0.0, m + m_p, m_p * L * s},
      turning{-m_p * L * c, m_p * L * s, I + m_p * L * L};  // of (7) to (9), by x'', y'' and phi''
  const Eigen::Vector3d loads{(m + m_p) * g_along - m_p * w2 * L * s,
                              -(m + m_p) * g_across - m_p * w2 * L * c,
                              motor - resistance(body, mode, at) - m_p * L * (g_along * c + g_across * s)};
  // By (7) lambda_f is along z - loads[0], by (8) lambda_n is upwards z - loads[1]. Three equations are left,
  // which take far less time than all five.
  Eigen::Matrix3d A;
  Eigen::Vector3d right = loads;
  if (mode.kind == Mode::rolls) {
    A << turning + R * along, 1.0, 0.0, -R, 0.0, 1.0, 0.0;  // (9), (1), (2)
    right << loads[2] + R * loads[0], 0.0, 0.0;
  } else if (mode.kind == Mode::slides) {
    A << along - mode.drag * upwards, turning + R * mode.drag * upwards, 0.0, 1.0, 0.0;  // (7), (9), (2)
    right << loads[0] - mode.drag * loads[1], loads[2] + R * mode.drag * loads[1], 0.0;
  } else {
    A << along, upwards, turning;
  }
  // By Cramer's rule with triple products, which take less time than an inverse.
  const Eigen::Vector3d bc = A.row(1).cross(A.row(2)), ca = A.row(2).cross(A.row(0)),
                        ab = A.row(0).cross(A.row(1));
  const Eigen::Vector3d z = (right[0] * bc + right[1] * ca + right[2] * ab) / A.row(0).dot(bc);
  Forces forces{z[0], z[1], z[2], 0.0, 0.0};
  if (mode.kind == Mode::rolls || mode.kind == Mode::slides) forces.normal = upwards * z - loads[1];
  if (mode.kind == Mode::rolls) forces.friction = along * z - loads[0];
  if (mode.kind == Mode::slides) forces.friction = mode.drag * forces.normal;
  return forces;
}

bool rests(const Body& body, const Motion& at) {
  const auto& [m, m_p, R, L, I, g, g_along, g_across, motor, resisting, turn] = body;
  const double of_weight = (m + m_p) * R * g_along, of_mass = m_p * L;
  const double tangential = g_along * std::cos(at.phi) + g_across * std::sin(at.phi);
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * (1.0 + std::abs(at.phi));
  return std::abs(motor + of_weight - of_mass * tangential) <=
             resisting + rounding * (std::abs(motor) + std::abs(of_weight) + of_mass * g) &&
         std::abs(at.spin) <= rounding * std::sqrt(g / R);
}

double sliding_determinant(const Body& body, const Mode& mode, const Motion& at) {
  const Mode frictionless{Mode::slides, 0.0};
  return equations(body, mode, at.phi).determinant() / equations(body, frictionless, at.phi).determinant();
}

double energy(const Body& body, const Motion& at) {
  const auto& [m, m_p, R, L, I, g, g_along, g_across, motor, resisting, turn] = body;
  const double w = at.spin, speed2 = at.x_rate * at.x_rate + at.y_rate * at.y_rate;
  const double kinetic = 0.5 * m_p *
                             (speed2 + L * L * w * w +
                              2.0 * w * L * (at.y_rate * std::sin(at.phi) - at.x_rate * std::cos(at.phi))) +
                         0.5 * m * speed2 + 0.5 * I * w * w;
  return kinetic + (m + m_p) * (at.y * g_across - at.x * g_along) -
         m_p * L * (g_across * std::cos(at.phi) - g_along * std::sin(at.phi));
}

Landed land_without_slip(const Body& body, const Motion& before) {
  const Matrix A = equations(body, {Mode::rolls}, before.phi);
  Vector momenta = Vector::Zero();
  momenta.head<3>() = A.topLeftCorner<3, 3>() * Eigen::Vector3d{before.x_rate, before.y_rate, before.spin};
  const Vector z = A.partialPivLu().solve(momenta);  // the rates after it, and the impulses
  return {{before.x, before.y, before.phi, z[0], z[1], z[2]}, z[4]};
}

Landed land(const Body& body, const Motion& before, double mu_kinetic, double restitution,
            double rest_speed) {
  // Masses of (7) to (9), and how the contact's two velocities come of the coordinates' rates.
  Eigen::Matrix3d masses = equations(body, {}, before.phi).topLeftCorner<3, 3>();
  Eigen::Matrix<double, 2, 3> contact;
  contact << 1, 0, -body.R, 0, 1, 0;
  const Eigen::Matrix<double, 3, 2> answer =
      masses.inverse() * contact.transpose();  // of the rates, to impulses
  const Eigen::Matrix2d W = contact * answer;  // of the contact's velocities
  Eigen::Vector2d velocity{slip_of(body, before), before.y_rate}, impulse{0, 0};
  const bool can_hold = std::abs(W(0, 1)) <= mu_kinetic * W(0, 0);
  bool held = velocity[0] == 0.0 && can_hold;

  // Goes on along the path, the normal impulse growing, until `left` gives no more of it.
  const auto go = [&](const auto& left) {
    for (;;) {
      const double away = velocity[0] != 0.0 ? velocity[0] : W(0, 1);
      Eigen::Vector2d way{held ? -W(0, 1) / W(0, 0) : away > 0.0 ? -mu_kinetic : mu_kinetic, 1.0};
      const Eigen::Vector2d gained = W * way;
      double length = left(gained);
      const bool stops = velocity[0] * gained[0] < 0.0 && -velocity[0] / gained[0] <= length;
      if (stops) length = -velocity[0] / gained[0];
      impulse += length * way;
      velocity += length * gained;
      if (held || stops) velocity[0] = 0.0;
      if (!stops) return;
      held = can_hold;
    }
  };
  go([&](const Eigen::Vector2d& gained) {
    return gained[1] > 0.0 ? -velocity[1] / gained[1] : std::numeric_limits<double>::infinity();
  });
  velocity[1] = 0.0;
  const double end = (1.0 + restitution) * impulse[1];
  go([&](const Eigen::Vector2d&) { return end - impulse[1]; });

  const Eigen::Vector3d rates = Eigen::Vector3d{before.x_rate, before.y_rate, before.spin} + answer * impulse;
  Motion after = before;
  after.y = body.R;
  after.spin = rates[2];
  after.x_rate = velocity[0] + body.R * after.spin;
  after.y_rate = velocity[1] >= rest_speed ? velocity[1] : 0.0;
  return {after, impulse[1]};
}

}  // namespace leapmap::referee
