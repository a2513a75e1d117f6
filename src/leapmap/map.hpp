// SPDX-License-Identifier: GPL-3.0-or-later
/// Reads a map: axes, fields, attributes.
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

class Map {
 public:
  /// Opens a map, or the .part of one. Throws IoError if it is no map, or holds what no map does; InputError
  /// while a sweep is writing it. lock: as in SweepOptions. HDF5 is one for the whole program: not while
  /// another of its threads reads or sweeps.
  explicit Map(const std::string& path, bool lock = true);
  ~Map();
  Map(Map&&) noexcept;
  Map& operator=(Map&&) noexcept;

  /// Axes in spec order; a list of designs has none.
  std::vector<Axis> axes() const;
  /// The length of each dimension: of each axis, or of the list.
  std::vector<std::size_t> shape() const;
  /// Every dataset along all dimensions: the fields and, of a list, its parameters.
  std::vector<std::string> fields() const;
  std::string unit(const std::string& field) const;
  /// The names of a list's designs; empty: it has none.
  std::vector<std::string> labels() const;
  /// A whole field in C order, the last axis fastest; codes as numbers, and a phase_sequence
  /// exactly up to 26 phases. Throws InputError if the map has no such field, IoError.
  std::vector<double> read(const std::string& field) const;
  /// The block of a field that starts at `start` and reaches `extent` far along each dimension.
  std::vector<double> read(const std::string& field, const std::vector<std::size_t>& start,
                           const std::vector<std::size_t>& extent) const;

  /// False for what a sweep left that was stopped: designs not computed are holes.
  bool is_whole() const;
  StatusCounts status_counts() const;
  /// The spec that made it.
  Spec spec() const;
  /// What its audit found; unset: it was not audited.
  std::optional<AuditReport> audit() const;
  /// A root attribute as text, numbers in their shortest form; empty if it is not there.
  std::string attribute(const std::string& name) const;

 private:
  std::string path_;
  std::unique_ptr<MapReader> reader_;
};

}  // namespace leapmap
