// SPDX-License-Identifier: GPL-3.0-or-later
/// The reference tables of tests/reference as designs and outcomes.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "hoop/parameters.hpp"

namespace leapmap::testing {

/// One line of a table: cells by column name; an empty cell does not apply.
struct ReferenceRow {
  std::map<std::string, std::string> cells;

  bool has(const std::string& name) const { return !cells.at(name).empty(); }
  double number(const std::string& name) const { return std::stod(cells.at(name)); }
  Design design() const {
    Design design{number("slope"),          number("mass_ratio"),    number("offset_ratio"),
                  number("inertia_factor"), number("release_angle"), number("release_spin")};
    if (cells.contains("drive_torque")) design.drive_torque = number("drive_torque");
    return design;
  }
};

inline std::vector<ReferenceRow> read_reference(const std::string& name) {
  std::ifstream file(std::string(LEAPMAP_REFERENCE_DIR "/") + name);
  if (!file) throw std::runtime_error("missing reference table " + name);
  const auto split = [](const std::string& line) {
    std::vector<std::string> cells;
    std::stringstream stream(line.substr(0, line.find('\r')) + ',');
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(file, line);
  const auto header = split(line);
  std::vector<ReferenceRow> rows;
  while (std::getline(file, line)) {
    const auto cells = split(line);
    ReferenceRow row;
    for (std::size_t i = 0; i < header.size(); ++i) row.cells[header[i]] = cells.at(i);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace leapmap::testing
