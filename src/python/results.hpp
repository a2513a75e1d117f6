// SPDX-License-Identifier: GPL-3.0-or-later
/// Outcomes and motions as dictionaries of numpy arrays.
#pragma once

#include <pybind11/numpy.h>

#include <span>
#include <string>
#include <vector>

#include "leapmap/motion.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/scatter.hpp"
#include "leapmap/scene.hpp"
#include "model/fields.hpp"

namespace leapmap::python {

/// One array for each field asked for.
class Columns {
 public:
  /// fields: their names; empty: all that the scene's model has. Throws InputError for one it has not.
  Columns(const std::vector<std::string>& fields, const Scene& scene,
          const std::vector<pybind11::ssize_t>& shape);

  std::vector<const Field*> fields() const;

  /// Takes outcomes first, first + 1, ...; from any thread, Python's lock not needed.
  void take(std::size_t first, std::span<const Outcome> outcomes);

  /// By name, in the order of a map's fields.
  pybind11::dict arrays() const;

 private:
  struct Column {
    const Field* field;
    pybind11::array array;
    void* begin;
  };
  std::vector<Column> columns_;
};

pybind11::dict dict_of(const Motion& motion, const Scene& scene);

/// The gravity, and the radius and mass of each design's hoop; no mass if nobody weighed it.
pybind11::dict scales_of_each(const Spec& spec, std::span<const Design> designs);

/// Estimates as pairs of value and error; what is of spreads and goals by their names.
pybind11::dict dict_of(const ScatterReport& report, const Spec& spec);

}  // namespace leapmap::python
