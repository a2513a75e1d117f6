// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Identification of release, friction, torque or hoop from a measured motion.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/film.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

/// One measured event: a field of a map with its standard error.
struct MeasuredEvent {
  std::string field{};  ///< name of the field, for example "flight_time"
  double value = 0.0;   ///< in the field's unit
  double error = 0.0;   ///< standard error in the same unit, > 0
};

/// How a film's numbers follow from the hoop's motion. A point is X downhill along the plane and Y above it
/// [m]. Its positions in the film are x + (X cos a + Y sin a) / scale and y + (Y cos a - X sin a) / scale.
/// The angle a by which the plane descends in the film is tilt, or slope + tilt if the film is level.
struct Camera {
  double time_offset = 0.0;   ///< time of the release in the film [s]; before it the hoop is held
  double angle_offset = 0.0;  ///< the hoop's angle phi where the film's angle is 0 [rad]
  double scale = 1.0;         ///< metres per unit of positions
  double tilt = 0.0;          ///< [rad]
  double x = 0.0;             ///< of where the hoop's centre would touch the plane at the release
  double y = 0.0;             ///< likewise
};

/// A measured motion over time: angles, or points of the hoop.
struct Film {
  std::vector<double> t{};      ///< times of the angles [s], ascending
  std::vector<double> phi{};    ///< angles [rad]; NaN: none at that time; empty: points are given
  std::vector<double> spin{};   ///< angular velocities at these times [rad/s]; NaN: none; empty: not measured
  std::vector<Track> tracks{};  ///< of points; y is upwards, and the hoop moves towards larger x
  bool is_level = false;        ///< x is horizontal; false: x is along the plane, downhill
  std::string unit = "m";       ///< of positions, for reports
  Camera camera{};              ///< values of what is fixed, and first estimates of what is free
  std::vector<std::string> free{};  ///< names of the camera's numbers that are free; x and y always are
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error; NaN: from the residuals
  bool allow_gaps = false;  ///< accept gaps of five time steps or more between angles
};

/// Measurements: events or a film.
struct Measurements {
  std::string origin{};                 ///< file name for messages
  std::vector<MeasuredEvent> events{};  ///< empty: a film is given
  Film film{};                          ///< used if there are no events
  std::vector<std::string> notes{};     ///< how a film was understood, a line each
  std::vector<long> lines{};            ///< line numbers of the file for messages; empty: counted from 1
};

/// A mark on the hoop that a track follows.
struct Marker {
  std::string track{};  ///< name of the track; empty: the only one that is not the centre's
  double at = 0.0;      ///< distance from the axis [m]
  double angle = 0.0;   ///< direction, counted as the weights' of a [hoop], or from the mass [rad]
};

/// How read_measurements interprets a film.
struct MeasurementOptions {
  double scale = std::numeric_limits<double>::quiet_NaN();  ///< metres per unit of positions; NaN: found
  bool y_down = false;  ///< y grows towards the plane, as rows of a picture do; false: found from two tracks
  bool allow_gaps = false;                                  ///< accept gaps of five time steps or more
  double error = std::numeric_limits<double>::quiet_NaN();  ///< standard error [rad or m]; NaN: unknown
  std::vector<Marker> markers{};  ///< where tracks are on the hoop; others are found from their names
  std::vector<std::string>
      free{};  ///< of time_offset, angle_offset, scale, tilt; more are freed if a film needs it
  RecordingOptions recording{};  ///< how to read the files
};

/// Reads measurements of one motion: a CSV file with the columns event, value, error; or films, as read_film
/// does. Units, axes, marks and the time of the release are found from the film and the hoop.
/// @param paths  of one file of events, or of one or more films
/// @param spec   the hoop that was filmed
/// @throws InputError with line and column for anything that is not a number, and for a film that does not
/// fit the
///         hoop; IoError
Measurements read_measurements(const std::vector<std::string>& paths, const Spec& spec,
                               const MeasurementOptions& options = {});

/// Measurements of one motion as recorded, understood as read_measurements does.
/// @throws InputError for a recording that does not fit the hoop
Measurements measurements_of(const Recording& recording, const Spec& spec,
                             const MeasurementOptions& options = {});

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
  Camera camera{};                ///< the best fit's, of a film
  bool found = false;             ///< false: no design within the bounds shows all that was measured
  std::string why{};              ///< reason why the model was not fitted, if it was not
  Outcome outcome{};              ///< outcome of the best fit
  std::size_t after_landing = 0;  ///< lines of a film after the model's last landing; not used
  std::vector<FittedParameter> parameters{};  ///< in the spec's order
  std::vector<double> correlations{};         ///< matrix, row by row, of size parameters x parameters
  double chi_square = std::numeric_limits<double>::quiet_NaN();  ///< sum of squares of residuals over errors
  std::size_t degrees = 0;                                       ///< degrees of freedom
  double error = 0.0;  ///< film: rms of the residuals, in its own unit
  /// Probability of a chi-square at least as large if the model is true; NaN: errors are unknown.
  double probability = std::numeric_limits<double>::quiet_NaN();
  /// Film: rms of the residuals over their scatter from line to line.
  double misfit = std::numeric_limits<double>::quiet_NaN();
  double correlation = 1.0;  ///< film: number of neighbouring lines whose residuals count as one
  double independent = std::numeric_limits<double>::quiet_NaN();  ///< film: number of independent lines
  bool judged = true;  ///< false: the film has too few lines to accept or reject the model
  double information = std::numeric_limits<double>::infinity();  ///< Akaike's criterion; less is better
  std::vector<double> model{};  ///< the model's value of every number measured
  /// Model less measured, of every number: of events over their errors, of a film in its own unit.
  std::vector<double> residuals{};
  std::vector<std::size_t> outliers{};  ///< with a robust loss: numbers measured that hardly count
  std::size_t starts = 0;               ///< number of starting points followed
  std::size_t evaluations = 0;          ///< number of designs solved
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

/// What residuals count.
enum class Loss {
  squares,  ///< their squares: for normal errors
  huber     ///< squares up to 1.345 standard errors, then only their size: for films with bad points
};

/// Those of names that a fit may free that are of the hoop, not of the camera.
std::vector<std::string> parameters_among(const std::vector<std::string>& names);

/// Options of fit.
struct FitOptions {
  std::vector<Friction> models{Friction::sticking, Friction::coulomb};  ///< models to fit
  std::vector<std::string> free{};  ///< parameters that are free beside the spec's axes, within usual bounds
  Loss loss = Loss::squares;        ///< of a film's residuals
  std::uint64_t seed = 1;           ///< of the initial sample; equal seeds give equal fits
  std::size_t coarse = 0;  ///< size of the initial sample, a multiple of 16; 0: 2,048 for a film, else 65,536
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
