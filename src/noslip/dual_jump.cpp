// SPDX-License-Identifier: GPL-3.0-or-later
/// From a landing to the next in duals, without slip.
#include <memory>

#include "hoop/landing.hpp"
#include "hoop/units.hpp"
#include "noslip/dual_time.hpp"
#include "noslip/exact.hpp"
#include "noslip/lift_off_dual.hpp"
#include "noslip/model.hpp"
#include "trajectory/jump_measures.hpp"

namespace leapmap::noslip {
namespace {

struct Workspace {
  ExactSolver<double> solver;
  DualTime<DesignDual> time{};
};

template <class D>
Outcome jump_on(Workspace& work, const Scene& scene, Start start, const Design& design, ContactState<D>& at,
                const PutDual<D>& put) {
  ContactState<double> landed = plain(at);
  FoundLiftOffs told;
  Outcome outcome;
  work.solver.solve(start, {&design, 1}, {&landed, 1}, scene, {&outcome, 1}, &told);
  if (outcome.status != Status::jumped) return outcome;

  const Hoop<D> hoop = reduce(parameters_for<D>(design), scene);
  const double second = time_unit(scene);
  if (!told.bounces || told.lift_offs.size() > 1) {
    // The same N at every angle, whichever way it rolls.
    const LiftOffDual<D> off = lift_off_at(begin_roll(hoop, at.angle, at.spin), told.lift_offs.back().angle);
    if constexpr (is_by_design<D>)
      if (put)
        at.time +=
            work.time.time(hoop, at.angle, at.spin, std::span(told.turns).first(told.legs.back()), off.angle);
    at.travel += off.angle - at.angle;
    at.angle = off.angle;
    at.spin = told.lift_offs.back().spin < 0.0 ? -off.spin : off.spin;
  }
  const FlightDual<D> flight = with_derivatives(hoop, trig(at.angle), at.spin, D(0.0),
                                                outcome.apex_time / second, outcome.flight_time / second);
  if (put) {
    put_jump(put, at.angle, at.spin, at.travel, flight, second);
    if constexpr (is_by_design<D>) put(&Outcome::jump_time, at.time, second);
    put_measures(measures_of(hoop, at.angle, at.spin, flight.flight_time), D(1.0),
                 [&](double Outcome::*kept, const D& value) { put(kept, value, 1.0); });
  }
  at = after_flight(hoop, at, flight.flight_time);
  at.spin = spin_after_holding(hoop, trig(at.angle), at.slip + at.spin, at.normal, at.spin);
  at.slip = at.normal = D(0.0);
  set_values(at, landed);
  return outcome;
}

template <class D>
DualJumpSolver<D> jumps_in(const Scene& scene, double tolerance) {
  const auto work = std::make_shared<Workspace>(Workspace{ExactSolver<double>(tolerance)});
  return [work, scene](Start start, const Design& design, ContactState<D>& at, const PutDual<D>& put) {
    return jump_on(*work, scene, start, design, at, put);
  };
}

}  // namespace

DualJumpSolver<DesignDual> dual_jumps(const Scene& scene, double tolerance) {
  return jumps_in<DesignDual>(scene, tolerance);
}
DualJumpSolver<StateDual> state_jumps(const Scene& scene, double tolerance) {
  return jumps_in<StateDual>(scene, tolerance);
}

}  // namespace leapmap::noslip
