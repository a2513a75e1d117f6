// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/motor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/model.hpp"

namespace leapmap::cli {

Motor motor_of(const Spec& spec, const Motion& motion, double mass) {
  constexpr double samples = 4000.0;
  const auto tell = model_of(spec.scene).tell_exactly;
  const double tolerance = std::max(spec.numerics.tolerance, 1e-10);
  double end = motion.outcome.jump_time;
  if (std::isnan(end))
    end = tell(spec.design, spec.scene, tolerance, std::numeric_limits<double>::infinity()).end;
  Motor motor{.mass = mass,
              .torque = spec.design.drive_torque * mass * spec.scene.gravity * spec.scene.radius,
              .power = -std::numeric_limits<double>::infinity(),
              .spin = 0.0,
              .work = 0.0};
  const Motion sampled = tell(spec.design, spec.scene, tolerance, std::max(end, 1e-6) / samples);
  const MotionPoint* before = nullptr;
  for (const MotionPoint& at : sampled.points) {
    if (before && before->phase != Phase::flight && at.phase != Phase::flight)
      motor.work += motor.torque * (at.phi - before->phi);
    before = &at;
    if (at.phase == Phase::flight) continue;
    motor.power = std::max(motor.power, motor.torque * at.spin);
    motor.spin = std::max(motor.spin, std::abs(at.spin) * 30.0 / std::numbers::pi);
  }
  return motor;
}

}  // namespace leapmap::cli
