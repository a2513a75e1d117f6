// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "gaits/return_map.hpp"
#include "hoop/flight_search.hpp"
#include "hoop/landing.hpp"
#include "hoop/rolling_by_angle.hpp"
#include "leapmap/gait.hpp"
#include "model/parameters.hpp"
#include "numerics/nan.hpp"
#include "numerics/root.hpp"

namespace leapmap {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr double finest = 1e-7;  // of the scan [rad]
constexpr double agrees = 1e-3;  // of the cubic with what is between [rad]
constexpr int first_angles = 5760;
constexpr std::size_t most_samples = 200'000;  // some seconds

/// Some returns of the map from one angle.
struct Sampled {
  double angle;
  double height = nan;
  Landed landed{};                      ///< of the jump from there
  std::vector<double> next{}, slope{};  ///< after 1, 2, ... jumps, as far as it comes
  /// What becomes of it from the first, second, ... landing on, as a number: it lies on another branch of the
  /// map where that is another.
  std::vector<long> courses{};
};

enum class Course : long { returns, again_at_once, the_other_way, no_jump };

/// The return map of one hoop on the curve N = 0, on one side of the spin.
class Section {
 public:
  Section(const Design& design, const Scene& scene, double tolerance, double way, int returns)
      : design_(design),
        scene_(scene),
        hoop_(reduce<double>(design, scene)),
        duals_(need(model_of(scene), &Model::state_jumps, "derivatives of later jumps")(scene, tolerance)),
        way_(way),
        returns_(returns) {}

