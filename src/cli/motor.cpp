// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/motor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/model.hpp"

namespace leapmap::cli {

Motor motor_of(const Spec& spec, const Motion& motion) {
  const Scene& scene = spec.scene;
  const double joules = scene.mass > 0.0 ? scene.mass * scene.gravity * scene.radius : NAN;
  Motor motor{.mass = scene.mass,
              .torque = spec.design.drive_torque * joules,
              .power = -std::numeric_limits<double>::infinity(),
              .spin = 0.0,
              .work = 0.0,
              .only_brakes = true};
  constexpr double rpm = 30.0 / std::numbers::pi;
  if (const Outcome& jump = motion.outcome; !std::isnan(jump.motor_energy)) {
    const double second = time_unit(scene);
    motor.power = jump.motor_max_power * joules / second, motor.spin = jump.motor_max_spin / second * rpm;
    motor.work = jump.motor_energy * joules, motor.only_brakes = !(jump.motor_max_power > 0.0);
    return motor;
  }
  constexpr double samples = 4000.0, most_samples = 1e6;
  const auto tell = model_of(spec.scene).tell_exactly;
  const double tolerance = std::max(spec.numerics.tolerance, 1e-10);
  const double whole = tell(spec.design, spec.scene, tolerance, std::numeric_limits<double>::infinity()).end;
  const double end = std::isnan(motion.outcome.jump_time) ? whole : motion.outcome.jump_time;
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
  const auto drives = [&](Phase phase) { return phase != Phase::flight || scene.motor_in_flight; };
  const MotionPoint* before = nullptr;
  for (const MotionPoint& at : points) {
    if (before && drives(before->phase) && drives(at.phase))
      motor.work += motor.torque * (at.phi - before->phi);
    before = &at;
    if (!drives(at.phase)) continue;
    if (!(motor.torque * at.spin < motor.power)) motor.power = motor.torque * at.spin;
    if (spec.design.drive_torque * at.spin > 0.0) motor.only_brakes = false;
    motor.spin = std::max(motor.spin, std::abs(at.spin) * rpm);
  }
  return motor;
}

}  // namespace leapmap::cli
