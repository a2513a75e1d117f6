// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/way.hpp"

#include <memory>
#include <utility>

#include "coulomb/model.hpp"
#include "coulomb/recorded_way.hpp"

namespace leapmap {
namespace {

/// Follows a slide, panel after panel as the solver took them.
class SlideMeter {
 public:
  SlideMeter(const SlidingPanels<double>& panels, const Hoop<double>& hoop, double friction,
             const ContactState<double>& from, WayMeter& meter)
      : panels_(panels), slide_{hoop, friction, {}, {}, {}}, at_(from), meter_(meter) {
    slide_.free_force = free_normal_force(hoop, trig(at_.angle), at_.spin * at_.spin);
  }

  void follow(const SlidingPanels<double>::Taken& taken) {
    SlidingPanels<double>::Panel panel, part;
    if (taken.stretch)
      panels_.solve_by_angle(slide_, at_, *taken.stretch, panel);
    else
      panels_.solve_by_time(slide_, at_, taken.duration, panel);
    meter_.slide([&](double place) {
      if (place == 0.0) return forces(at_);
      if (place == 1.0) return forces(panel.end);
      if (taken.stretch) {
        const auto inside = panels_.state_at(slide_, at_, *taken.stretch, panel, place);
        if (inside.is_sharp) return forces(inside.state);
        auto stretch = *taken.stretch;  // beside the panel's start: a panel of its own
        stretch.span *= place;
        panels_.solve_by_angle(slide_, at_, stretch, part);
      } else {
        panels_.solve_by_time(slide_, at_, place * taken.duration, part);
      }
      return forces(part.end);
    });
    at_ = panel.end;
    slide_.free_force = panel.free_force.end.value;
  }

 private:
  WayMeter::Sliding forces(const ContactState<double>& at) const {
    return {sliding_motion(slide_.hoop, trig(at.angle), at.spin * at.spin, slide_.friction).normal_force,
            at.spin};
  }

  const SlidingPanels<double>& panels_;
  SlidingPanels<double>::Slide slide_;
  ContactState<double> at_;
  WayMeter& meter_;
};

/// Up to the lift-off that is the jump, or to the end of the motion.
Way way_of(const RecordedWay& recorded, const Hoop<double>& hoop, const Contact<double>& contact,
           const SlidingPanels<double>& panels, bool jumps) {
  WayMeter meter(hoop);
  std::size_t flight = 0, slide = 0;
  for (std::size_t k = 0; k < recorded.phases.size(); ++k) {
    const RecordedWay::Begun& begun = recorded.phases[k];
    const bool last = k + 1 == recorded.phases.size();
    if (last && jumps) break;
    const ContactState<double>& end = last ? recorded.end : recorded.phases[k + 1].at;
    if (begun.phase == Phase::rolling) {
      const Roll<double> roll = begin_roll(hoop, begun.at.angle, begun.at.spin);
      double from = begun.at.angle;
      for (const double turn : begun.turns) meter.roll(roll, std::exchange(from, turn), turn);
      meter.roll(roll, from, end.angle);
    } else if (begun.phase == Phase::sliding) {
      if (slide == recorded.slides.size()) break;  // it rocks to rest, which nobody followed
      SlideMeter slides(panels, hoop, contact.mu_kinetic * begun.direction, begun.at, meter);
      for (const auto& taken : recorded.slides[slide]) slides.follow(taken);
      ++slide;
      meter.turn(end.angle - begun.at.angle);
    } else {
      meter.fly(begun.at.spin, recorded.flights[flight++].flight_time);
    }
  }
  return meter.way();
}

}  // namespace

namespace coulomb {

Solver ways(const Scene& scene, double tolerance) {
  return [scene, solver = std::make_shared<CoulombSolver<double>>(tolerance),
          panels = std::make_shared<SlidingPanels<double>>(tolerance)](std::span<const Design> designs,
                                                                       std::span<Outcome> outcomes) {
    RecordedWay recorded;
    for (std::size_t i = 0; i < designs.size(); ++i) {
      ContactState<double> at = released<double>(designs[i]);
      if (outcomes[i].status != Status::jumped) continue;
      const Outcome again = recorded_way(*solver, Start::release, designs[i], at, scene, recorded);
      if (same_flags(again, outcomes[i]))
        keep(way_of(recorded, reduce<double>(designs[i], scene), contact_of<double>(designs[i], scene),
                    *panels, true),
             outcomes[i]);
    }
  };
}

}  // namespace coulomb
}  // namespace leapmap
