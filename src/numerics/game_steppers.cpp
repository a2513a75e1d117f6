// SPDX-License-Identifier: GPL-3.0-or-later
#include "numerics/game_steppers.hpp"

#include <array>
#include <cstdlib>

namespace leapmap {
namespace {

/// A step's state is room for two derivatives of the whole state.
void* allocate(std::size_t dimension) { return std::calloc(2 * dimension, sizeof(double)); }
int reset(void*, std::size_t) { return GSL_SUCCESS; }
int set_driver(void*, const gsl_odeiv2_driver*) { return GSL_SUCCESS; }

int reduce(const gsl_odeiv2_system* system, double t, const double* y, double* f) {
  return system->function(t, y, f, system->params);
}

/// Calls step(n, y, f, g, h): n positions, f the derivative at the start, g room for another.
template <class Step>
int apply(void* state, std::size_t dimension, double t, double h, double y[], double error[],
          double dydt_out[], const gsl_odeiv2_system* system, const Step& step) {
  auto* f = static_cast<double*>(state);
  if (const int status = reduce(system, t, y, f); status != GSL_SUCCESS) return status;
  if (const int status = step(dimension / 2, f, f + dimension); status != GSL_SUCCESS) return status;
  for (std::size_t i = 0; i < dimension; ++i) error[i] = 0.0;
  return dydt_out ? reduce(system, t + h, y, dydt_out) : GSL_SUCCESS;
}

int apply_euler(void* state, std::size_t dimension, double t, double h, double y[], double error[],
                const double*, double dydt_out[], const gsl_odeiv2_system* system) {
  return apply(state, dimension, t, h, y, error, dydt_out, system,
               [&](std::size_t n, const double* f, double*) {
                 for (std::size_t i = 0; i < 2 * n; ++i) y[i] += h * f[i];
                 return int{GSL_SUCCESS};
               });
}

int apply_semi_implicit(void* state, std::size_t dimension, double t, double h, double y[], double error[],
                        const double*, double dydt_out[], const gsl_odeiv2_system* system) {
  return apply(state, dimension, t, h, y, error, dydt_out, system,
               [&](std::size_t n, const double* f, double*) {
                 for (std::size_t i = 0; i < n; ++i) {
                   y[n + i] += h * f[n + i];
                   y[i] += h * y[n + i];
                 }
                 return int{GSL_SUCCESS};
               });
}

int apply_verlet(void* state, std::size_t dimension, double t, double h, double y[], double error[],
                 const double*, double dydt_out[], const gsl_odeiv2_system* system) {
  return apply(state, dimension, t, h, y, error, dydt_out, system, [&](std::size_t n, double* f, double* g) {
    for (std::size_t i = 0; i < n; ++i) {
      y[i] += h * (y[n + i] + 0.5 * h * f[n + i]);
      y[n + i] += h * f[n + i];  // predicted, for the acceleration at the end
    }
    const int status = reduce(system, t + h, y, g);
    for (std::size_t i = 0; i < n; ++i) y[n + i] += 0.5 * h * (g[n + i] - f[n + i]);
    return status;
  });
}

template <unsigned order>
unsigned order_of(void*) {
  return order;
}

}  // namespace

std::span<const GslStepper> game_steppers() {
  static const gsl_odeiv2_step_type euler{"euler",    0,     1,           allocate, apply_euler,
                                          set_driver, reset, order_of<1>, std::free};
  static const gsl_odeiv2_step_type semi_implicit{
      "semi-implicit-euler", 0, 1, allocate, apply_semi_implicit, set_driver, reset, order_of<1>, std::free};
  static const gsl_odeiv2_step_type verlet{"velocity-verlet", 0,     1,           allocate, apply_verlet,
                                           set_driver,        reset, order_of<2>, std::free};
  static const std::array<GslStepper, 3> steppers{{{"euler", &euler, false, false, 1},
                                                   {"semi-implicit-euler", &semi_implicit, false, false, 1},
                                                   {"velocity-verlet", &verlet, false, false, 2}}};
  return steppers;
}

}  // namespace leapmap
