// SPDX-License-Identifier: GPL-3.0-or-later
/// Many hoops: those of a map, and those that go on jumping.
#include <algorithm>

#include "gaits/return_map.hpp"
#include "web/page.hpp"

namespace leapmap::web {
namespace {

/// Of hoops that go on jumping.
std::vector<double> heights_told;

std::size_t status_row() {
  const auto& fields = row_fields();
  return static_cast<std::size_t>(
      std::find_if(fields.begin(), fields.end(), [](const Field* field) { return field->name == "status"; }) -
      fields.begin());
}

}  // namespace

/// Lets hoops jump that differ in one parameter, evenly from `from` to `to`: heights()[i * keep + k] is the
/// height of hoop i's jump settle + k + 1 [diameters]; NaN: it makes none. Each may roll as far as the runway
/// to its next landing. Returns how many jumps were made in all.
LEAPMAP_EXPORT int bifurcate(int friction, double tolerance, int parameter, double from, double to, int count,
                             int settle, int keep) {
  Scene scene = page.scene(friction);
  scene.jumps = 1;
  const auto variable = variable_of(parameter);
  heights_told.assign(static_cast<std::size_t>(count) * static_cast<std::size_t>(keep), Outcome::none);
  if (!variable || variable->of_body()) return 0;
  const JumpSolver<double> solve = jump_solver(scene, tolerance, untimed);
  std::vector<Design> designs;
  std::vector<ContactState<double>> states;
  std::vector<std::size_t> which;
  for (int i = 0; i < count; ++i) {
    designs.push_back(page.design());
    designs.back().*variable->parameter() = count > 1 ? from + (to - from) * i / (count - 1) : from;
    states.push_back(released<double>(designs.back()));
    which.push_back(static_cast<std::size_t>(i));
  }
  std::vector<Outcome> outcomes;
  int made = 0;
  for (int jump = 0; jump < settle + keep && !designs.empty(); ++jump) {
    outcomes.resize(designs.size());
    solve(jump == 0 ? Start::release : Start::landing, designs, states, outcomes);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < designs.size(); ++i) {
      if (outcomes[i].status != Status::jumped || is_beyond(scene, states[i]) || is_of_no_flight(outcomes[i]))
        continue;
      ++made;
      if (jump >= settle)
        heights_told[which[i] * static_cast<std::size_t>(keep) + static_cast<std::size_t>(jump - settle)] =
            outcomes[i].jump_height;
      designs[kept] = designs[i], states[kept] = reduced(states[i]), which[kept] = which[i];
      ++kept;
    }
    designs.resize(kept), states.resize(kept), which.resize(kept);
  }
  return made;
}
LEAPMAP_EXPORT const double* heights() { return heights_told.data(); }

/// What rows() holds of each design, in this order; null after the last.
LEAPMAP_EXPORT const char* row_name(int i) {
  const auto& fields = row_fields();
  return i >= 0 && static_cast<std::size_t>(i) < fields.size()
             ? fields[static_cast<std::size_t>(i)]->name.data()
             : nullptr;
}

/// Room for two numbers of each of so many designs, which the page fills in: first and second by turns.
LEAPMAP_EXPORT double* places(int count) {
  page.places.resize(2 * static_cast<std::size_t>(count));
  return page.places.data();
}

/// Solves so many designs, the page's own but for two numbers of variable_key, whose values are in places():
/// of each design a row of rows(), as the map stores it; NaN: does not apply. A design that nothing can be
/// with is not_computed.
LEAPMAP_EXPORT void solve_places(int friction, double tolerance, int first, int second, int count) {
  const Scene scene = page.scene(friction);
  const std::size_t wide = row_fields().size();
  page.rows.assign(static_cast<std::size_t>(count) * wide, Outcome::none);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    page.rows[i * wide + status_row()] = static_cast<double>(Status::not_computed);
  const auto [designs, bodies, which] = placed_designs(first, second);
  std::vector<Outcome> outcomes(designs.size());
  solver_of(scene, tolerance)(designs, outcomes);
  tell_more(scene, tolerance, designs, outcomes);
  for (std::size_t k = 0; k < which.size(); ++k)
    for (std::size_t f = 0; f < wide; ++f)
      page.rows[which[k] * wide + f] = stored_number(*row_fields()[f], outcomes[k]);
}
LEAPMAP_EXPORT const double* rows() { return page.rows.data(); }

}  // namespace leapmap::web
