// SPDX-License-Identifier: GPL-3.0-or-later
/// Hoops as made after the designs of a map: how many do what they must, and how high they jump.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "tolerance/scatter_solver.hpp"
#include "web/page.hpp"

namespace leapmap::web {
namespace {

/// What is asked of hoops as made.
struct Asked {
  Scatter scatter;
  std::vector<Goal> goals;
  std::vector<const Field*> fields;
  std::uint64_t seed = 1;  // in place of scatter.seed, a long, which is too short for it here
};
Asked asked;

}  // namespace

/// A field of hoops as made by number, null after the last.
LEAPMAP_EXPORT const char* made_name(int i) { return name_at(scatter_fields(), i); }

/// Asks anew: so many hoops after each drawing, or a few more, as whole replicates need; nothing scatters
/// yet, nothing is to be reached and nothing told.
LEAPMAP_EXPORT void ask_made(int samples, double seed) {
  asked = {};
  asked.seed = static_cast<std::uint64_t>(seed);
  asked.scatter.samples =
      static_cast<long>(SobolPoints::whole(static_cast<std::size_t>(std::max(samples, 1))));
}
/// A number of variable_key scatters. law: a Spread::Law's number; percent: the width is in per cent.
LEAPMAP_EXPORT void ask_spread(int number, int law, double width, int percent) {
  asked.scatter.spreads.push_back({variable_key(number), static_cast<Spread::Law>(law), width, percent != 0});
}
LEAPMAP_EXPORT void ask_goal(int field, double at_least, double at_most) {
  asked.goals.push_back({std::string(field_of(field).name), at_least, at_most});
}
/// By its number among made_name's.
LEAPMAP_EXPORT void ask_field(int made) {
  asked.fields.push_back(&scatter_fields()[static_cast<std::size_t>(made)]);
}

/// Of the designs of solve_places, a row of rows() each: the fields asked for. NaN: does not apply, or more
/// than half of a law lies where no hoop can be.
LEAPMAP_EXPORT void solve_made(int friction, double tolerance, int first, int second, int count) {
  const Scene scene = page.scene(friction);
  const std::size_t wide = asked.fields.size();
  page.rows.assign(static_cast<std::size_t>(count) * wide, Outcome::none);
  const auto [designs, bodies, which] = placed_designs(first, second);
  const auto points = std::make_shared<const SobolPoints>(
      asked.scatter.spreads.size(), static_cast<std::size_t>(asked.scatter.samples), asked.seed);
  ScatterSolver solver(asked.scatter, page.drawing, page.held, points, asked.goals,
                       quantities_of(asked.fields),
                       [scene, tolerance, jumps = solver_of(scene, tolerance)](std::span<const Design> some,
                                                                               std::span<Outcome> outcomes) {
                         jumps(some, outcomes);
                         tell_more(scene, tolerance, some, outcomes);
                       });
  MadeColumns columns(asked.fields);
  for (std::size_t k = 0; k < which.size(); ++k) {
    const Body* body = bodies.empty() ? nullptr : &bodies[k];
    if (!solver.can_make(designs[k], body)) continue;
    solver.solve({&designs[k], 1}, columns, {body, body ? 1u : 0u});
    for (std::size_t f = 0; f < wide; ++f)
      page.rows[which[k] * wide + f] = columns.column(*asked.fields[f])[0];
  }
}

}  // namespace leapmap::web
