// SPDX-License-Identifier: GPL-3.0-or-later
#include "friction/coulomb_integration.hpp"

#include <algorithm>
#include <cmath>

#include "friction/coulomb_automaton.hpp"
#include "hoop/sliding.hpp"

namespace leapmap {
namespace {

/// (phi, w, v, x), for both phases: while rolling v stays zero.
using Y = State<4>;
constexpr double rolls = std::numeric_limits<double>::infinity();  // System::friction while rolling

void derivative(const CoulombIntegration::System& system, const double y[], double f[]) {
  const Trig<double> phi = trig(y[0]);
  f[0] = y[1];
  f[3] = y[2] + y[1];
  if (system.friction == rolls) {
    f[1] = angular_acceleration(system.hoop, phi, y[1]);
    f[2] = 0.0;
  } else {
    const SlidingMotion<double> motion = sliding_motion(system.hoop, phi, y[1] * y[1], system.friction);
    f[1] = motion.angular;
    f[2] = motion.slip;
  }
}

int right_hand_side(double, const double y[], double f[], void* params) {
  auto& system = *static_cast<CoulombIntegration::System*>(params);
  ++system.evaluations;
  derivative(system, y, f);
  return GSL_SUCCESS;
}

/// By central differences: good to 1e-10, which is plenty for Newton's iterations.
int jacobian(double, const double y[], double* dfdy, double dfdt[], void* params) {
  const auto& system = *static_cast<const CoulombIntegration::System*>(params);
  for (std::size_t j = 0; j < 4; ++j) {
    Y low, high, f_low, f_high;
    std::copy_n(y, 4, low.begin());
    high = low;
    const double h = 6e-6 * (1.0 + std::abs(y[j]));
    low[j] -= h, high[j] += h;
    derivative(system, low.data(), f_low.data());
    derivative(system, high.data(), f_high.data());
    for (std::size_t i = 0; i < 4; ++i) dfdy[4 * i + j] = (f_high[i] - f_low[i]) / (2.0 * h);
  }
  std::fill_n(dfdt, 4, 0.0);
  return GSL_SUCCESS;
}

/// mu N - sign F of a rolling hoop and its rate in time.
Sample<double> hold(const Hoop<double>& hoop, double mu, double sign, const Y& y) {
  const Trig<double> phi = trig(y[0]);
  const double w = y[1], a = angular_acceleration(hoop, phi, w);
  const double N = normal_force(hoop, phi, w, a), F = friction_force(hoop, phi, w, a);
  // raised by some roundings, as stick_guards are
  const double slack = 32.0 * std::numeric_limits<double>::epsilon() *
                       (mu * std::abs(N) + std::abs(F) + std::abs(hoop.sin_slope));
  return {mu * N - sign * F + slack,
          mu * normal_force_rate(hoop, phi, w, a) - sign * friction_force_rate(hoop, phi, w, a)};
}

/// n0 of a sliding hoop and its rate.
Sample<double> lift(const CoulombIntegration::System& system, const Y& y, const Y& f) {
  const Trig<double> phi = trig(y[0]);
  return {free_normal_force(system.hoop, phi, y[1] * y[1]),
          y[1] * free_normal_force_rate(system.hoop, phi, y[1] * y[1], f[1])};
}

/// Ic + rho s q and its rate.
Sample<double> pivot(const CoulombIntegration::System& system, const Y& y) {
  const Sample<double> by_angle = pivot_by_angle(system.hoop, trig(y[0]), system.friction);
  return {by_angle.value, y[1] * by_angle.rate};
}

CoulombIntegration::Guard guard_of_runway(double runway) {
  return {[runway](const Y& y) {
            return Sample<double>{runway - std::abs(y[3]), -std::copysign(y[2] + y[1], (y[2] + y[1]) * y[3])};
          },
          PhaseEnd::runway_ends};
}

ContactState<double> state_of(double time, const Y& y) { return {time, y[3], y[0], y[1], y[2]}; }

}  // namespace

CoulombIntegration::CoulombIntegration(const IntegrationOptions& options)
    : options_(options),
      integrator_(*options.stepper, options.control, {&right_hand_side, &jacobian, 4, &system_}) {}

/// Steps until one of the guards falls; the first of them wins.
PhaseEnd CoulombIntegration::follow(Phase phase, int direction, ContactState<double>& at,
                                    std::span<const Guard> guards, const StepObserver& step_told) {
  const Y start{at.angle, at.spin, at.slip, at.travel};
  const double began = at.time;
  const auto sample = [&](std::size_t g, const Y& y) { return guards[g].sample(y); };
  const auto angle = [](const Y& y) { return y[0]; };
  guarded_.begin(start, guards.size(), sample);
  if (!integrator_.start(start, 0.01 / (1.0 + std::abs(at.spin)))) return PhaseEnd::failed;
  for (;;) {
    if (++steps_ > options_.max_steps || guarded_.take(integrator_, angle, 8.0, sample) != Stepped::taken)
      return PhaseEnd::failed;
    const Step<4>& step = integrator_.step();
    const Event<4>* first = guarded_.events().empty() ? nullptr : &guarded_.events().front();
    if (step_told)
      step_told(phase, direction, state_of(began + step.t0, step.y0), first ? first->tau : step.h,
                [&](double tau, ContactState<double>& state) {
                  Y y;
                  const bool taken = integrator_.retake(tau, y);
                  state = state_of(began + step.t0 + tau, y);
                  return taken;
                });
    if (first) {
      at = state_of(began + step.t0 + first->tau, first->state);
      return guards[first->guard].end;
    }
  }
}

PhaseEnd CoulombIntegration::roll(const Hoop<double>& hoop, const Contact<double>& contact,
                                  ContactState<double>& at, double runway, const StepObserver& step_told) {
  system_.hoop = hoop, system_.friction = rolls;
  const double sets_out = setting_out(hoop, at.angle, trig(at.angle), at.spin);
  if (sets_out == 0.0) return PhaseEnd::stalls;
  double way = std::copysign(1.0, sets_out);
  const Guard downhill{[&](const Y&y) { return hold(hoop, contact.mu_static, 1.0, y); },
                       PhaseEnd::slips_backwards},
      uphill{[&](const Y&y) { return hold(hoop, contact.mu_static, -1.0, y); }, PhaseEnd::slips_forwards},
      spin{[&](const Y&y) {
             return Sample<double>{way * y[1], way * angular_acceleration(hoop, trig(y[0]), y[1])};
           },
           PhaseEnd::stalls};
  for (const Guard& guard : {downhill, uphill})  // what has fallen at the start is no fall of a step
    if (has_fallen(guard.sample(Y{at.angle, at.spin, at.slip, at.travel}))) return guard.end;
  const std::array guards{downhill, uphill, spin, guard_of_runway(runway)};
  for (int turned = 0;; way = -way) {
    const PhaseEnd end = follow(Phase::rolling, 0, at, guards, step_told);
    if (end != PhaseEnd::stalls) return end;
    at.spin = 0.0;
    if (hoop.resistance != 0.0 || ++turned == 2) return end;
  }
}

PhaseEnd CoulombIntegration::slide(const Hoop<double>& hoop, const Contact<double>& contact,
                                   ContactState<double>& at, double runway, int direction,
                                   const StepObserver& step_told) {
  const double sign = direction, way = std::copysign(1.0, hoop.resistance);
  system_.hoop = hoop, system_.friction = sign * contact.mu_kinetic;
  if (!(pivot(system_, {at.angle, at.spin}).value > 0.0)) return PhaseEnd::indeterminate;
  const auto rates = [&](const Y& y) {
    Y f;
    derivative(system_, y.data(), f.data());
    return f;
  };
  const std::array guards{Guard{[&](const Y& y) { return lift(system_, y, rates(y)); }, PhaseEnd::lifts_off},
                          Guard{[&](const Y& y) {
                                  return Sample<double>{sign * y[2], sign * rates(y)[2]};
                                },
                                PhaseEnd::slip_ends},
                          guard_of_runway(runway),
                          Guard{[&](const Y& y) { return pivot(system_, y); }, PhaseEnd::indeterminate},
                          Guard{[&](const Y& y) {
                                  return Sample<double>{way * y[1], way * rates(y)[1]};
                                },
                                PhaseEnd::reverses}};
  if (hoop.resistance != 0.0) {
    const Y begin{at.angle, at.spin, at.slip, at.travel};
    if (way * at.spin < 0.0 || (at.spin == 0.0 && way * rates(begin)[1] < 0.0)) return PhaseEnd::reverses;
  }
  const std::size_t asked = guards.size() - (hoop.resistance == 0.0 ? 1 : 0);
  const PhaseEnd end = follow(Phase::sliding, direction, at, std::span(guards).first(asked), step_told);
  if (end == PhaseEnd::slip_ends) at.slip = 0.0;
  return end;
}

Outcome CoulombIntegration::solve(Start start, const Design& design, ContactState<double>& from,
                                  const Scene& scene, const CoulombObserver& observer,
                                  const StepObserver& step_told) {
  steps_ = 0;
  return go_through_phases<double>(
      start, design, from, scene, observer,
      [&](const Hoop<double>& hoop, const Contact<double>& contact, ContactState<double>& at, double runway) {
        return roll(hoop, contact, at, runway, step_told);
      },
      [&](const Hoop<double>& hoop, const Contact<double>& contact, ContactState<double>& at, double runway,
          int direction) { return slide(hoop, contact, at, runway, direction, step_told); });
}

}  // namespace leapmap
