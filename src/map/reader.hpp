// SPDX-License-Identifier: GPL-3.0-or-later
/// Reads a map, or the .part of one: its axes, attributes and fields, a block at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "leapmap/outcome.hpp"
#include "map/hdf5_driver.hpp"
#include "map/tile.hpp"

namespace leapmap {

/// Whether a shard of a map, most of which is holes, is read as well.
enum class Accept { maps, shards_too };

class MapReader {
 public:
  /// Opens a map (or the .part of one). Throws IoError if it is no leapmap map, of a newer major version, or
  /// holds what no map does (hdf5_trust.hpp), InputError while a sweep is writing it, or if it is a shard,
  /// BrokenFile if it is virtual and its shards are not those that it was made of.
  explicit MapReader(const std::string& path, Locking locking = Locking::required,
                     Accept accept = Accept::maps);
  /// Reads a file that is open already and stays so; path is for messages.
  MapReader(const std::string& path, hid_t file, Accept accept = Accept::maps);

  /// A dimension: its name, unit and length, and the values of an axis. A list's one dimension, `design`,
  /// counts from 0 and has no values here.
  struct Dimension {
    std::string name, unit;
    std::size_t size = 0;
    std::vector<double> values;
  };
  const std::vector<Dimension>& dimensions() const { return dimensions_; }
  std::vector<std::size_t> shape() const;
  bool is_list() const { return dimensions_[0].name == "design"; }
  /// The blocks in which a field is stored: its chunks, or some of a size that memory bears.
  Tiling blocks(const std::string& field) const;

  /// The datasets that lie along all dimensions, in file order: the fields and, in a list, its parameters;
  /// its labels are not among them.
  const std::vector<std::string>& fields() const { return fields_; }
  bool has(const std::string& field) const { return std::ranges::find(fields_, field) != fields_.end(); }
  std::string unit(const std::string& field) const;
  /// The names of a list's designs; empty: it has none. Throws IoError.
  std::vector<std::string> labels() const;

  /// As it was opened.
  const std::string& path() const { return path_; }

  /// The shards in which the values of a virtual map lie, beside it; none: they are its own.
  const std::vector<std::string>& shards() const { return shards_; }

  /// False for what a sweep left that was stopped: designs not computed are holes.
  bool is_whole() const;

  /// Designs by how they ended, counted as they were written, whether status is stored or not. Throws IoError
  /// if the map is older than that.
  StatusCounts status_counts() const;

  /// A root attribute as text, numbers in their shortest form; empty if it is not there.
  std::string attribute(const std::string& name) const;

  /// The root, for attributes of other kinds.
  hid_t file() const { return file_; }

  /// A block of a field, C order; codes as numbers. Throws IoError.
  std::vector<double> read(const std::string& field, const Tile& block) const;
  /// The same of a field of words, of which a double would not hold every bit.
  std::vector<std::uint64_t> read_words(const std::string& field, const Tile& block) const;
  /// Opens a dataset of the root. Throws IoError.
  hdf5::Handle open(const std::string& dataset) const;

 private:
  void survey(Accept accept);
  void check_shards() const;
  void rethrow_failure() const;

  std::string path_;
  hdf5::File own_;
  hid_t file_;
  std::vector<Dimension> dimensions_;
  std::vector<std::string> fields_;
  std::vector<std::string> shards_;
  bool has_labels_ = false;
};

}  // namespace leapmap
