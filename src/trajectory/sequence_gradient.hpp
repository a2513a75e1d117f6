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
template <class D>
using PutDual = std::function<void(double Outcome::*quantity, const D& value, double unit)>;

/// Takes a design from a state with derivatives to just after the landing of its next jump, whose quantities
/// it puts if `put` is set, and returns the outcome. Derivatives that are infinite or not known are NaN from
/// there on. DesignDual: by the design's parameters, in the order of `differentiable`; those of times need
/// `put`. StateDual: by whatever the duals of the state that it begins at mean, the design being constant;
/// the state's time has none, and times since the release are not put. Owns its workspace: one a thread.
template <class D>
using DualJumpSolver =
    std::function<Outcome(Start, const Design&, ContactState<D>& at, const PutDual<D>& put)>;

template <class D>
ContactState<double> plain(const ContactState<D>& at) {
  return {at.time.value, at.travel.value, at.angle.value,           at.spin.value,
          at.slip.value, at.normal.value, at.turned_in_flight.value};
}
/// Takes over values that somebody knows better.
template <class D>
void set_values(ContactState<D>& at, const ContactState<double>& known) {
  at.time.value = known.time, at.travel.value = known.travel, at.angle.value = known.angle;
  at.spin.value = known.spin, at.slip.value = known.slip, at.normal.value = known.normal;
  at.turned_in_flight.value = known.turned_in_flight;
}

/// The first parameters of a design: constants for a StateDual.
template <class D>
std::array<D, without_slip> parameters_for(const Design& design) {
  if constexpr (is_by_design<D>) {
    return dual_parameters<D>(design);
  } else {
    std::array<D, without_slip> parameters;
    for (std::size_t k = 0; k < parameters.size(); ++k) parameters[k] = D(design.*differentiable[k]);
    return parameters;
  }
}

inline ContactState<DesignDual> dual_release(const Design& design) {
  const auto parameters = dual_parameters<DesignDual>(design);
  return {.angle = parameters[by_release_angle], .spin = parameters[by_release_spin]};
}

/// Whole sequences with the derivatives of every jump: `first` has those of the first one, jumps the
/// outcomes.
inline GradientSolver in_sequence(GradientSolver first, JumpSolver<double> jumps,
                                  DualJumpSolver<DesignDual> duals, const Scene& scene) {
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
        if (duals(start, designs[i], at, put).status != Status::jumped) break;
      }
    }
  };
}

}  // namespace leapmap
