// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Films: points of a hoop over time, as programs for tracking and encoders write them.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "leapmap/errors.hpp"

namespace leapmap {

/// A point of the hoop that was followed through a film.
struct Track {
  std::string name{};  ///< of the film's own
  std::string file{};  ///< name of the file without folder and ending, if it holds no other track
  /// Distance of the point from the hoop's axis [m]; NaN: the distance L of the mass.
  double at = std::numeric_limits<double>::quiet_NaN();
  double angle = 0.0;       ///< direction of the point, counted from that of the mass [rad]
  std::vector<double> t{};  ///< times [s], ascending
  std::vector<double> x{};  ///< positions, in the recording's unit
  std::vector<double> y{};  ///< likewise
};

/// What files of one motion hold, before anything is known of the hoop.
struct Recording {
  std::vector<Track> tracks{};       ///< empty: angles are given
  std::vector<double> t{};           ///< times of the angles [s]
  std::vector<double> phi{};         ///< angles [rad], from a zero of their own; NaN: none in that row
  std::vector<double> spin{};        ///< angular velocities [rad/s]; empty: none; NaN: none in that row
  std::string unit{};                ///< of positions: "m", "px", or empty: not stated
  std::vector<std::string> notes{};  ///< how each file's columns were read, a line each
};

/// How to read recordings.
struct RecordingOptions {
  /// Frames per second, for files with frame numbers instead of times; NaN: not given.
  double fps = std::numeric_limits<double>::quiet_NaN();
  double least_likelihood = 0.6;  ///< below it a point of DeepLabCut's counts as missing
};

/// Reads the files of one motion: Tracker's projects (.trk, .trz) and text, DLTdv, DeepLabCut, Kinovea, logs
/// of encoders, and CSV.
/// @throws InputError with file, line and what is allowed; IoError
Recording read_film(const std::vector<std::string>& paths, const RecordingOptions& options = {});

/// Checks a recording.
/// @param origin  for messages
/// @throws InputError for columns of different sizes, times that do not ascend, numbers that are not finite
void check_recording(const Recording& recording, const std::string& origin);

}  // namespace leapmap
