// SPDX-License-Identifier: GPL-3.0-or-later
/// GSL's ordinary differential equation steppers (gsl_odeiv2) one accepted step at a time.
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <span>
#include <string_view>

#include "numerics/events.hpp"

namespace leapmap {

/// One of gsl_odeiv2's steppers.
struct GslStepper {
  std::string_view name;  ///< as in a spec, for example "gsl-rk8pd"
  const gsl_odeiv2_step_type* type;
  bool implicit;   ///< uses the Jacobian
  bool multistep;  ///< carries history, so that a step cannot be retaken in part by the same stepper
  int order;  ///< of its error at fixed steps (rk2 goes on with the third-order result of its pair); 0: it
              ///< varies
};

/// Every stepper of gsl_odeiv2, in the order of GSL's manual.
std::span<const GslStepper> gsl_steppers();

/// The stepper of that name, or nullptr.
const GslStepper* find_gsl_stepper(std::string_view name);

/// How steps are chosen. Adaptive steps keep each component's error below absolute + relative |y|.
struct StepControl {
  double relative = 1e-10;
  double absolute = 1e-10;
  double fixed_step = 0.0;  ///< > 0: every step this long, errors unchecked [same unit as time]
};

/// Turns GSL's aborting error handler off, once and for the whole process. Return codes are read instead.
void silence_gsl();

/// Owns GSL's workspaces for one system of dimension D; allocated once per thread, restarted for each
/// solution.
template <std::size_t D>
class GslIntegrator {
 public:
  /// The system's params must outlive this object. Throws std::bad_alloc if GSL cannot allocate.
  GslIntegrator(const GslStepper& stepper, const StepControl& control, const gsl_odeiv2_system& system)
      : system_(system), fixed_step_(control.fixed_step) {
    silence_gsl();
    driver_.reset(
        gsl_odeiv2_driver_alloc_y_new(&system_, stepper.type, 1e-3, control.absolute, control.relative));
    // A multistep method cannot retake part of a step from its start alone. The eighth-order Runge-Kutta pair
    // does it instead: over one multistep step its error is far below the multistep method's own.
    const GslStepper& retaker = stepper.multistep ? *find_gsl_stepper("gsl-rk8pd") : stepper;
    retaker_.reset(
        gsl_odeiv2_driver_alloc_y_new(&system_, retaker.type, 1e-3, control.absolute, control.relative));
    if (!driver_ || !retaker_) throw std::bad_alloc();
  }
  GslIntegrator(const GslIntegrator&) = delete;
  GslIntegrator& operator=(const GslIntegrator&) = delete;

  /// Starts a new solution at (0, y); first_step is only a guess when steps are adaptive.
  bool start(const State<D>& y, double first_step) {
    step_ = {};
    step_.y1 = y;
    trial_step_ = fixed_step_ > 0.0 ? fixed_step_ : first_step;
    time_ = 0.0;
    return gsl_odeiv2_driver_reset(driver_.get()) == GSL_SUCCESS && derivative(0.0, y, step_.f1);
  }

  /// Takes one step, then available as step(). False: GSL gave up, or the state is no longer finite.
  bool advance() {
    step_.t0 = time_;
    step_.y0 = step_.y1;
    step_.f0 = step_.f1;
    gsl_odeiv2_driver& d = *driver_;
    const int status = fixed_step_ > 0.0 ? gsl_odeiv2_evolve_apply_fixed_step(
                                               d.e, nullptr, d.s, d.sys, &time_, fixed_step_, step_.y1.data())
                                         : gsl_odeiv2_evolve_apply(d.e, d.c, d.s, d.sys, &time_, HUGE_VAL,
                                                                   &trial_step_, step_.y1.data());
    step_.h = time_ - step_.t0;
    if (status != GSL_SUCCESS || !(step_.h > 0.0)) return false;
    for (const double y : step_.y1)
      if (!std::isfinite(y)) return false;
    if (d.s->type->gives_exact_dydt_out) {
      std::copy_n(d.e->dydt_out, D, step_.f1.begin());
      return true;
    }
    return derivative(time_, step_.y1, step_.f1);
  }

  /// Goes on from another state than the one the step last taken came to, which is then y. False: GSL failed.
  bool replace(const State<D>& y) {
    step_.y1 = y;
    return gsl_odeiv2_driver_reset(driver_.get()) == GSL_SUCCESS && derivative(time_, y, step_.f1);
  }

  /// The step last taken.
  const Step<D>& step() const { return step_; }

  /// The state tau after the start of the step last taken, by the method itself. False: GSL failed.
  bool retake(double tau, State<D>& y) const {
    y = step_.y0;
    State<D> error, f;
    if (!(tau > 0.0)) return tau == 0.0;
    if (gsl_odeiv2_step_reset(retaker_->s) != GSL_SUCCESS) return false;
    const double* f0 = retaker_->s->type->can_use_dydt_in ? step_.f0.data() : nullptr;
    return gsl_odeiv2_step_apply(retaker_->s, step_.t0, tau, y.data(), error.data(), f0, f.data(),
                                 &system_) == GSL_SUCCESS;
  }

 private:
  struct FreeDriver {
    void operator()(gsl_odeiv2_driver* driver) const { gsl_odeiv2_driver_free(driver); }
  };

  bool derivative(double t, const State<D>& y, State<D>& f) const {
    return system_.function(t, y.data(), f.data(), system_.params) == GSL_SUCCESS;
  }

  gsl_odeiv2_system system_;
  std::unique_ptr<gsl_odeiv2_driver, FreeDriver> driver_, retaker_;
  double fixed_step_, trial_step_ = 0.0, time_ = 0.0;
  Step<D> step_;
};

}  // namespace leapmap
