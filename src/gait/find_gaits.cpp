// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "gait/return_map.hpp"
#include "leapmap/gait.hpp"
#include "model/parameters.hpp"
#include "numerics/root.hpp"
#include "physics/flight_search.hpp"
#include "physics/landing.hpp"
#include "physics/rolling_by_angle.hpp"

namespace leapmap {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi, nan = std::numeric_limits<double>::quiet_NaN();
constexpr double finest = 1e-7;  // of the scan [rad]
constexpr double agrees = 1e-3;  // of the cubic with what is between [rad]
constexpr int first_angles = 720;

/// Some returns of the map from one angle.
struct Sampled {
  double angle;
  double height = nan;
  Landed landed{};                      ///< of the jump from there
  std::vector<double> next{}, slope{};  ///< after 1, 2, ... jumps, as far as it comes
};

/// The return map of one hoop on the curve N = 0, on one side of the spin.
class Section {
 public:
  Section(const Design& design, const Scene& scene, double tolerance, double way, int returns)
      : design_(design),
        scene_(scene),
        hoop_(derive<double>(design)),
        duals_(model_of(scene).dual_jumps(scene, tolerance)),
        way_(way),
        returns_(returns) {}

  Sampled at(double angle) const {
    using D = DesignDual;
    Sampled sampled{angle};
    const std::optional<double> spin = lift_off_spin(angle);
    if (!spin) return sampled;
    const Flight<double> flight = fly(hoop_, LiftOff<double>{0.0, angle, *spin});
    if (!(flight.height >= scene_.hop_height)) return sampled;
    sampled.height = flight.height;

    const Hoop<D> hoop = derive(parameters_along(design_, Along::state));
    ContactState<D> dual{.angle = D::parameter(angle, 0), .spin = dual_spin(hoop, angle)};
    const FlightDual<D> flown =
        with_derivatives(hoop, trig(dual.angle), dual.spin, D(0.0), flight.apex_time, flight.flight_time);
    dual = after_flight(hoop, dual, flown.flight_time);
    dual.spin = spin_after_holding(hoop, trig(dual.angle), dual.slip + dual.spin, dual.normal, dual.spin);
    dual.slip = dual.normal = D(0.0);
    set_values(dual, reduced(plain(dual)));
    sampled.landed = plain(dual);
    for (int k = 0; k < returns_; ++k) {
      const double landed = dual.angle.value;
      D lift_off(nan);
      const auto note = [&](double Outcome::*quantity, const D& value, double) {
        if (quantity == &Outcome::jump_angle) lift_off = value;
      };
      const Outcome outcome = duals_(Start::landing, design_, Along::state, dual, note);
      if (outcome.status != Status::jumped || is_beyond(scene_, plain(dual))) break;
      const bool again_at_once = lift_off.value == landed,
                 other_way = lift_off.value == lift_off.value && outcome.jump_spin * way_ < 0.0;
      const bool on_section = !again_at_once && !other_way;
      sampled.next.push_back(on_section ? within_a_turn(lift_off.value) : nan);
      sampled.slope.push_back(on_section ? lift_off.by[0] : nan);
      set_values(dual, reduced(plain(dual)));
    }
    return sampled;
  }

 private:
  static double within_a_turn(double angle) { return angle - two_pi * std::floor(angle / two_pi); }

  /// E at N = 0: P J + rho K E = 0.
  template <class T>
  T vis_viva_at_lift_off(const Hoop<T>& hoop, const Trig<T>& phi) const {
    const LiftTerms<T> terms = lift_terms(hoop, phi);
    return -(terms.P * terms.J) / (hoop.rho * terms.K);
  }

  /// Nothing where N does not fall through zero.
  std::optional<double> lift_off_spin(double angle) const {
    const Trig<double> phi = trig(angle);
    const double E = vis_viva_at_lift_off(hoop_, phi);
    if (!(E > 0.0) || !std::isfinite(E)) return std::nullopt;
    const Sample<double> G = lift(hoop_, lift_terms(hoop_, phi), E, 2.0 * torque(hoop_, phi));
    if (!(G.rate * way_ < 0.0)) return std::nullopt;
    return way_ * std::sqrt(E / contact_inertia(hoop_, phi));
  }
  DesignDual dual_spin(const Hoop<DesignDual>& hoop, double angle) const {
    const Trig<DesignDual> phi = trig(DesignDual::parameter(angle, 0));
    return DesignDual(way_) * sqrt(vis_viva_at_lift_off(hoop, phi) / contact_inertia(hoop, phi));
  }

  const Design& design_;
  const Scene& scene_;
  Hoop<double> hoop_;
  DualJumpSolver duals_;
  double way_;
  int returns_;
};

/// next - angle of the k-th return, the shorter way round.
double gap(const Sampled& sampled, std::size_t k) {
  return std::remainder(sampled.next[k] - sampled.angle, two_pi);
}

bool returns(const Sampled& sampled, std::size_t k) {
  return k < sampled.next.size() && std::isfinite(sampled.next[k]) && std::isfinite(sampled.slope[k]);
}

/// Whether the cubic between a and b foretells every return at `middle`; where neither end returns there is
/// nothing to foretell.
bool is_foretold(const Sampled& a, const Sampled& middle, const Sampled& b, int count) {
  const double length = b.angle - a.angle;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const bool there = returns(a, k);
    if (returns(b, k) != there || returns(middle, k) != there) return false;
    if (!there) continue;
    const double fa = gap(a, k), fb = fa + std::remainder(gap(b, k) - fa, two_pi);
    const double told = 0.5 * (fa + fb) + length * (a.slope[k] - b.slope[k]) / 8.0;
    if (std::abs(std::remainder(gap(middle, k) - told, two_pi)) > agrees) return false;
  }
  return true;
}

