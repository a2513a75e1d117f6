// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Reading a map: axes, fields, attributes.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "leapmap/audit.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/spec.hpp"

namespace leapmap {

class MapReader;

/// An open map. Not thread-safe: HDF5 has one state for the whole program, so no other thread may read or
/// write maps at the same time.
class Map {
 public:
  /// Opens a map, or the .part of an unfinished one.
  /// @param lock  as in SweepOptions
  /// @throws IoError if the file is not a map; InputError while a sweep is writing it
  explicit Map(const std::string& path, bool lock = true);
  /// Closes the file.
  ~Map();
  /// Moves.
  Map(Map&&) noexcept;
  /// Moves.
  Map& operator=(Map&&) noexcept;

  /// Axes in the spec's order; empty for a list of designs.
  std::vector<Axis> axes() const;
  /// Length of each dimension: one for each axis, or one for a list.
  std::vector<std::size_t> shape() const;
  /// Names of the datasets along all dimensions: the fields and, for a list, its parameters.
  std::vector<std::string> fields() const;
  /// Unit of a field, as UDUNITS reads it; "1": a pure number.
  /// @throws InputError if the map has no such field
  std::string unit(const std::string& field) const;
  /// Labels of a list's designs; empty: there are none.
  std::vector<std::string> labels() const;
  /// A whole field in C order, the last axis fastest. Codes are converted to numbers; a phase_sequence is
  /// exact up to 26 phases.
  /// @throws InputError if the map has no such field; IoError
  std::vector<double> read(const std::string& field) const;
  /// A block of a field.
  /// @param start   index of its first design along each dimension
  /// @param extent  its length along each dimension
  /// @throws InputError if the map has no such field or the block is outside; IoError
  std::vector<double> read(const std::string& field, const std::vector<std::size_t>& start,
                           const std::vector<std::size_t>& extent) const;

  /// Whether all designs are computed. An interrupted sweep leaves an incomplete map.
  bool is_whole() const;
  /// Number of designs with each status.
  StatusCounts status_counts() const;
  /// The spec that the map was made from.
  Spec spec() const;
  /// Result of the sweep's cross-check; unset: there was none.
  std::optional<AuditReport> audit() const;
  /// A root attribute as text, numbers in their shortest form; empty if it does not exist.
  std::string attribute(const std::string& name) const;

 private:
  std::string path_;
  std::unique_ptr<MapReader> reader_;
};

}  // namespace leapmap
