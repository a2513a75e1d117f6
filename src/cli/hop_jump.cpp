// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/hop_jump.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "cli/output.hpp"
#include "model/own_units.hpp"
#include "trajectory/later_jump.hpp"

namespace leapmap::cli {
namespace {

/// How many jumps there are, and why no more.
std::string sequence_line(const Spec& spec, const Outcome& outcome) {
  const std::string heights = [&] {
    std::string text = fmt::format("{:.6f}", outcome.jump_height);
    for (const Jump& jump : outcome.later_jumps) text += fmt::format(", {:.6f}", jump.height);
    return text;
  }();
  const std::string_view end = outcome.sequence_end == Status::jumped    ? "all requested"
                               : outcome.sequence_end == Status::no_jump ? "then it reaches the rolling limit"
                               : outcome.sequence_end == Status::stalled ? "then it is trapped"
                               : outcome.sequence_end == Status::indeterminate
                                   ? "then the rigid-body equations have no solution or two"
                                   : "then the method failed";
  return fmt::format("{} jumps of {}: {} diameters; {}.", outcome.jumps(), spec.scene.jumps, heights, end);
}

/// "0.2515 N s", or in leapmap's own unit where no mass is known.
std::string with_mass(double value, int digits, std::string_view own, std::string_view si,
                      const Scene& scene) {
  const OwnUnit& unit = *find_own_unit(own);
  return scene.mass > 0.0 ? fmt::format("{:.{}g} {}", value * unit.size(scales_of(scene)), digits, si)
                          : fmt::format("{:.{}g} {}", value, digits, own);
}

void print_wall(const Scene& scene, const Outcome& jump, const std::string& which) {
  const double wall = scene.radius * wall_in_radii(scene, 1.0);
  if (std::isnan(jump.clears_from))
    say("{} clears no wall of {:.4g} m.\n", which, wall);
  else
    say("{} clears a wall of {:.4g} m that stands {:.4g} m to {:.4g} m from the lift-off along the plane.\n",
        which, wall, jump.clears_from * scene.radius, jump.clears_to * scene.radius);
}

/// A jump after the first, in a line, and the wall in another.
void print_later(const Scene& scene, const Jump& later, std::size_t number) {
  Outcome jump;
  for (const JumpRow& row : jump_rows) jump.*row.first = later.*row.later;
  say("Jump {}: {:.6f} diameters ({:.4g} m), flies {:.4g} m along the plane, lands with {:.4g} m/s towards "
      "it, impulse {}, {} lost.\n",
      number, jump.jump_height, 2.0 * scene.radius * jump.jump_height, jump.jump_range * scene.radius,
      jump.landing_normal_speed * std::sqrt(scene.gravity * scene.radius),
      with_mass(jump.landing_impulse, 4, "(m + m_p) sqrt(g R)", "N s", scene),
      with_mass(jump.landing_energy_lost, 4, "(m + m_p) g R", "J", scene));
  if (scene.clear_height > 0.0) print_wall(scene, jump, fmt::format("Jump {}", number));
}

}  // namespace

void print_jump(const Spec& spec, const Outcome& jump) {
  if (jump.status == Status::jumped) {
    say("Height {:.6f} diameters ({:.4g} m), apex {:.6f} s and landing {:.6f} s after lift-off",
        jump.jump_height, 2.0 * spec.scene.radius * jump.jump_height, jump.apex_time, jump.flight_time);
    if (jump.dip < 0.0) say("; penetration depth {:.4g} diameters", -jump.dip);
    say(".\n");
    const double speed = std::sqrt(spec.scene.gravity * spec.scene.radius);
    say("Flies {:.6g} R ({:.4g} m) along the plane; lands with {:.4g} m/s towards it and {:.4g} m/s along "
        "it, impulse {}, {} lost.\n",
        jump.jump_range, jump.jump_range * spec.scene.radius, jump.landing_normal_speed * speed,
        jump.landing_tangential_speed * speed,
        with_mass(jump.landing_impulse, 4, "(m + m_p) sqrt(g R)", "N s", spec.scene),
        with_mass(jump.landing_energy_lost, 4, "(m + m_p) g R", "J", spec.scene));
    if (jump.landing_impulse < 0.0)
      say("An impulse below zero: to land without slip, the plane would have to pull.\n");
    if (std::isfinite(jump.max_normal_force))
      say("The plane pushes with at most {} until lift-off.\n",
          with_mass(jump.max_normal_force, 4, "(m + m_p) g", "N", spec.scene));
    if (std::isfinite(jump.motor_max_torque))
      say("The motor gives at most {} and {} at up to {:.4g} sqrt(g/R), and {} until lift-off; efficiency "
          "{}.\n",
          with_mass(jump.motor_max_torque, 4, "(m + m_p) g R", "N m", spec.scene),
          with_mass(jump.motor_max_power + 0.0, 4, "(m + m_p) g sqrt(g R)", "W", spec.scene),
          jump.motor_max_spin, with_mass(jump.motor_energy, 4, "(m + m_p) g R", "J", spec.scene),
          std::isfinite(jump.efficiency) ? fmt::format("{:.3g}", jump.efficiency) : "none, for want of work");
    if (spec.scene.clear_height > 0.0)
      print_wall(spec.scene, jump, spec.scene.jumps > 1 ? "The first jump" : "It");
    if (std::isfinite(jump.energy_lost)) {
      say("Slid {:.6g} R, lost {} until lift-off, spin after the landing {:.6g} rad/s.\n", jump.slip_distance,
          with_mass(jump.energy_lost, 6, "(m + m_p) g R", "J", spec.scene),
          jump.landing_spin / time_unit(spec.scene));
    }
  }
  if (spec.scene.jumps == 1 || jump.status != Status::jumped) return;
  say("{}\n", sequence_line(spec, jump));
  for (std::size_t k = 0; k < jump.later_jumps.size(); ++k)
    print_later(spec.scene, jump.later_jumps[k], k + 2);
}

}  // namespace leapmap::cli