class Search {
 public:
  Search(const Design& design, const Scene& scene, const GaitOptions& options)
      : design_(design), options_(options), scene_(scene), map_(scene, options.tolerance) {}

  Gaits run() {
    for (const double way : {1.0, -1.0}) {
      const Section section(design_, scene_, options_.tolerance, way, options_.most_period);
      Sampled left = section.at(0.0);
      keep(left, way);
      for (int i = 1; i <= first_angles; ++i) {
        const Sampled right = section.at(two_pi * i / first_angles);
        look_between(section, left, right, way);
        left = right;
      }
    }
    std::ranges::sort(found_.gaits, [](const Gait& a, const Gait& b) {
      return a.jumps.size() != b.jumps.size() ? a.jumps.size() < b.jumps.size() : a.height < b.height;
    });
    return std::move(found_);
  }

 private:
  void keep(const Sampled& sampled, double way) {
    const bool there = !sampled.next.empty();
    found_.returns.push_back({sampled.angle, there ? sampled.next[0] : nan, there ? sampled.slope[0] : nan,
                              sampled.height, way < 0.0});
  }

  void look_between(const Section& section, const Sampled& a, const Sampled& b, double way) {
    const Sampled middle = section.at(0.5 * (a.angle + b.angle));
    if (is_foretold(a, middle, b, options_.most_period)) {
      for (const auto& [from, to] : {std::pair(&a, &middle), std::pair(&middle, &b)}) {
        look_for_orbits(section, *from, *to);
        keep(*to, way);
      }
    } else if (b.angle - a.angle < finest) {
      keep(b, way);
    } else {
      look_between(section, a, middle, way);
      look_between(section, middle, b, way);
    }
  }

  /// An orbit is where a return meets its own angle: between ends of either side, or where the cubic turns to
  /// it.
  void look_for_orbits(const Section& section, const Sampled& a, const Sampled& b) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(options_.most_period); ++k) {
      if (!returns(a, k) || !returns(b, k)) continue;
      const double fa = gap(a, k), fb = gap(b, k);
      if (std::abs(fa - fb) > std::numbers::pi) continue;  // the shorter way round changes there
      if ((fa > 0.0) != (fb > 0.0)) {
        const auto gap_at = [&](double angle) {
          const Sampled there = section.at(angle);
          return returns(there, k) ? Sample<double>{gap(there, k), there.slope[k] - 1.0}
                                   : Sample<double>{nan, nan};
        };
        const double root = polish_root(gap_at, a.angle, b.angle, 0.5 * (a.angle + b.angle), fb > 0.0, 1e-13);
        if (const Sampled there = section.at(root); returns(there, k))
          close(there.landed, static_cast<int>(k) + 1);
      } else if (std::min(std::abs(fa), std::abs(fb)) <
                 0.5 * (b.angle - a.angle) * (2.0 + std::abs(a.slope[k]) + std::abs(b.slope[k]))) {
        for (const Sampled* near : {&a, &b})  // it may turn to the diagonal and back
          close(near->landed, static_cast<int>(k) + 1);
      }
    }
  }

  void close(const Landed& near, int period) {
    Orbit orbit;
    if (!map_.close(design_, period, near, orbit)) return;
    for (const Orbit& known : orbits_) {
      if (known.landings.size() != orbit.landings.size()) continue;
      for (const Landed& landing : known.landings)
        if (between(landing, orbit.landings.back()).lpNorm<Eigen::Infinity>() < 1e-7) return;
    }
    orbits_.push_back(orbit);
    found_.gaits.push_back({orbit.jumps, orbit.multiplier, orbit.height, orbit.speed, orbit.energy_lost});
  }

  const Design& design_;
  GaitOptions options_;
  Scene scene_;
  ReturnMap map_;
  std::vector<Orbit> orbits_;
  Gaits found_;
};

}  // namespace

Gaits find_gaits(const Design& design, const Scene& scene, const GaitOptions& options) {
  check_scene(scene);
  check_design(design, scene);
  if (scene.friction != Friction::sticking)
    throw InputError(
        "friction: the return map of a hoop that slips has more than one dimension; allowed: friction = "
        "\"sticking\", or [gait] for the gait that a release settles on");
  if (options.most_period < 1 || options.most_period > 16)
    throw InputError(fmt::format("most_period = {} is out of range; allowed: a whole number in [1, 16]",
                                 options.most_period));
  if (!(options.tolerance > 0.0 && options.tolerance <= 0.1))
    throw InputError(
        fmt::format("tolerance = {} is out of range; allowed: a number in (0, 0.1]", options.tolerance));
  Scene each = scene;
  each.jumps = 1, each.settle = 0;
  return Search(design, each, options).run();
}

}  // namespace leapmap
