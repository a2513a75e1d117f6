// SPDX-License-Identifier: GPL-3.0-or-later
/// From measurements to a hoop: which release, friction or torque explains a motion that was seen?
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

/// One event that was measured: a quantity of a map, in its unit, with its standard error.
struct MeasuredEvent {
  std::string field{};
  double value = 0.0, error = 0.0;
};

/// A motion over time: the angle, or two markers, P on the mass and O at the hoop's centre, whose coordinates
/// are along the plane, downhill, and away from it.
struct Film {
  std::vector<double> t{};                       ///< since release [s], ascending
  std::vector<double> phi{};                     ///< [rad]; empty: markers
  std::array<std::vector<double>, 4> markers{};  ///< x_P, y_P, x_O, y_O [m], from any origin; empty: phi
  double error = std::numeric_limits<double>::quiet_NaN();  ///< of each number; NaN: told by the residuals
  bool allow_gaps = false;  ///< let pass times that leave out five steps or more
};

/// Events, or a film.
struct Measurements {
  std::string origin{};  ///< the file, for messages
  std::vector<MeasuredEvent> events{};
  Film film{};
  std::vector<long> lines{};  ///< of the file, for messages; empty: they are counted from 1
};

struct MeasurementOptions {
  double scale = 1.0;   ///< metres a unit of marker positions, for pixels
  bool y_down = false;  ///< y counts towards the plane, as rows of a picture do
  bool allow_gaps = false;
  double error = std::numeric_limits<double>::quiet_NaN();  ///< of a film's numbers, in their unit as used
};

/// Reads a CSV file: columns t and phi; or t, x_P, y_P, x_O, y_O; or event, value, error. Throws InputError,
/// naming line and column, for what is no number.
Measurements read_measurements(const std::string& path, const MeasurementOptions& options = {});

/// Throws InputError, naming the line, for numbers that are none, times that do not ascend, gaps, and numbers
/// whose size tells of another unit; spec: of the hoop that was filmed.
void check_measurements(const Measurements& measured, const Spec& spec);

struct FittedParameter {
  std::string name{};
  double value = 0.0;
  double error = 0.0;            ///< standard error; NaN: the data do not tell it
  double low = 0.0, high = 0.0;  ///< where chi-square stays within one of its least, others refitted; of
                                 ///< those that are not identified, from bound to bound if nothing limits it
  bool at_bound = false;
  bool identified = true;
};

/// One model, fitted.
struct ModelFit {
  Scene scene{};
  Design design{};
  bool found = false;  ///< false: no hoop of the box does anything like it
  std::string why{};   ///< why it was not fitted, if it was not
  Outcome outcome{};   ///< of that design
  std::size_t after_landing =
      0;  ///< lines of a film later than the model's landing, where it is not followed
  std::vector<FittedParameter> parameters{};
  std::vector<double> correlations{};                            ///< a row of each parameter
  double chi_square = std::numeric_limits<double>::quiet_NaN();  ///< over the errors; those of a film may be
                                                                 ///< told by the residuals
  std::size_t degrees = 0;                                       ///< of freedom
  double error = 0.0;  ///< of a film: rms of residuals, [rad] or [m]
  double probability =
      std::numeric_limits<double>::quiet_NaN();  ///< that a true model has such a chi-square, or more
  double misfit =
      std::numeric_limits<double>::quiet_NaN();  ///< of a film: residuals over the scatter from line to line
  double correlation = 1.0;  ///< lines of a film whose residuals count as one, as neighbours are alike
  double independent =
      std::numeric_limits<double>::quiet_NaN();  ///< lines of a film that say something of their own
  bool judged = true;  ///< false: a film of too few lines to say whether the model explains it
  double information = std::numeric_limits<double>::infinity();  ///< Akaike's; less is better
  std::vector<double> model{}, residuals{};  ///< of every number measured; residuals over their errors
  std::size_t starts = 0, evaluations = 0;
};

/// Whether residuals stay on one side for so long that another motion would fit better: few lines count.
inline bool runs(const ModelFit& fit) {
  return fit.correlation > 1.0 && fit.independent < 4.0 * (1.0 + static_cast<double>(fit.parameters.size()));
}

/// Whether a fit explains what was measured: numbers with errors by their chi-square, a film without by its
/// scatter from line to line or, if neighbouring lines are alike, by how many of its lines are independent.
inline bool explains(const ModelFit& fit) {
  constexpr double least_likely = 1e-3, most_misfit = 2.0;
  if (!fit.found || !fit.judged) return false;
  if (!std::isnan(fit.probability)) return fit.probability >= least_likely;
  return fit.correlation > 1.0 ? !runs(fit) : !(fit.misfit > most_misfit);
}

struct FitReport {
  std::vector<ModelFit> models{};  ///< best first, by information
  double seconds = 0.0;
};

struct FitOptions {
  std::vector<Friction> models{Friction::sticking, Friction::coulomb};
  std::uint64_t seed = 1;
  std::size_t coarse =
      0;  ///< designs of the coarse map, 16 times a whole number; 0: 4,096 of a film, 65,536 of events
  std::size_t starts = 0;  ///< its places that are followed; 0: 8 of a film, 24 of events
  int threads = 0;         ///< 0: as many as OpenMP offers
  /// Asked now and then, from any thread; true: fit throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Fits free parameters to measurements by least squares: a coarse map of the box first, then GSL's trust
/// region from its best places, derivatives exact. Free are the spec's axes { from, to }; without any,
/// release_angle and release_spin, about where the film begins, and mu_static where the contact slips. Throws
/// InputError for more free parameters than numbers, and as check_measurements and check_spec do.
FitReport fit(const Measurements& measured, const Spec& spec, const FitOptions& options = {});

}  // namespace leapmap
