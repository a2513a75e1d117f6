// SPDX-License-Identifier: GPL-3.0-or-later
/// The designs of a spec by number, without ever holding them all.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "hoop/body.hpp"
#include "map/tile.hpp"
#include "model/variable.hpp"
#include "spec/options.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// The length of each dimension of the spec's map: its axes, or one list.
std::vector<std::size_t> shape_of(const Spec& spec);

/// How the spec's map is cut into tiles: where many hoops are made after each design, into smaller ones.
Tiling tiling_of(const Spec& spec);

/// The axis of that key, or the list's column; nullptr: it does not vary.
const Axis* find_varying(const Spec& spec, std::string_view key);

/// Designs by the values of some of a spec's numbers, each a parameter or a number of [hoop].
class VariedDesigns {
 public:
  /// The numbers are those of the axes; the rest is the spec's.
  VariedDesigns(const Spec& spec, const std::vector<Axis>& axes);

  const std::vector<Variable>& variables() const { return variables_; }
  bool varies_body() const { return varies_body_; }
  /// A value for each axis. The body may be left out.
  Design at(std::span<const double> values, Body* body = nullptr) const;

 private:
  Design design_;
  Body body_;
  double mass_ = 1.0;  // of the nominal body, if it varies
  std::vector<SameInSi> held_;
  std::vector<Variable> variables_;
  bool varies_body_ = false;
};

/// The values of a parameter along a spec's list of designs; of a parameter that is held, in the units of the
/// nominal hoop.
std::vector<double> list_values(const Spec& spec, const Option& parameter);

/// The designs of a tile, in its order.
class DesignSpace {
 public:
  /// Keeps a reference to spec.
  explicit DesignSpace(const Spec& spec);

  bool varies_body() const { return varied_.varies_body(); }
  const VariedDesigns& varied() const { return varied_; }
  /// The values along the axes, or of the list's columns, of design `index`.
  std::vector<double> values(std::size_t index) const;

  /// Design `index` in C order over the whole map.
  Design at(std::size_t index) const;
  /// Fills in a tile's designs `first`, first + 1, ...; bodies: empty, or theirs, as many.
  void fill(const Tile& tile, std::size_t first, std::span<Design> designs,
            std::span<Body> bodies = {}) const;

 private:
  void take_values(const std::vector<std::size_t>& position, std::vector<double>& values) const;

  const Spec& spec_;
  VariedDesigns varied_;  // along the axes, or by the list's columns
};

/// A design's number and, in a list that has labels, its name.
std::string told_design(const Spec& spec, std::size_t number);

/// The command line that solves this design alone, every digit of it.
std::string hop_command(const Spec& spec, const Design& design);

}  // namespace leapmap
