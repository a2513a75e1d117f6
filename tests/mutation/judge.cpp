// SPDX-License-Identifier: GPL-3.0-or-later
/// Solves seeded random designs by every way the library has, and by the referee, which shares none of their
/// formulas. Ends with status 1 at the first design where they differ. With a file of designs and of what is
/// proved of them: solves those without slip, and ends so at the first outside its enclosures.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include "friction/coulomb.hpp"
#include "friction/coulomb_integration.hpp"
#include "integrate/rolling_integration.hpp"
#include "noslip/exact.hpp"
#include "referee/referee.hpp"
#include "trajectory/jump_measures.hpp"

namespace leapmap {
namespace {

constexpr double allowed = 1e-7;  // a planted error is 1e-3; every method here is right to 1e-10

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(random() >> 11), -53);
}

Design any_design(std::mt19937_64& random, std::size_t number) {
  Design design{.slope = uniform(random, 0.1, 0.8),
                .mass_ratio = uniform(random, 0.5, 10.0),
                .offset_ratio = uniform(random, 0.3, 1.0),
                .inertia_factor = uniform(random, 0.5, 1.0),
                .release_angle = number % 2 ? uniform(random, 1.5, 4.7) : std::numbers::pi,
                .release_spin = number % 2 ? uniform(random, 0.0, 1.0) : 0.0,
                .mu_static = uniform(random, 0.1, 1.0)};
  design.mu_kinetic = design.mu_static * uniform(random, 0.7, 1.0);
  design.restitution = uniform(random, 0.0, 0.7);
  if (number % 4 == 1) design.release_spin = uniform(random, -1.0, 0.0);
  if (number % 3 == 0) design.drive_torque = uniform(random, -0.3, 0.3);
  if (number % 4 == 2) {  // these come near Painleve's edge
    design.mass_ratio = uniform(random, 50.0, 200.0);
    design.inertia_factor = 0.5;
    design.mu_static = uniform(random, 0.5, 0.9);
    design.mu_kinetic = 0.85 * design.mu_static;
  }
  return design;
}

/// The largest difference; infinity: of status, flag, candidates or phases. second: sqrt(R/g), the size of a
/// time.
double difference(const Outcome& ours, const Outcome& right, double second) {
  if (!same_flags(ours, right)) return HUGE_VAL;
  double largest = 0.0;
  const auto look = [&](double Outcome::*member, double unit) {
    const double a = ours.*member, b = right.*member;
    if (std::isnan(a) && std::isnan(b)) return;
    const double error = std::abs(a - b) / (unit + std::abs(b));
    largest = std::isnan(error) ? HUGE_VAL : std::max(largest, error);
  };
  for (const auto member :
       {&Outcome::jump_time, &Outcome::first_jump_time, &Outcome::apex_time, &Outcome::flight_time})
    look(member, second);
  for (const auto member : {&Outcome::jump_height, &Outcome::first_jump_height, &Outcome::dip,
                            &Outcome::jump_angle, &Outcome::jump_spin, &Outcome::jump_distance,
                            &Outcome::slip_distance, &Outcome::landing_spin, &Outcome::energy_lost})
    look(member, 1.0);
  for (const auto& row : measure_rows<double>) look(row.kept, 1.0);
  return largest;
}

/// The first disagreement's words, or none. undecided: designs where the referee gave up, or is in doubt
/// itself.
template <class Solve>
std::string first_disagreement(const char* method, const Scene& scene, std::size_t count,
                               const Solve& solve) {
  referee::Referee referee(scene, 1e-13), coarser(scene, 1e-11);
  const double second = time_unit(scene);
  std::mt19937_64 random(14);
  std::size_t undecided = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Design design = any_design(random, i);
    const Outcome right = referee.solve(design);
    if (right.status == Status::failed || difference(coarser.solve(design), right, second) > 0.1 * allowed) {
      ++undecided;
      continue;
    }
    const double error = difference(solve(design), right, second);
    if (!(error <= allowed))
      return std::string(method) + ", design " + std::to_string(i) + ": " + std::to_string(error);
  }
  return undecided * 5 > count ? "the referee decides too few designs" : "";
}

/// The first design of a file whose outcome is not what is proved of it. A line each: the eight parameters,
/// status, flag, lift-offs, and bounds of height and time.
std::string first_outside(const char* path) {
  std::ifstream file(path);
  ExactSolver<double> exact(1e-11);
  Design design;
  int status = 0, flag = 0, lift_offs = 0, number = 0;
  double low = 0.0, high = 0.0, soonest = 0.0, latest = 0.0;
  while (file >> design.slope >> design.mass_ratio >> design.offset_ratio >> design.inertia_factor >>
         design.release_angle >> design.release_spin >> design.drive_torque >> design.resisting_torque >>
         status >> flag >> lift_offs >> low >> high >> soonest >> latest) {
    Outcome ours;
    exact.solve({&design, 1}, Scene{}, {&ours, 1});
    constexpr double rounding = 1e-10;  // times are good to 1e-11; an apex hides an error to its square
    const auto outside = [](double value, double from, double to) {
      return !(value >= from - rounding && value <= to + rounding);
    };
    if (static_cast<int>(ours.status) != status || ours.spurious_first_jump != flag ||
        ours.candidates != lift_offs || outside(ours.jump_height, low, high) ||
        outside(ours.jump_time, soonest, latest))
      return "proved, design " + std::to_string(number);
    ++number;
  }
  return number < 10 ? "fewer than ten designs are proved" : "";
}

}  // namespace
}  // namespace leapmap

int main(int count, char** arguments) {
  using namespace leapmap;
  if (count > 1) {
    const std::string outside = first_outside(arguments[1]);
    if (!outside.empty()) std::printf("%s\n", outside.c_str());
    return outside.empty() ? 0 : 1;
  }
  constexpr std::size_t few = 24, many = 96;
  const Scene sticks, slips{.friction = Friction::coulomb};
  const Scene rebounds{.friction = Friction::coulomb, .runway = 8.0, .hop_height = 0.4};
  ExactSolver<double> exact(1e-11);
  CoulombSolver<double> coulomb(1e-11);
  RollingIntegration rolling(adaptive("gsl-rk8pd", 1e-12));
  CoulombIntegration sliding(adaptive("gsl-rk8pd", 1e-12));
  const std::string found[]{
      first_disagreement("exact, no slip", sticks, many,
                         [&](const Design& design) {
                           Outcome outcome;
                           exact.solve({&design, 1}, sticks, {&outcome, 1});
                           return outcome;
                         }),
      first_disagreement("exact, Coulomb", slips, many,
                         [&](const Design& design) { return coulomb.solve(design, slips); }),
      first_disagreement("exact, Coulomb, rebounds", rebounds, many,
                         [&](const Design& design) { return coulomb.solve(design, rebounds); }),
      first_disagreement("integration, no slip", sticks, few,
                         [&](const Design& design) { return rolling.solve(design, sticks); }),
      first_disagreement("integration, Coulomb", slips, few,
                         [&](const Design& design) { return sliding.solve(design, slips); })};
  for (const std::string& disagreement : found)
    if (!disagreement.empty()) {
      std::printf("%s\n", disagreement.c_str());
      return 1;
    }
  return 0;
}
