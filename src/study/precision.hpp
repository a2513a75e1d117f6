// SPDX-License-Identifier: GPL-3.0-or-later
/// Speed against accuracy: every method at every setting on the same designs, errors against study/truth.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "integrate/contestant.hpp"
#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"

namespace leapmap {

/// What a contestant is worth on some designs. Errors are over the designs whose status, flag and number of
/// candidates are right; NaN if there is none.
struct Measurement {
  double seconds = 0.0;      ///< of one thread for one design, the least of some repeats
  double evaluations = 0.0;  ///< of the acceleration for one design; NaN for exact, which has none
  double max_height_error = 0.0, median_height_error = 0.0;  ///< [hoop diameters]
  double max_time_error = 0.0, median_time_error = 0.0;      ///< of jump_time, relative
  double max_angle_error = 0.0, median_angle_error = 0.0;    ///< of jump_angle [rad]
  double wrong = 0.0;   ///< share of designs whose status, flag or candidates are silently wrong
  double failed = 0.0;  ///< share of designs the method gave up on, saying so
  double drift = 0.0;   ///< largest violation of the constraints; NaN where the model has none
};

struct PrecisionRow {
  std::string designs;  ///< "random", "paper"; "given": points
  Contestant contestant;
  Measurement measurement;
};

struct PrecisionOptions {
  std::size_t designs = 200;  ///< random ones, beside the paper's hoop
  std::uint64_t seed = 1;
  double budget =
      4.0;  ///< seconds a contestant may take; those of its series that would take longer are left out
  bool quick = false;                ///< every third setting only
  std::vector<Design> points;        ///< in place of the random ones and the paper's hoop, if any
  std::vector<std::string> methods;  ///< only these, on the least model; empty: all
};

/// All contestants, those of a series one after another, the cheapest first. With Coulomb friction exact and
/// GSL's steppers on one coordinate and the slip.
std::vector<Contestant> precision_contestants(bool quick, Friction friction = Friction::sticking);

/// Random designs: slope 0.1 to 0.8, mass ratio 0.5 to 10, L/R 0.3 to 1, uniform, released from rest on top;
/// with Coulomb friction mu_static 0.1 to 1 and mu_kinetic 0.7 to 1 times that.
std::vector<Design> random_designs(std::size_t count, std::uint64_t seed,
                                   Friction friction = Friction::sticking);

/// Solves the designs by a contestant until the time is taken well, and compares with the truth. One thread.
Measurement measure(const Contestant& contestant, std::span<const Design> designs, const Scene& scene,
                    std::span<const Outcome> truth, double budget);

/// Runs the study, one contestant after another on one thread; told, if set, is called with each row.
std::vector<PrecisionRow> study_precision(const PrecisionOptions& options, const Scene& scene,
                                          const std::function<void(const PrecisionRow&)>& told = {},
                                          const std::function<bool()>& stop_requested = {});

}  // namespace leapmap
