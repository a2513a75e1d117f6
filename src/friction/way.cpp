// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/way.hpp"

#include <memory>

#include "friction/model.hpp"
#include "friction/panel_forces.hpp"
#include "friction/recorded_way.hpp"

namespace leapmap {
namespace {

/// Up to the lift-off that is the jump.
Way<double> way_of(const RecordedWay& recorded, const Hoop<double>& hoop, const Contact<double>& contact,
                   const SlidingPanels<double>& panels) {
  WayMeter<double> meter(hoop, recorded.phases.front().at.spin);
  std::size_t flight = 0, slide = 0;
  for (std::size_t k = 0; k + 1 < recorded.phases.size(); ++k) {
    const RecordedWay::Begun& begun = recorded.phases[k];
    const ContactState<double>& end = recorded.phases[k + 1].at;
    if (begun.phase == Phase::rolling) {
      meter.roll(begin_roll(hoop, begun.at.angle, begun.at.spin), begun.at.spin, begun.turns, end.angle);
    } else if (begun.phase == Phase::sliding) {
      SlidingPanels<double>::Slide about{hoop, contact.mu_kinetic * begun.direction, {}, {}, {}};
      ContactState<double> at = begun.at;
      about.free_force = free_normal_force(hoop, trig(at.angle), at.spin * at.spin);
      for (const auto& taken : recorded.slides[slide]) {
        SlidingPanels<double>::Panel panel;
        panels.solve(about, at, taken, panel);
        const PanelForces<double> forces(panels, about, at, taken, panel);
        meter.slide([&](double place) { return forces.rated_at(place); },
                    [&](double place) { return forces.at(place); });
        at = panel.end, about.free_force = panel.free_force.end.value;
      }
      ++slide;
      meter.turn(end.angle - begun.at.angle);
    } else {
      meter.fly(begun.at.spin, recorded.flights[flight++].flight_time);
    }
  }
  return meter.way();
}

}  // namespace

namespace friction {

JumpSolver<double> ways(const Scene& scene, double tolerance) {
  return [scene, solver = std::make_shared<CoulombSolver<double>>(tolerance),
          panels = std::make_shared<SlidingPanels<double>>(tolerance)](
             Start start, std::span<const Design> designs, std::span<ContactState<double>> states,
             std::span<Outcome> outcomes) {
    for (std::size_t i = 0; i < designs.size(); ++i) {
      RecordedWay recorded;
      outcomes[i] = recorded_way(*solver, start, designs[i], states[i], scene, recorded);
      if (outcomes[i].status != Status::jumped) continue;
      put_way(
          way_of(recorded, reduce<double>(designs[i], scene), contact_of<double>(designs[i], scene), *panels),
          [&](double Outcome::*kept, double number) { outcomes[i].*kept = number; });
    }
  };
}

}  // namespace friction
}  // namespace leapmap
