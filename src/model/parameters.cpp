// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/parameters.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace leapmap {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double right_angle = std::numbers::pi / 2.0;
constexpr Range non_negative{0.0, inf, true, false};
constexpr Range positive{1e-9, 1e9};  // a length or an acceleration
constexpr Range ratio{0.0, 1e12};
constexpr Range coefficient{0.0, 1e6};  // of friction: more than any pair of materials has
constexpr Range fraction{0.0, 1.0};

const std::array parameter_table{
    Parameter{"mu_static", &Design::mu_static, "1", "coulomb only: static friction coefficient", coefficient,
              Friction::coulomb, true},
    Parameter{"mu_kinetic", &Design::mu_kinetic, "1",
              "coulomb only: kinetic friction coefficient; if larger than mu_static, mu_static is set to it",
              coefficient, Friction::coulomb, true},
    Parameter{"restitution", &Design::restitution, "1", "coulomb only: Poisson restitution", fraction,
              Friction::coulomb, true},
    Parameter{"rest_speed", &Scene::rest_speed, "sqrt(g R)", "coulomb only: a slower rebound counts as zero",
              non_negative, Friction::coulomb, true},
    Parameter{"runway",
              &Scene::runway,
              "revolutions",
              "rolling limit, at which the search for a jump ends",
              {0.0, 1e6, false, true}},
    Parameter{"hop_height", &Scene::hop_height, "hoop diameters",
              "jump threshold: the first lift-off this high is the jump; 0: any", non_negative},
    Parameter{"clear_height", &Scene::clear_height, "hoop diameters",
              "height of a thin wall to jump over, for clears_from and clears_to; 0: none", non_negative,
              Mechanism::hoop},
    Parameter{"radius", &Scene::radius, "m", "radius R of the hoop; changes units only", positive},
    Parameter{"gravity", &Scene::gravity, "m s-2", "gravitational acceleration g; changes units only",
              positive},
    Parameter{"mass",
              &Scene::mass,
              "kg",
              "total mass m + m_p; changes units of forces, torques and energies only; 0: not known",
              {0.0, 1e9}},
    Parameter{"slope",
              &Design::slope,
              "rad",
              "slope of the plane; negative: uphill",
              {-right_angle, right_angle, false, false}},
    Parameter{"mass_ratio", &Design::mass_ratio, "1", "point mass over hoop mass, m_p / m", ratio},
    Parameter{"offset_ratio", &Design::offset_ratio, "1",
              "distance of the point mass from the centre over the radius, L / R", fraction},
    Parameter{"inertia_factor", &Design::inertia_factor, "1",
              "inertia of the bare hoop over m R^2: thin hoop 1, disc 1/2", ratio},
    Parameter{"release_angle",
              &Design::release_angle,
              "rad",
              "angle phi at release; 0: mass on the plane, 180 deg: mass on top",
              {-1e6, 1e6}},
    Parameter{"release_spin",
              &Design::release_spin,
              "sqrt(g/R)",
              "spin at release, positive downhill",
              {-1e4, 1e4}},
    Parameter{"drive_torque",
              &Design::drive_torque,
              "(m + m_p) g R",
              "motor torque on the hoop, positive downhill; see motor_in_flight",
              {-1e3, 1e3},
              Mechanism::hoop},
    Parameter{"resisting_torque",
              &Design::resisting_torque,
              "(m + m_p) g R",
              "torque against the rotation while the hoop touches the plane: of rolling, or of a bearing",
              {0.0, 1e3},
              Mechanism::hoop},
    Parameter{"pendulum_inertia", &Design::pendulum_inertia, "1",
              "pendulum only: its own inertia, about its centre of mass, over m_p L^2", ratio,
              Mechanism::pendulum},
    Parameter{"pendulum_angle",
              &Design::pendulum_angle,
              "rad",
              "pendulum only: angle psi at release; 0: it points at the plane",
              {-1e6, 1e6},
              Mechanism::pendulum},
    Parameter{"pendulum_spin",
              &Design::pendulum_spin,
              "sqrt(g/R)",
              "pendulum only: its spin at release, not relative to the hoop",
              {-1e4, 1e4},
              Mechanism::pendulum},
    Parameter{"motor_torque",
              &Design::motor_torque,
              "(m + m_p) g R",
              "pendulum only: stall torque of the motor on the pendulum; the hoop takes its reaction",
              {-1e3, 1e3},
              Mechanism::pendulum},
    Parameter{"no_load_speed",
              &Design::no_load_speed,
              "sqrt(g/R)",
              "pendulum only: speed of the pendulum relative to the hoop at which the torque is used up",
              {0.0, inf, false, true, true},
              Mechanism::pendulum},
    Parameter{"motor_target",
              &Design::motor_target,
              "rad or sqrt(g/R)",
              "pendulum only: of motor_law, the angle (until_angle, angle) or the speed (until_speed, speed)",
              {-1e6, 1e6},
              Mechanism::pendulum},
    Parameter{"motor_gain",
              &Design::motor_gain,
              "1",
              "pendulum only: of motor_law, torque per missing speed or angle; inf: as stiff as the motor is",
              {0.0, inf, false, true, true},
              Mechanism::pendulum},
    Parameter{"patience",
              &Scene::patience,
              "sqrt(R/g)",
              "pendulum only: a robot that has neither jumped nor come to the runway's end is stalled then",
              {0.0, 1e6, false, true},
              Mechanism::pendulum},
    Parameter{"motor_damping", &Design::motor_damping, "1",
              "pendulum only: of motor_law angle, torque per spin of the pendulum", non_negative,
              Mechanism::pendulum}};

}  // namespace

bool Range::holds(double value) const {
  if (may_be_infinite && std::isinf(value)) return value == most;
  return std::isfinite(value) && (least_allowed ? value >= least : value > least) &&
         (most_allowed ? value <= most : value < most);
}

std::span<const Parameter> parameters() { return parameter_table; }

}  // namespace leapmap
