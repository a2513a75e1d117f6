// SPDX-License-Identifier: GPL-3.0-or-later
/// Flights whose landing event fires too early: y = 0 at lift-off itself, and again wherever the flight dips.
#include <cmath>
#include <functional>
#include <numbers>

#include "hoop/flight_search.hpp"
#include "noslip/exact.hpp"
#include "numerics/nan.hpp"
#include "study/precision.hpp"
#include "study/stability.hpp"

namespace leapmap {
namespace {

constexpr double sample = 1e-3;  // of the simulated flights [sqrt(R/g)]

struct Subject {
  double x;  ///< dip of the true flight [diameters]
  Hoop<double> hoop;
  LiftOff<double> lift_off;
  Flight<long double> truth;
};

/// How a simulated flight's landing event is armed: told the time and the height, whether it may fire from
/// now on.
struct Rule {
  const char* name;
  std::function<bool(double t, double y)> arms;
};

/// Height and duration of a flight simulated sample by sample by the closed form as it stands in
/// the paper, which ends at the first sample at or below the plane once the event is armed, the lift-off
/// being the first of all. A flight that has not risen by then has no height.
Flight<double> simulate(const Subject& subject, const Rule& rule) {
  const Hoop<double>& hoop = subject.hoop;
  const double phi = subject.lift_off.angle, w = subject.lift_off.spin;
  const auto height = [&](double t) {
    return -hoop.rho * std::cos(phi) + hoop.rho * std::sin(phi) * w * t - hoop.cos_slope * t * t / 2.0 +
           hoop.rho * std::cos(phi + w * t);
  };
  Flight<double> flight;
  bool armed = false;
  const double longest = 4.0 * (1.0 + w) / hoop.cos_slope;
  for (long i = 0; static_cast<double>(i) * sample < longest; ++i) {
    const double t = static_cast<double>(i) * sample, y = height(t);
    armed = armed || rule.arms(t, y);
    if (armed && y <= 0.0) break;
    if (y > 2.0 * flight.height) flight.height = 0.5 * y, flight.apex_time = t;
    if (y > 0.0) flight.flight_time = t;
  }
  return flight;
}

/// Lift-offs out of rolling: jumps of random designs, which dip by up to some hundredths of a diameter.
std::vector<Subject> dipping(std::size_t count) {
  const std::vector<Design> designs = random_designs(count, 7);
  std::vector<Outcome> outcomes(count);
  ExactSolver<double>(1e-10).solve(designs, {.runway = 4.0}, outcomes);
  std::vector<Subject> subjects;
  for (std::size_t i = 0; i < count; ++i) {
    if (outcomes[i].status != Status::jumped) continue;
    const LiftOff<double> lift_off{0.0, outcomes[i].jump_angle, outcomes[i].jump_spin};
    subjects.push_back({0.0, reduce<double>(designs[i]), lift_off, {}});
  }
  return subjects;
}

/// Lift-offs out of sliding: the spin at which y'' = 0, w^2 = -cos(theta) / (rho cos(phi)), at angles where
/// y''' > 0.
std::vector<Subject> triple_roots(int count) {
  std::vector<Subject> subjects;
  const Hoop<double> hoop = reduce<double>(Design{});
  for (int i = 0; i < count; ++i) {
    const double angle = std::numbers::pi * (0.5 + 0.48 * (i + 1.0) / count);
    subjects.push_back(
        {0.0, hoop, {0.0, angle, std::sqrt(-hoop.cos_slope / (hoop.rho * std::cos(angle)))}, {}});
  }
  return subjects;
}

}  // namespace

std::vector<StabilityRow> run_landing_case(const StabilityOptions& options) {
  std::vector<Subject> subjects = dipping(options.quick ? 10 : 60);
  const std::vector<Subject> sliding = triple_roots(options.quick ? 4 : 20);
  subjects.insert(subjects.end(), sliding.begin(), sliding.end());
  for (Subject& subject : subjects) {
    const LiftOff<long double> lift_off{0.0L, subject.lift_off.angle, subject.lift_off.spin};
    const Hoop<double>& hoop = subject.hoop;
    const Hoop<long double> widened{hoop.sin_slope, hoop.cos_slope, hoop.rho,   hoop.clearance,
                                    hoop.Ic,        hoop.J_min,     hoop.drive, hoop.thrust};
    subject.truth = fly(widened, lift_off);
    subject.x = static_cast<double>(-subject.truth.dip);
  }

  const Rule rules[]{
      {"armed at once", [](double, double) { return true; }},
      {"armed after 0.05 sqrt(R/g)", [](double t, double) { return t >= 0.05; }},
      {"armed once above the plane", [](double, double y) { return y > 0.0; }},  // a rounding of y(0) does
      {"armed once 1e-9 above it", [](double, double y) { return y > 1e-9; }}};
  std::vector<StabilityRow> rows;
  const auto fly_all = [&](const char* method, const auto& solve, double allowed) {
    for (const Subject& subject : subjects) {
      const Flight<double> ours = solve(subject);
      const Flight<long double>& right = subject.truth;
      const double error = std::max(
          std::abs(ours.height - static_cast<double>(right.height)),
          right.flight_time > 0.0L ? std::abs(ours.flight_time / static_cast<double>(right.flight_time) - 1.0)
                                   : ours.flight_time);
      const Finding finding = error <= allowed ? Finding::fine
                              : error <= 0.05  ? Finding::lossy
                                               : Finding::wrong;
      rows.push_back({"landing", "penetration depth of the flight [hoop diameters]", method, "rule", nan,
                      subject.x, error, nan, nan, nan, nan, "", finding});
    }
  };
  // A sample is a thousandth; near the plane a flight takes some of them.
  fly_all(
      "closed form (leapmap)", [](const Subject& s) { return fly(s.hoop, s.lift_off); }, 1e-11);
  for (const Rule& rule : rules)
    fly_all(
        rule.name, [&](const Subject& s) { return simulate(s, rule); }, 0.01);
  return rows;
}

}  // namespace leapmap
