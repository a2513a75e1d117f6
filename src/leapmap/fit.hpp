// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Identification of release, friction, torque or hoop from a measured motion.
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

/// One measured event: a field of a map with its standard error.
struct MeasuredEvent {
  std::string field{};  ///< name of the field, for example "flight_time"
  double value = 0.0;   ///< in the field's unit
  double error = 0.0;   ///< standard error in the same unit, > 0
};

/// A measured motion over time: the angle, or two markers, P on the mass and O on the hoop's centre. Marker
/// coordinates are along the plane, downhill, and away from it.
struct Film {
  std::vector<double> t{};                       ///< times since release [s], ascending
  std::vector<double> phi{};                     ///< angles [rad]; empty: markers are given
  std::array<std::vector<double>, 4> markers{};  ///< x_P, y_P, x_O, y_O [m], any origin; empty: phi is given
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error; NaN: from the residuals
  bool allow_gaps = false;                                  ///< accept gaps of five time steps or more
};

/// Measurements: events or a film.
struct Measurements {
  std::string origin{};                 ///< file name for messages
  std::vector<MeasuredEvent> events{};  ///< empty: a film is given
  Film film{};                          ///< used if there are no events
  std::vector<long> lines{};            ///< line numbers of the file for messages; empty: counted from 1
};

/// How read_measurements interprets a film.
struct MeasurementOptions {
  double scale = 1.0;       ///< metres per unit of marker positions
  bool y_down = false;      ///< y grows towards the plane, as rows of a picture do
  bool allow_gaps = false;  ///< accept gaps of five time steps or more
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error [rad or m]; NaN: unknown
};

/// Reads a CSV file with the columns t, phi; or t, x_P, y_P, x_O, y_O; or event, value, error.
/// @throws InputError with line and column for anything that is not a number; IoError
Measurements read_measurements(const std::string& path, const MeasurementOptions& options = {});

/// Checks measurements.
/// @param spec  describes the hoop that was filmed
/// @throws InputError, with the line, for numbers that are not finite, times that do not ascend, gaps, and
///         values whose size indicates another unit
void check_measurements(const Measurements& measured, const Spec& spec);

/// One fitted parameter.
struct FittedParameter {
  std::string name{};      ///< as in a spec
  double value = 0.0;      ///< best fit, in the parameter's unit
  double error = 0.0;      ///< standard error; NaN: not identified
  double low = 0.0;        ///< lower end of the interval in which chi-square rises by less than 1
  double high = 0.0;       ///< upper end of that interval, the other parameters refitted
  bool at_bound = false;   ///< the value is at one of its bounds
  bool identified = true;  ///< false: the data do not determine it
};

/// One fitted model.
struct ModelFit {
  Scene scene{};                  ///< its scene
  Design design{};                ///< the best fit
  bool found = false;             ///< false: no design within the bounds shows all that was measured
  std::string why{};              ///< reason why the model was not fitted, if it was not
  Outcome outcome{};              ///< outcome of the best fit
  std::size_t after_landing = 0;  ///< lines of a film after the model's last landing; not used
  std::vector<FittedParameter> parameters{};  ///< in the spec's order
  std::vector<double> correlations{};         ///< matrix, row by row, of size parameters x parameters
  double chi_square = std::numeric_limits<double>::quiet_NaN();  ///< sum of squares of residuals over errors
  std::size_t degrees = 0;                                       ///< degrees of freedom
  double error = 0.0;                                            ///< film: rms of the residuals [rad or m]
  /// Probability of a chi-square at least as large if the model is true; NaN: errors are unknown.
  double probability = std::numeric_limits<double>::quiet_NaN();
  /// Film: rms of the residuals over their scatter from line to line.
  double misfit = std::numeric_limits<double>::quiet_NaN();
  double correlation = 1.0;  ///< film: number of neighbouring lines whose residuals count as one
  double independent = std::numeric_limits<double>::quiet_NaN();  ///< film: number of independent lines
  bool judged = true;  ///< false: the film has too few lines to accept or reject the model
  double information = std::numeric_limits<double>::infinity();  ///< Akaike's criterion; less is better
  std::vector<double> model{};      ///< the model's value of every number measured
  std::vector<double> residuals{};  ///< of every number measured, over its error
  std::size_t starts = 0;           ///< number of starting points followed
  std::size_t evaluations = 0;      ///< number of designs solved
};

/// Whether residuals keep their sign for so long that another motion would fit better.
inline bool runs(const ModelFit& fit) {
  return fit.correlation > 1.0 && fit.independent < 4.0 * (1.0 + static_cast<double>(fit.parameters.size()));
}

/// Whether a model explains the measurements. Numbers with errors are judged by chi-square, a film without
/// errors by its scatter from line to line or, if neighbours are correlated, by its independent lines.
inline bool explains(const ModelFit& fit) {
  constexpr double least_likely = 1e-3, most_misfit = 2.0;
  if (!fit.found || !fit.judged) return false;
  if (!std::isnan(fit.probability)) return fit.probability >= least_likely;
  return fit.correlation > 1.0 ? !runs(fit) : !(fit.misfit > most_misfit);
}

/// Result of fit.
struct FitReport {
  std::vector<ModelFit> models{};  ///< best first, by Akaike's criterion
  double seconds = 0.0;            ///< duration [s]
};

/// Options of fit.
struct FitOptions {
  std::vector<Friction> models{Friction::sticking, Friction::coulomb};  ///< models to fit
  std::uint64_t seed = 1;  ///< of the initial sample; equal seeds give equal fits
  std::size_t coarse = 0;  ///< size of the initial sample, a multiple of 16; 0: 4,096 for a film, else 65,536
  std::size_t starts = 0;  ///< its best points that are followed; 0: 8 for a film, 24 for events
  int threads = 0;         ///< number of threads; 0: all that OpenMP offers
  /// Polled from any thread; if it returns true, fit throws Stopped.
  std::function<bool()> stop_requested{};
};

/// Fits free parameters to measurements by least squares.
///
/// An initial sample of the bounds comes first; GSL's trust region follows its best points with exact
/// derivatives. The spec's axes { from, to } are the free parameters. Without any these are release_angle,
/// release_spin and, with Coulomb friction, mu_static.
/// @throws InputError for more free parameters than numbers, and as check_measurements and check_spec do;
///         Stopped
FitReport fit(const Measurements& measured, const Spec& spec, const FitOptions& options = {});

}  // namespace leapmap
