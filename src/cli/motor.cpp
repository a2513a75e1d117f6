// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/motor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/model.hpp"

namespace leapmap::cli {

Motor motor_of(const Spec& spec, const Motion& motion) {
  constexpr double samples = 4000.0, most_samples = 1e6;
  const auto tell = model_of(spec.scene).tell_exactly;
  const double tolerance = std::max(spec.numerics.tolerance, 1e-10);
  const double whole = tell(spec.design, spec.scene, tolerance, std::numeric_limits<double>::infinity()).end;
  const double end = std::isnan(motion.outcome.jump_time) ? whole : motion.outcome.jump_time;
  const Scene& scene = spec.scene;
  const double newton_metres = scene.mass * scene.gravity * scene.radius;
  Motor motor{.mass = scene.mass,
              .torque = spec.design.drive_torque * (scene.mass > 0.0 ? newton_metres : NAN),
              .power = -std::numeric_limits<double>::infinity(),
              .spin = 0.0,
              .work = 0.0,
              .only_brakes = true};
  // A flight may last ten million times as long as the contact before it. However few samples that leaves to
  // the contact, its ends are among them.
  const double interval = std::max({end / samples, whole / most_samples, 1e-10});
  const Motion sampled = tell(spec.design, spec.scene, tolerance, interval);
  std::vector<MotionPoint> points = sampled.points;
  const auto put = [&](double t, double phi, double spin, Phase phase) {
    points.push_back({t, phi, spin, 0.0, 0.0, 0.0, 0.0, phase});
  };
  for (const Candidate& lift_off : sampled.candidates)
    put(lift_off.t, lift_off.phi, lift_off.spin, Phase::rolling);  // the last of contact
  for (const PhaseStart& start : sampled.phases) put(start.t, start.phi, start.spin, start.phase);
  std::ranges::stable_sort(points, {}, &MotionPoint::t);
  const MotionPoint* before = nullptr;
  for (const MotionPoint& at : points) {
    if (before && before->phase != Phase::flight && at.phase != Phase::flight)
      motor.work += motor.torque * (at.phi - before->phi);
    before = &at;
    if (at.phase == Phase::flight) continue;
    if (!(motor.torque * at.spin < motor.power)) motor.power = motor.torque * at.spin;
    if (spec.design.drive_torque * at.spin > 0.0) motor.only_brakes = false;
    motor.spin = std::max(motor.spin, std::abs(at.spin) * 30.0 / std::numbers::pi);
  }
  return motor;
}

}  // namespace leapmap::cli
