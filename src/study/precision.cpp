// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/precision.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "model/model.hpp"
#include "numerics/game_steppers.hpp"
#include "numerics/gsl_integrator.hpp"
#include "numerics/nan.hpp"
#include "study/truth.hpp"

namespace leapmap {
namespace {

constexpr long max_steps = 200'000;

struct Spread {
  double max = nan, median = nan;
};

Spread spread_of(std::vector<double>& errors) {
  if (errors.empty()) return {};
  std::ranges::sort(errors);
  return {errors.back(), errors[errors.size() / 2]};
}

void compare(std::span<const Outcome> outcomes, std::span<const Outcome> truth, Measurement& measurement) {
  std::vector<double> heights, times, angles;
  std::size_t wrong = 0, failed = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Outcome &ours = outcomes[i], &right = truth[i];
    if (ours.status == Status::failed) {
      ++failed;
    } else if (!same_flags(ours, right)) {
      ++wrong;
    } else if (right.status == Status::jumped) {
      heights.push_back(std::abs(ours.jump_height - right.jump_height));
      times.push_back(std::abs(ours.jump_time / right.jump_time - 1.0));
      angles.push_back(std::abs(ours.jump_angle - right.jump_angle));
    }
  }
  const auto share = [&](std::size_t count) {
    return static_cast<double>(count) / static_cast<double>(truth.size());
  };
  const Spread height = spread_of(heights), time = spread_of(times), angle = spread_of(angles);
  measurement.max_height_error = height.max, measurement.median_height_error = height.median;
  measurement.max_time_error = time.max, measurement.median_time_error = time.median;
  measurement.max_angle_error = angle.max, measurement.median_angle_error = angle.median;
  measurement.wrong = share(wrong), measurement.failed = share(failed);
}

}  // namespace

std::vector<Contestant> precision_contestants(bool quick, Friction friction) {
  std::vector<Contestant> contestants;
  const auto add = [&](std::string_view method, bool fixed_step, const std::vector<double>& settings,
                       int order, RollingModel model = RollingModel::one_coordinate) {
    for (std::size_t i = 0; i < settings.size(); ++i)
      if (!quick || i % 3 == 0)
        contestants.push_back({std::string(method), fixed_step, settings[i], order, model});
  };
  std::vector<double> tolerances, steps;
  for (int digits = 3; digits <= 13; ++digits) tolerances.push_back(std::pow(10.0, -digits));
  for (int halvings = 1; halvings <= 8; ++halvings) steps.push_back(std::ldexp(1.0, -halvings));
  add("exact", false, {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13}, 0,
      RollingModel::energy_integral);
  for (const GslStepper& stepper : gsl_steppers()) add(stepper.name, false, tolerances, 0);
  for (const GslStepper& stepper : gsl_steppers())
    if (stepper.order > 0) add(stepper.name, true, steps, stepper.order);
  if (model_of(friction).slips) return contestants;
  for (const GslStepper& stepper : game_steppers()) add(stepper.name, true, steps, stepper.order);
  for (const RollingModel model : {RollingModel::multipliers, RollingModel::multipliers_projected,
                                   RollingModel::centre_of_mass, RollingModel::centre_of_mass_projected})
    add("gsl-rk8pd", false, tolerances, 0, model);
  return contestants;
}

std::vector<Design> random_designs(std::size_t count, std::uint64_t seed, Friction friction) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return low +
           (high - low) * std::ldexp(static_cast<double>(random() >> 11), -53);  // the same on any machine
  };
  std::vector<Design> designs(count);
  for (Design& design : designs) {
    design.slope = uniform(0.1, 0.8);
    design.mass_ratio = uniform(0.5, 10.0);
    design.offset_ratio = uniform(0.3, 1.0);
    if (!model_of(friction).slips) continue;
    design.mu_static = uniform(0.1, 1.0);
    design.mu_kinetic = design.mu_static * uniform(0.7, 1.0);
  }
  return designs;
}

Measurement measure(const Contestant& contestant, std::span<const Design> designs, const Scene& scene,
                    std::span<const Outcome> truth, double budget) {
  using Clock = std::chrono::steady_clock;
  constexpr int most_repeats = 20;
  const Solving solving = model_of(scene).solving(contestant, scene, max_steps);
  std::vector<Outcome> outcomes(designs.size());
  Measurement measurement;
  double least = std::numeric_limits<double>::infinity(), spent = 0.0;
  // The first run warms caches up; a dear contestant has only that one.
  for (int repeat = 0; repeat <= most_repeats && (repeat < 1 || spent * (repeat + 1) / repeat < 0.2 * budget);
       ++repeat) {
    const long before = solving.evaluations ? solving.evaluations() : 0;
    const auto begin = Clock::now();
    solving.solve(designs, outcomes);
    const double passed = std::chrono::duration<double>(Clock::now() - begin).count();
    spent += passed;
    least = std::min(least, passed);
    measurement.evaluations = solving.evaluations ? static_cast<double>(solving.evaluations() - before) /
                                                        static_cast<double>(designs.size())
                                                  : nan;
  }
  measurement.seconds = least / static_cast<double>(designs.size());
  compare(outcomes, truth, measurement);
  measurement.drift = solving.drift ? 0.0 : nan;
  if (solving.drift)
    for (const Design& design : designs)
      measurement.drift = std::max(measurement.drift, solving.drift(design));
  return measurement;
}

std::vector<PrecisionRow> study_precision(const PrecisionOptions& options, const Scene& scene,
                                          const std::function<void(const PrecisionRow&)>& told,
                                          const std::function<bool()>& stop_requested) {
  std::vector<std::pair<std::string, std::vector<Design>>> sets;
  if (options.points.empty()) {
    sets.emplace_back("random", random_designs(options.designs, options.seed, scene.friction));
    sets.emplace_back("paper", std::vector<Design>(1));
  } else {
    sets.emplace_back("given", options.points);
  }
  std::vector<Contestant> contestants = precision_contestants(options.quick, scene.friction);
  if (!options.methods.empty())
    std::erase_if(contestants, [&](const Contestant& contestant) {
      return contestant.model > RollingModel::one_coordinate ||
             std::ranges::find(options.methods, contestant.method) == options.methods.end();
    });
  std::vector<PrecisionRow> rows;
  for (const auto& [name, designs] : sets) {
    std::vector<Outcome> truth;
    for (const Truth& known : truths_of(designs, scene)) truth.push_back(known.outcome);
    const Contestant* too_dear = nullptr;
    for (const Contestant& contestant : contestants) {
      if (stop_requested && stop_requested()) return rows;
      if (too_dear && contestant.same_series(*too_dear)) continue;
      rows.push_back({name, contestant, measure(contestant, designs, scene, truth, options.budget)});
      if (told) told(rows.back());
      if (rows.back().measurement.seconds * static_cast<double>(designs.size()) > options.budget)
        too_dear = &contestant;
    }
  }
  return rows;
}

}  // namespace leapmap
