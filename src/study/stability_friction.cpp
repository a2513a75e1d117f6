// SPDX-License-Identifier: GPL-3.0-or-later
/// The walks into trouble that friction makes, as data.
#include <cmath>

#include "study/stability.hpp"

namespace leapmap {
namespace {

StabilityCase walk(std::string name, std::string abscissa) {
  return {std::move(name), std::move(abscissa), {}, usual_contestants(Friction::coulomb), false, 50'000};
}

const Scene coulomb{.friction = Friction::coulomb};

/// Both sides, ever closer, of the value of one input at which the outcome's phases change, found by
/// bisection in long double.
StabilityCase across(std::string name, std::string abscissa, Design design, double Design::*input,
                     double boundary, bool quick) {
  StabilityCase both_sides = walk(std::move(name), std::move(abscissa));
  for (int decade = 2; decade <= 14; decade += quick ? 4 : 1)
    for (const double side : {-1.0, 1.0}) {
      const double x = side * std::pow(10.0, -decade);
      design.*input = boundary * (1.0 + x);
      both_sides.subjects.push_back({x, design, coulomb});
    }
  return both_sides;
}

/// A heavy mass slides against Painleve's edge: with less friction it runs into it, with more it lifts off
/// just before, where n0 and D vanish together.
StabilityCase painleve(bool quick) {
  const Design design{.slope = 0.4097929865924131,
                      .mass_ratio = 188.0803499182982,
                      .offset_ratio = 0.6728761363187696,
                      .inertia_factor = 0.5,
                      .mu_static = 0.7295130111149761};
  return across("painleve",
                "mu_kinetic beyond the value at which a slide barely misses Painleve's paradox, relative",
                design, &Design::mu_kinetic, 0.3557672168729612, quick);
}

/// n0 of a sliding hoop dips ever less deep, or ever less misses zero.
StabilityCase dip(bool quick) {
  const Design design{.slope = 0.36369480943700777,
                      .mass_ratio = 6.3997768712236915,
                      .offset_ratio = 0.6229009119847162,
                      .mu_static = 0.11204872549173449,
                      .restitution = 0.33657276843146977};
  return across("dip", "mu_kinetic beyond the value at which a dip of n0 touches zero, relative", design,
                &Design::mu_kinetic, 0.080905860609304867, quick);
}

/// The paper's hoop ends a slide where friction just holds it, or just does not.
StabilityCase stick(bool quick) {
  Design design;
  design.mu_kinetic = 0.25;
  return across("stick", "mu_static beyond the value at which friction barely holds, relative", design,
                &Design::mu_static, 0.26571636496098894, quick);
}

/// Rolls off ever more slowly near the top: the time goes as the logarithm of the spin.
StabilityCase slow(bool quick) {
  StabilityCase slow = walk("slow", "release spin [sqrt(g/R)]");
  for (int decade = 1; decade <= 12; decade += quick ? 4 : 1) {
    StabilitySubject subject{std::pow(10.0, -decade),
                             {.slope = 0.5647115957240031,
                              .mass_ratio = 4.246058805451686,
                              .offset_ratio = 0.978398993194525,
                              .release_angle = 1.9485688953985996,
                              .mu_static = 0.8376440911782836},
                             coulomb};
    subject.design.release_spin = subject.x;
    slow.subjects.push_back(subject);
  }
  return slow;
}

/// Ever more rebounds before a hop is high enough.
StabilityCase bounces(bool quick) {
  StabilityCase bounces = walk("bounces", "restitution");
  for (int tenth = 1; tenth <= 9; tenth += quick ? 4 : 1) {
    StabilitySubject subject{0.1 * tenth,
                             {.slope = 0.6, .mass_ratio = 3.0, .offset_ratio = 0.9, .mu_static = 0.4},
                             {.friction = Friction::coulomb, .runway = 20.0, .hop_height = 1.5}};
    subject.design.restitution = subject.x;
    bounces.subjects.push_back(subject);
  }
  return bounces;
}

}  // namespace

std::span<const NamedCase> friction_cases() {
  static constexpr NamedCase cases[] = {
      {"painleve", painleve}, {"slow", slow}, {"dip", dip}, {"stick", stick}, {"bounces", bounces}};
  return cases;
}

}  // namespace leapmap
