// SPDX-License-Identifier: GPL-3.0-or-later
#include "referee/robot_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "referee/largest.hpp"

namespace leapmap::referee {
namespace {

RobotMotion motion_of(const State<9>& y) { return {y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7], y[8]}; }
State<9> state_of(const RobotMotion& at) {
  return {at.x, at.y, at.phi, at.psi, at.x_rate, at.y_rate, at.spin, at.swing, at.work};
}

}  // namespace

struct RobotRun::Moving {
  using Y = State<9>;
  using Motion = RobotMotion;
  const RobotRun& run;

  Motion motion(const Y& y) const { return motion_of(y); }
  Y rates(const Motion& at) const {
    const RobotForces a = forces_of(run.robot_, run.mode_, at);
    return {at.x_rate, at.y_rate, at.spin, at.swing, a.x, a.y, a.phi, a.psi, a.torque * (at.swing - at.spin)};
  }
  double moment(const Motion& at) const {
    return 1e-5 / (std::abs(at.spin) + std::abs(at.swing) + 1.0 / run.second_);
  }
};

int RobotRun::rates(double, const double y[], double f[], void* params) {
  const Moving moving{*static_cast<const RobotRun*>(params)};
  Y state;
  std::copy_n(y, state.size(), state.begin());
  std::ranges::copy(moving.rates(moving.motion(state)), f);
  return GSL_SUCCESS;
}

RobotRun::RobotRun(const Scene& scene, const Design& design, double tolerance, long most_steps,
                   bool meets_forces)
    : scene_(scene),
      meets_forces_(meets_forces),
      robot_(robot_of(design, scene)),
      second_(std::sqrt(scene.radius / scene.gravity)),
      mu_kinetic_(std::isnan(design.mu_kinetic) ? design.mu_static : design.mu_kinetic),
      mu_static_(std::max(design.mu_static, mu_kinetic_)),
      restitution_(design.restitution),
      least_(tolerance * std::min({1.0, scene.radius, 1.0 / second_, scene.radius / second_})),
      integrator_(*find_gsl_stepper("gsl-rk8pd"), {.relative = tolerance, .absolute = least_},
                  {&rates, nullptr, 9, this}),
      aloft_(*find_gsl_stepper("gsl-rk8pd"), {.relative = tolerance, .absolute = least_},
             {&rates, nullptr, 9, this}),
      most_steps_(most_steps) {
  const double w = design.release_spin / second_;
  at_ = {0.0,
         scene.radius,
         design.release_angle,
         design.pendulum_angle,
         scene.radius * w,
         0.0,
         w,
         design.pendulum_spin / second_,
         0.0};
  released_ = energy(robot_, at_);
}

Outcome RobotRun::solve() {
  const bool has_motion = robot_.m_p * robot_.L > 0.0 && robot_.I > 0.0;
  if (!has_motion) return finish(Status::indeterminate);
  decide_motor(false);
  way_ = look_at(at_);
  way_.force = std::max(way_.force, 0.0);  // of a torque that lifts it at once
  return scene_.friction == Friction::coulomb ? with_friction() : without_slip();
}

int RobotRun::follow(GslIntegrator<9>& integrator, const std::vector<Guard>& contact,
                     const std::function<bool(int)>& happens, double ends) {
  const std::vector<MotorGuard> motor = motor_guards();
  std::vector<Guard> guards = contact;
  for (const MotorGuard& one : motor) guards.push_back(one.guard);
  const Moving moving{*this};
  const Sampled<Moving> sample(moving, guards);
  const Y start = state_of(at_);
  const double began = time_;
  if (!(began < ends)) return -2;
  GuardedSteps<9> steps;
  steps.begin(start, guards.size(), sample);
  if (!integrator.start(start, 0.01 / (1.0 / second_ + std::abs(at_.swing)))) return -1;
  for (;;) {
    if (++steps_ > most_steps_ ||
        steps.take(
            integrator, [](const Y& y) { return y[3]; }, 16.0, sample) != Stepped::taken)
      return -1;
    const Step<9>& step = integrator.step();
    for (const Event<9>& event : steps.events()) {
      if (began + step.t0 + event.tau > ends) break;
      at_ = motion_of(event.state), time_ = began + step.t0 + event.tau;
      const std::size_t number = event.guard;
      // The way so far counts before whatever ends it.
      const bool of_motor = number >= contact.size();
      if (meets_forces_ && (of_motor || &integrator == &integrator_)) meet(integrator, event.tau);
      if (of_motor) {
        motor[number - contact.size()].passes();
        return static_cast<int>(number);
      }
      if (!happens(static_cast<int>(number))) continue;
      if (meets_forces_ && &integrator == &aloft_) meet(integrator, event.tau);
      return static_cast<int>(number);
    }
    if (meets_forces_) meet(integrator, std::min(step.h, ends - (began + step.t0)));
    const double left = ends - (began + step.t0);
    Y last = step.y1;
    if (step.h > left && !integrator.retake(left, last)) return -1;
    at_ = motion_of(last), time_ = began + step.t0 + std::min(step.h, left);
    if (step.h > left) return -2;
  }
}

auto RobotRun::look_at(const RobotMotion& at) const -> Look {
  const RobotForces forces = forces_of(robot_, mode_, at);
  const double speed = at.swing - at.spin;
  return {forces.normal, forces.torque * speed, std::abs(speed), std::abs(forces.torque)};
}

void RobotRun::meet(const GslIntegrator<9>& integrator, double end) {
  raise_to_largest(
      integrator, end, [&](const Y& y) { return look_at(motion_of(y)); },
      std::array{&Look::force, &Look::power, &Look::speed, &Look::torque}, way_);
}

Outcome RobotRun::finish(Status status) {
  const std::uint64_t sequence = outcome_.phase_sequence;
  if (status == Status::failed) outcome_ = failed_outcome("the reference solver failed");
  if (status == Status::indeterminate) outcome_ = {};
  if (status != Status::failed && status != Status::indeterminate && scene_.friction == Friction::coulomb)
    outcome_.slip_distance = slipped_ / scene_.radius;
  outcome_.phase_sequence = sequence;
  outcome_.status = status;
  return outcome_;
}

Outcome solve_robot(const Design& design, const Scene& scene, double tolerance, long most_steps,
                    bool meets_forces) {
  return RobotRun(scene, design, tolerance, most_steps, meets_forces).solve();
}

}  // namespace leapmap::referee
