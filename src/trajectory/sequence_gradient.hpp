// SPDX-License-Identifier: GPL-3.0-or-later
/// Derivatives through landings: one jump after the other in duals.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "trajectory/gradient.hpp"
#include "trajectory/sequence.hpp"

namespace leapmap {

/// Takes a quantity of a jump with its derivatives, in `unit` of the solver's own.
using PutDual = std::function<void(double Outcome::*quantity, const DesignDual& value, double unit)>;

/// By what a jump is differentiated: the parameters of the design, in the order of `differentiable`, or
/// whatever the duals of the state that it begins at mean, the design being constant.
enum class Along { parameters, state };

/// Takes a design from a state with derivatives to just after the landing of its next jump, whose quantities
/// it puts if `put` is set, and returns the outcome. Derivatives that are infinite or not known are NaN from
/// there on. Owns its workspace: one a thread.
using DualJumpSolver =
    std::function<Outcome(Start, const Design&, Along, ContactState<DesignDual>& at, const PutDual& put)>;

inline ContactState<double> plain(const ContactState<DesignDual>& at) {
  return {at.time.value, at.travel.value, at.angle.value,           at.spin.value,
          at.slip.value, at.normal.value, at.turned_in_flight.value};
}
/// Takes over values that somebody knows better.
inline void set_values(ContactState<DesignDual>& at, const ContactState<double>& known) {
  at.time.value = known.time, at.travel.value = known.travel, at.angle.value = known.angle;
  at.spin.value = known.spin, at.slip.value = known.slip, at.normal.value = known.normal;
  at.turned_in_flight.value = known.turned_in_flight;
}

/// The first parameters of a design as constants, or as duals of themselves.
inline std::array<DesignDual, without_slip> parameters_along(const Design& design, Along along) {
  std::array<DesignDual, without_slip> parameters = dual_parameters<DesignDual>(design);
  if (along == Along::state)
    for (DesignDual& parameter : parameters) parameter = DesignDual(parameter.value);
  return parameters;
}

inline ContactState<DesignDual> dual_release(const Design& design) {
  const auto parameters = dual_parameters<DesignDual>(design);
  return {.angle = parameters[by_release_angle], .spin = parameters[by_release_spin]};
}

/// Whole sequences with the derivatives of every jump: `first` has those of the first one, jumps the
/// outcomes.
inline GradientSolver in_sequence(GradientSolver first, JumpSolver<double> jumps, DualJumpSolver duals,
                                  const Scene& scene) {
  return [first = std::move(first), duals = std::move(duals), scene,
          sequences = std::make_shared<Sequences<double>>(std::move(jumps))](
             std::span<const Design> designs, std::span<Outcome> outcomes, Gradients& gradients) {
    first(designs, outcomes, gradients);
    sequences->solve(designs, scene, outcomes);
    std::size_t last = 1;
    for (const OutcomeNumber& wanted : gradients.wanted().of) last = std::max(last, wanted.jump);
    if (last == 1) return;  // `first` has put all that is asked for
    for (std::size_t i = 0; i < designs.size(); ++i) {
      ContactState<DesignDual> at = dual_release(designs[i]);
      for (std::size_t jump = 1; jump <= std::min(last, outcomes[i].jumps()); ++jump) {
        const auto put = [&](double Outcome::*quantity, DesignDual value, double unit) {
          const auto of = later_member(quantity);
          if (jump == 1 || !of) return;
          if (kinetic_follows(designs[i])) value.by[by_mu_kinetic] = std::numeric_limits<double>::quiet_NaN();
          gradients.put(OutcomeNumber(of, jump), i, value, unit);
        };
        const Start start = jump == 1 ? Start::release : Start::landing;
        if (duals(start, designs[i], Along::parameters, at, put).status != Status::jumped) break;
      }
    }
  };
}

}  // namespace leapmap