  Sampled at(double angle) const {
    using D = StateDual;
    Sampled sampled{angle};
    const std::optional<double> spin = lift_off_spin(angle);
    if (!spin) return sampled;
    const Flight<double> flight = fly(hoop_, LiftOff<double>{0.0, angle, *spin});
    if (!(flight.height >= scene_.hop_height)) return sampled;
    sampled.height = flight.height;

    const Hoop<D> hoop = reduce(parameters_for<D>(design_), scene_);
    ContactState<D> dual{.angle = D::parameter(angle, 0), .spin = dual_spin(hoop, angle)};
    const FlightDual<D> flown =
        with_derivatives(hoop, trig(dual.angle), dual.spin, D(0.0), flight.apex_time, flight.flight_time);
    dual = after_flight(hoop, dual, flown.flight_time);
    dual.spin = spin_after_holding(hoop, trig(dual.angle), dual.slip + dual.spin, dual.normal, dual.spin);
    dual.slip = dual.normal = D(0.0);
    double turned = dual.angle.value;
    set_values(dual, reduced(plain(dual)));
    sampled.landed = plain(dual);
    for (int k = 0; k < returns_; ++k) {
      const double landed = dual.angle.value;
      D lift_off(nan);
      const auto note = [&](double Outcome::*quantity, const D& value, double) {
        if (quantity == &Outcome::jump_angle) lift_off = value;
      };
      const Outcome outcome = duals_(Start::landing, design_, dual, note);
      const bool jumps = outcome.status == Status::jumped && !is_beyond(scene_, plain(dual));
      const Course course = !jumps                           ? Course::no_jump
                            : lift_off.value == landed       ? Course::again_at_once
                            : outcome.jump_spin * way_ < 0.0 ? Course::the_other_way
                                                             : Course::returns;
      sampled.courses.push_back(4 * static_cast<long>(std::floor(turned / two_pi)) +
                                static_cast<long>(course));
      if (!jumps) break;
      turned += dual.angle.value - landed;
      const bool on_section = course == Course::returns;
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
  StateDual dual_spin(const Hoop<StateDual>& hoop, double angle) const {
    const Trig<StateDual> phi = trig(StateDual::parameter(angle, 0));
    return StateDual(way_) * sqrt(vis_viva_at_lift_off(hoop, phi) / contact_inertia(hoop, phi));
  }

  const Design& design_;
  const Scene& scene_;
  Hoop<double> hoop_;
  DualJumpSolver<StateDual> duals_;
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

/// Up to the k-th return.
bool same_course(const Sampled& a, const Sampled& b, std::size_t k) {
  const auto end = [&](const Sampled& s) {
    return s.courses.begin() + static_cast<std::ptrdiff_t>(std::min(s.courses.size(), k + 1));
  };
  return std::equal(a.courses.begin(), end(a), b.courses.begin(), end(b));
}

/// Whether the cubic between a and b foretells the k-th return at `middle`; where none of them returns there
/// is nothing to foretell.
bool is_foretold(const Sampled& a, const Sampled& middle, const Sampled& b, std::size_t k) {
  const bool there = returns(a, k);
  if (returns(b, k) != there || returns(middle, k) != there) return false;
  if (!there) return same_course(a, b, k) && same_course(a, middle, k);
  const double fa = gap(a, k), fb = fa + std::remainder(gap(b, k) - fa, two_pi);
  const double told = 0.5 * (fa + fb) + (b.angle - a.angle) * (a.slope[k] - b.slope[k]) / 8.0;
  return std::abs(std::remainder(gap(middle, k) - told, two_pi)) <= agrees;
}

class Search {
 public:
  Search(const Design& design, const Scene& scene, const GaitOptions& options)
      : design_(design),
        options_(options),
        scene_(scene),
        map_(scene, jump_solvers(scene, options.tolerance)) {}

  /// One number of returns after the other, each as if the others were not looked for: what is found of a
  /// period does not depend on the longest.
  Gaits run() {
    for (const double way : {1.0, -1.0}) {
      const Section section(design_, scene_, options_.tolerance, way, options_.most_period);
      samples_.clear();
      for (std::size_t k = 0; k < static_cast<std::size_t>(options_.most_period); ++k)
        for (int i = 0; i < first_angles; ++i)
          look_between(section, two_pi * i / first_angles, two_pi * (i + 1) / first_angles, k);
      keep_samples(way);
    }
    for (int period = 1; period <= options_.most_period; ++period) look_for_bouncing(period);
    std::ranges::sort(found_.gaits, [](const Gait& a, const Gait& b) {
      return a.jumps.size() != b.jumps.size() ? a.jumps.size() < b.jumps.size() : a.height < b.height;
    });
    return std::move(found_);
  }

 private:
  void keep_samples(double way) {
    for (const auto& [angle, sampled] : samples_) {
      const bool there = !sampled.next.empty();
      found_.returns.push_back(
          {angle, there ? sampled.next[0] : nan, there ? sampled.slope[0] : nan, sampled.height, way < 0.0});
    }
  }

  const Sampled& sample(const Section& section, double angle) {
    const auto [place, is_new] = samples_.try_emplace(angle);
    if (is_new) place->second = section.at(angle);
    return place->second;
  }

  void look_between(const Section& section, double from, double to, std::size_t k) {
    const double between = 0.5 * (from + to);
    const Sampled &a = sample(section, from), &b = sample(section, to), &middle = sample(section, between);
    if (is_foretold(a, middle, b, k)) {
      look_for_orbits(section, a, middle, k);
      look_for_orbits(section, middle, b, k);
    } else if (samples_.size() >= most_samples) {
      found_.is_whole = false;
    } else if (to - from >= finest) {
      look_between(section, from, between, k);
      look_between(section, between, to, k);
    }
  }

  /// An orbit is where a return meets its own angle: between ends of either side, or where the cubic turns to
  /// it.
  void look_for_orbits(const Section& section, const Sampled& a, const Sampled& b, std::size_t k) {
    if (!returns(a, k) || !returns(b, k)) return;
    const double fa = gap(a, k), fb = gap(b, k);
    if (std::abs(fa - fb) > std::numbers::pi) return;  // the shorter way round changes there
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

  /// Orbits all of whose jumps begin at the landing, where N <= 0 right after it: none of them is on the
  /// curve N = 0, and the map has two dimensions there. Newton's iteration from a grid of angles and of spins
  /// beyond that curve.
  void look_for_bouncing(int period) {
    constexpr int angles = 120, spins = 16;
    constexpr double fastest = 3.0;  // times the spin at which the hoop just leaves the plane
    const Hoop<double> hoop = reduce<double>(design_);
    for (int i = 0; i < angles; ++i) {
      const double angle = two_pi * (i + 0.5) / angles;
      const Trig<double> phi = trig(angle);
      const LiftTerms<double> terms = lift_terms(hoop, phi);
      if (!(terms.K < 0.0)) continue;  // a spin holds it down
      // N = P / J + rho K w^2 / J: it leaves the plane beyond this spin, or at any where P is below zero.
      const double least = std::sqrt(std::max(terms.P, 0.0) / (-hoop.rho * terms.K));
      const double unit = least > 0.0 ? least : 1.0;
      for (const double way : {1.0, -1.0})
        for (int k = 0; k < spins; ++k) {
          const Landed start{.angle = angle,
                             .spin = way * (least + unit * (fastest - 1.0) * (k + 0.5) / spins)};
          if (bounces_again(hoop, start)) close(start, period);
        }
    }
  }

  /// Whether a jump from there, N being below zero, lands so that it is below zero again.
  bool bounces_again(const Hoop<double>& hoop, const Landed& start) {
    std::array<Landed, 1> at{start};
    map_.follow(Start::landing, {&design_, 1}, at, outcomes_, [](std::size_t) { return false; });
    if (outcomes_[0].status != Status::jumped) return false;
    const Trig<double> phi = trig(at[0].angle);
    return normal_force(hoop, phi, at[0].spin, angular_acceleration(hoop, phi, at[0].spin)) <= 0.0;
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
    found_.gaits.push_back(
        {orbit.jumps, orbit.multiplier, orbit.height, orbit.speed, orbit.jump_time, orbit.energy_lost});
  }

  const Design& design_;
  GaitOptions options_;
  Scene scene_;
  ReturnMap map_;
  std::map<double, Sampled> samples_;  // of one way, by angle
  std::vector<Orbit> orbits_;
  std::vector<Outcome> outcomes_;  // a workspace
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
