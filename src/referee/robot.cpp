// SPDX-License-Identifier: GPL-3.0-or-later
#include "referee/robot.hpp"

#include <Eigen/LU>
#include <cmath>

namespace leapmap::referee {
namespace {

/// The unknowns, in their order.
struct Of {
  enum : int { x, y, phi, pendulum_x, pendulum_y, psi, pin_x, pin_y, friction, normal, torque, count };
};
using TwoBodies = Eigen::Matrix<double, Of::count, 1>;
using Eleven = Eigen::Matrix<double, Of::count, Of::count>;

Eleven equations(const Robot& r, const RobotMode& mode, const RobotMotion& at) {
  const double s = std::sin(at.psi), c = std::cos(at.psi);
  Eleven A = Eleven::Zero();
  A(0, Of::x) = r.m, A(0, Of::pin_x) = -1.0, A(0, Of::friction) = -1.0;
  A(1, Of::y) = r.m, A(1, Of::pin_y) = -1.0, A(1, Of::normal) = -1.0;
  A(2, Of::phi) = r.I, A(2, Of::friction) = r.R, A(2, Of::torque) = 1.0;
  A(3, Of::pendulum_x) = r.m_p, A(3, Of::pin_x) = 1.0;
  A(4, Of::pendulum_y) = r.m_p, A(4, Of::pin_y) = 1.0;
  A(5, Of::psi) = r.I_p, A(5, Of::pin_x) = r.L * c, A(5, Of::pin_y) = -r.L * s, A(5, Of::torque) = -1.0;
  A(6, Of::pendulum_x) = 1.0, A(6, Of::x) = -1.0, A(6, Of::psi) = r.L * c;  // the pin, twice differentiated
  A(7, Of::pendulum_y) = 1.0, A(7, Of::y) = -1.0, A(7, Of::psi) = -r.L * s;
  switch (mode.kind) {
    case RobotMode::rolls:
      A(8, Of::x) = 1.0, A(8, Of::phi) = -r.R, A(9, Of::y) = 1.0;
      break;
    case RobotMode::slides:
      A(8, Of::friction) = 1.0, A(8, Of::normal) = -mode.drag, A(9, Of::y) = 1.0;
      break;
    case RobotMode::flies:
      A(8, Of::friction) = 1.0, A(9, Of::normal) = 1.0;
      break;
  }
  if (mode.motor == Motored::holds)
    A(10, Of::psi) = 1.0, A(10, Of::phi) = -1.0;
  else
    A(10, Of::torque) = 1.0;
  return A;
}

}  // namespace

Robot robot_of(const Design& design, const Scene& scene) {
  Robot robot{};
  const double R = scene.radius, g = scene.gravity, second = std::sqrt(R / g);
  robot.m = 1.0, robot.m_p = design.mass_ratio;
  robot.R = R, robot.L = design.offset_ratio * R;
  robot.I = design.inertia_factor * R * R,
  robot.I_p = design.pendulum_inertia * robot.m_p * robot.L * robot.L;
  robot.g = g, robot.slope = design.slope;
  const double torque = robot.weight() * R;
  robot.law = scene.motor_law;
  robot.stall = design.motor_torque * torque, robot.no_load = design.no_load_speed / second;
  const bool of_speed = robot.law == MotorLaw::speed || robot.law == MotorLaw::until_speed;
  robot.target = of_speed ? design.motor_target / second : design.motor_target;
  robot.gain = design.motor_gain * torque * (of_speed ? second : 1.0);
  robot.damping = design.motor_damping * torque * second;
  return robot;
}

MotorRange motor_range(const Robot& robot, const RobotMotion& at) {
  const double most = std::abs(robot.stall), speed = at.swing - at.spin, lost = most * speed / robot.no_load;
  const double wanted = robot.law == MotorLaw::angle
                            ? robot.gain * (robot.target - at.psi) - robot.damping * at.swing
                            : robot.gain * (robot.target - speed);
  return {most - lost, -most - lost, wanted};
}

RobotForces forces_of(const Robot& r, const RobotMode& mode, const RobotMotion& at) {
  const double s = std::sin(at.psi), c = std::cos(at.psi), swing2 = at.swing * at.swing;
  TwoBodies loads = TwoBodies::Zero();
  loads[0] = r.m * r.g * std::sin(r.slope), loads[1] = -r.m * r.g * std::cos(r.slope);
  loads[3] = r.m_p * r.g * std::sin(r.slope), loads[4] = -r.m_p * r.g * std::cos(r.slope);
  loads[6] = r.L * s * swing2, loads[7] = r.L * c * swing2;
  const MotorRange range = motor_range(r, at);
  if (mode.motor == Motored::up) loads[10] = range.up;
  if (mode.motor == Motored::down) loads[10] = range.down;
  if (mode.motor == Motored::follows) loads[10] = range.wanted;
  const TwoBodies z = equations(r, mode, at).partialPivLu().solve(loads);
  return {z[Of::x],     z[Of::y],     z[Of::phi],      z[Of::pendulum_x], z[Of::pendulum_y], z[Of::psi],
          z[Of::pin_x], z[Of::pin_y], z[Of::friction], z[Of::normal],     z[Of::torque]};
}

double sliding_determinant(const Robot& robot, const RobotMode& mode, const RobotMotion& at) {
  RobotMode frictionless = mode;
  frictionless.drag = 0.0;
  return equations(robot, mode, at).determinant() / equations(robot, frictionless, at).determinant();
}

double energy(const Robot& r, const RobotMotion& at) {
  const double s = std::sin(at.psi), c = std::cos(at.psi);
  const double px = at.x - r.L * s, py = at.y - r.L * c;  // the pendulum's centre of mass
  const double px_rate = at.x_rate - r.L * c * at.swing, py_rate = at.y_rate + r.L * s * at.swing;
  const auto height = [&](double along, double across) {
    return across * std::cos(r.slope) - along * std::sin(r.slope);
  };
  return 0.5 * (r.m * (at.x_rate * at.x_rate + at.y_rate * at.y_rate) + r.I * at.spin * at.spin +
                r.m_p * (px_rate * px_rate + py_rate * py_rate) + r.I_p * at.swing * at.swing) +
         r.g * (r.m * height(at.x, at.y) + r.m_p * height(px, py));
}

RobotLanded land(const Robot& r, const RobotMotion& before, Motored motor, double mu_kinetic,
                 double restitution, double rest_speed) {
  // Impulses in place of forces: rates of the six coordinates change by what a unit of each makes of them.
  const RobotMode free{RobotMode::flies, motor};
  const Eigen::PartialPivLU<Eleven> solver(equations(r, free, before));
  const auto answer = [&](int impulse) -> TwoBodies {
    TwoBodies unit = TwoBodies::Zero();
    unit[impulse == Of::friction ? 8 : 9] = 1.0;
    return solver.solve(unit);
  };
  const TwoBodies by_friction = answer(Of::friction), by_normal = answer(Of::normal);
  const auto slip_of = [&](const TwoBodies& rates) { return rates[Of::x] - r.R * rates[Of::phi]; };
  const double tt = slip_of(by_friction), tn = slip_of(by_normal), nt = by_friction[Of::y],
               nn = by_normal[Of::y];
  double slip = before.x_rate - r.R * before.spin, rise = before.y_rate, F = 0.0, N = 0.0;
  const auto push = [&](double friction, double normal) {
    F += friction, N += normal;
    slip += tt * friction + tn * normal, rise += nt * friction + nn * normal;
  };
  if (mu_kinetic < 0.0) {
    const double determinant = tt * nn - tn * nt;
    push((tn * rise - nn * slip) / determinant, (nt * slip - tt * rise) / determinant);
    slip = rise = 0.0;
  } else {
    const bool can_hold = std::abs(tn) <= mu_kinetic * tt;
    bool held = slip == 0.0 && can_hold;
    // Routh's path: to the end of compression, where rise is zero, and on by its share of N.
    double to_go = HUGE_VAL;
    for (int part = 0; part < 2; ++part) {
      for (int piece = 0; piece < 3; ++piece) {
        const double share = held ? -tn / tt : -mu_kinetic * std::copysign(1.0, slip != 0.0 ? slip : tn);
        const double slip_rate = tt * share + tn, rise_rate = nt * share + nn;
        double length = part == 1 ? to_go : rise_rate > 0.0 ? -rise / rise_rate : HUGE_VAL;
        const double stops_at = held || slip * slip_rate >= 0.0 ? HUGE_VAL : -slip / slip_rate;
        const bool stops = stops_at <= length;
        if (stops) length = stops_at;
        push(share * length, length);
        to_go -= length;
        if (!stops) break;
        slip = 0.0, held = can_hold;
      }
      if (part == 0) rise = 0.0, to_go = restitution * N;
    }
    if (held) slip = 0.0;
    if (rise < rest_speed) rise = 0.0;
  }
  RobotMotion after = before;
  after.spin += by_friction[Of::phi] * F + by_normal[Of::phi] * N;
  after.swing += by_friction[Of::psi] * F + by_normal[Of::psi] * N;
  after.x_rate = slip + r.R * after.spin, after.y_rate = rise;
  return {after, N};
}

}  // namespace leapmap::referee
