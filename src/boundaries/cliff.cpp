// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundaries/cliff.hpp"

#include <array>
#include <numbers>

#include "hoop/rolling_by_angle.hpp"
#include "model/model.hpp"

namespace leapmap {
namespace {

/// On either side of a cliff, next to it, what passes a bound is so near it.
constexpr double near_bound = 1e-7;
/// A lift-off born at rounding's distance comes with the normal force falling as slowly as the root of that.
constexpr double touching = 1e-4;

bool is_near(double value, double bound) { return std::abs(value - bound) <= near_bound * (1.0 + bound); }

/// Whether the normal force only just falls where the jump lifts off from rolling.
bool touches(const Design& design, const Outcome& outcome) {
  if (outcome.status != Status::jumped) return false;
  const Hoop<double> hoop = reduce<double>(design);
  const Trig<double> phi = trig(outcome.jump_angle);
  const double spin = outcome.jump_spin;
  return std::abs(normal_force_rate(hoop, phi, spin, angular_acceleration(hoop, phi, spin))) < touching;
}

/// Whether the normal force is zero where the runway ends, either way.
bool ends_the_runway(const Scene& scene, const Design& design) {
  const Hoop<double> hoop = reduce<double>(design);
  const Roll<double> roll = begin_roll(hoop, design.release_angle, design.release_spin);
  const auto touches_at = [&](double angle) {
    const Trig<double> phi = trig(angle);
    const double square = vis_viva(roll, angle, phi) / contact_inertia(hoop, phi);
    if (!(square > 0.0)) return false;
    const double spin = std::sqrt(square);
    const double force = normal_force(hoop, phi, spin, angular_acceleration(hoop, phi, spin));
    return std::abs(force) <= near_bound * (1.0 + hoop.rho * square);
  };
  const double length = 2.0 * std::numbers::pi * scene.runway;
  return touches_at(design.release_angle + length) || touches_at(design.release_angle - length);
}

}  // namespace

std::string_view name_of(CliffKind kind) {
  constexpr std::array<std::string_view, cliff_kinds> names{"threshold", "fold",  "runway",   "turn",
                                                            "release",   "phase", "painleve", "unresolved"};
  return names[static_cast<std::size_t>(kind)];
}

Discrete discrete(const Outcome& outcome, bool phases) {
  // What is not known of a design is no outcome of its own.
  const bool known = outcome.status != Status::failed && outcome.status != Status::indeterminate;
  return {outcome.status, outcome.status == Status::jumped ? outcome.candidates : std::uint8_t{0},
          outcome.spurious_first_jump, phases && known ? outcome.phase_sequence : 0};
}

CliffKind kind_of(const Scene& scene, const Design& below, const Probe& from, const Design& above,
                  const Probe& to) {
  const Outcome &a = from.outcome, &b = to.outcome;
  const auto either = [&](Status status) { return a.status == status || b.status == status; };
  const auto one_has = [&](const auto& property) { return property(a) || property(b); };
  if (either(Status::failed)) return CliffKind::unresolved;
  if (either(Status::indeterminate)) return CliffKind::painleve;
  if (either(Status::airborne_at_release)) return CliffKind::release;
  if (scene.hop_height > 0.0 && one_has([&](const Outcome& o) {
        return is_near(o.jump_height, scene.hop_height) || is_near(o.first_jump_height, scene.hop_height);
      }))
    return CliffKind::threshold;
  const bool slips = model_of(scene).slips, is_hoop = scene.model == Mechanism::hoop;
  if (!slips && is_hoop && (touches(below, a) || touches(above, b))) return CliffKind::fold;
  if (one_has([&](const Outcome& o) {
        return is_near(std::abs(o.jump_distance), 2.0 * std::numbers::pi * scene.runway);
      }))
    return CliffKind::runway;
  if (a.status != b.status && either(Status::stalled)) return CliffKind::turn;
  if (slips) return CliffKind::phase;
  if (!is_hoop) return CliffKind::fold;
  if (a.jump_spin * b.jump_spin < 0.0) return CliffKind::turn;
  return ends_the_runway(scene, below) ? CliffKind::runway : CliffKind::fold;
}

}  // namespace leapmap
