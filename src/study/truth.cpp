// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/truth.hpp"

#include <array>
#include <cmath>

#include "integrate/contestant.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"

namespace leapmap {
namespace {

constexpr double finest = 1e-13, coarser = 1e-12;
constexpr double own_error = 1e-11;  // of an integration at `finest` over a few revolutions
constexpr double slack = 10.0;       // of the difference between the two integrations

class Integrations {
 public:
  explicit Integrations(const Scene& scene)
      : fine_(model_of(scene).solving({"gsl-rk8pd", false, finest}, scene, most_steps(scene))),
        coarse_(model_of(scene).solving({"gsl-rk8pd", false, coarser}, scene, most_steps(scene))),
        inputs_(inputs_of(scene.friction)) {}

  Outcome fine(const Design& design) const { return solved(fine_, design); }
  Outcome coarse(const Design& design) const { return solved(coarse_, design); }
  /// Whether its flags stay where the inputs change by its own error.
  bool is_sure(const Design& design, const Outcome& outcome) const {
    for (double Design::*input : inputs_)
      for (const double way : {-1.0, 1.0}) {
        Design beside = design;
        beside.*input *= 1.0 + way * own_error;
        if (!(beside.offset_ratio <= 1.0 && beside.restitution <= 1.0)) continue;
        const Outcome there = fine(beside);
        if (there.status != Status::failed && !same_course(there, outcome)) return false;
      }
    return true;
  }

 private:
  static Outcome solved(const Solving& solving, const Design& design) {
    Outcome outcome;
    solving.solve({&design, 1}, {&outcome, 1});
    return outcome;
  }
  Solving fine_, coarse_;
  std::vector<double Design::*> inputs_;
};

}  // namespace

std::string_view name_of(Witness witness) {
  constexpr std::array<std::string_view, 3> names{"long double and gsl-rk8pd", "gsl-rk8pd", "long double"};
  return names[static_cast<std::size_t>(witness)];
}

std::vector<double Design::*> inputs_of(Friction friction) {
  std::vector<double Design::*> inputs;
  for (const Parameter& parameter : parameters())
    if (const auto* member = std::get_if<double Design::*>(&parameter.member);
        member && has(Scene{.friction = friction}, parameter.only_of))
      inputs.push_back(*member);
  return inputs;
}

bool same_course(const Outcome& a, const Outcome& b) { return same_flags(a, b) && a.jumps() == b.jumps(); }

double error_of(const Outcome& ours, const Outcome& right) {
  double error = 0.0;
  const auto worsen = [&](double by) { error = by > error || std::isnan(by) ? by : error; };
  if (right.candidates > 0) worsen(std::abs(ours.first_jump_time / right.first_jump_time - 1.0));
  if (right.status == Status::jumped) {
    worsen(std::abs(ours.jump_height - right.jump_height));
    worsen(std::abs(ours.jump_time / right.jump_time - 1.0));
  }
  for (std::size_t k = 0; k < right.later_jumps.size(); ++k) {
    worsen(std::abs(ours.later_jumps[k].height - right.later_jumps[k].height));
    worsen(std::abs(ours.later_jumps[k].time / right.later_jumps[k].time - 1.0));
  }
  return error;
}

Outcome refined_outcome(const Design& design, const Scene& scene) {
  return model_of(scene).refined(design, scene);
}

std::vector<Truth> truths_of(std::span<const Design> designs, const Scene& scene) {
  const Integrations by_time(scene);
  std::vector<Truth> truths;
  for (const Design& design : designs) {
    const Outcome refined = refined_outcome(design, scene), fine = by_time.fine(design);
    const Outcome coarse = fine.status == Status::failed ? fine : by_time.coarse(design);
    if (fine.status == Status::failed || !same_course(fine, coarse)) {
      truths.push_back({refined, Witness::long_double});
      continue;
    }
    const double doubt = own_error + slack * error_of(coarse, fine);
    if (same_course(refined, fine) && error_of(refined, fine) <= doubt)
      truths.push_back({refined, Witness::both});
    else if (by_time.is_sure(design, fine))
      truths.push_back({fine, Witness::integration});
    else
      truths.push_back({refined, Witness::long_double});
  }
  return truths;
}

}  // namespace leapmap
