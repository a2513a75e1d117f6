// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/hoops.hpp"

#include <array>
#include <span>

#include "hoop/body.hpp"
#include "leapmap/body.hpp"
#include "model/variable.hpp"
#include "spec/options.hpp"
#include "spec/quantity.hpp"

namespace py = pybind11;

namespace leapmap::python {
namespace {

using Numbers = py::array_t<double>;

std::span<const double> row_of(const Rows& table, py::ssize_t row) {
  return {table.data(row, 0), static_cast<std::size_t>(table.shape(1))};
}

Body body_of(std::span<const double> numbers, const std::vector<std::string>& weights) {
  Body body{.diameter = numbers[0], .mass = numbers[1], .inertia = numbers[2], .weights = {}};
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const auto own = numbers.subspan(3 + 4 * k);
    body.weights.push_back({weights[k], own[0], own[1], own[2], own[3]});
  }
  return body;
}

}  // namespace

py::dict reduce_hoops(const Rows& hoops, const std::vector<std::string>& weights) {
  struct Column {
    const char* name;
    double ReducedBody::*member;
    Numbers values;
  };
  const py::ssize_t count = hoops.shape(0);
  std::array columns{Column{"total_mass", &ReducedBody::total_mass, Numbers(count)},
                     Column{"eccentricity", &ReducedBody::eccentricity, Numbers(count)},
                     Column{"inertia_ratio", &ReducedBody::inertia, Numbers(count)},
                     Column{"mass_ratio", &ReducedBody::mass_ratio, Numbers(count)},
                     Column{"offset_ratio", &ReducedBody::offset_ratio, Numbers(count)},
                     Column{"inertia_factor", &ReducedBody::inertia_factor, Numbers(count)}};
  for (py::ssize_t i = 0; i < count; ++i) {
    const ReducedBody reduced = reduce_body(body_of(row_of(hoops, i), weights));
    for (Column& column : columns) column.values.mutable_at(i) = reduced.*column.member;
  }
  py::dict arrays;
  for (const Column& column : columns) arrays[column.name] = column.values;
  return arrays;
}

py::dict differentiate_by_hoop(const Rows& hoops, const std::vector<std::string>& weights, const Rows& by) {
  const py::ssize_t count = hoops.shape(0);
  const std::vector<double> none(static_cast<std::size_t>(hoops.shape(1)),
                                 1.0);  // an empty batch has names, too
  const std::vector<Variable> variables =
      variables_of(body_of(count > 0 ? row_of(hoops, 0) : std::span<const double>(none), weights));
  std::vector<Numbers> columns;
  for (std::size_t k = 0; k < variables.size(); ++k) columns.emplace_back(count);
  for (py::ssize_t i = 0; i < count; ++i) {
    const Body body = body_of(row_of(hoops, i), weights);
    Design by_ratios;
    for (std::size_t k = 0; k < body_ratios.size(); ++k)
      by_ratios.*body_ratios[k] = by.at(i, static_cast<py::ssize_t>(k));
    constexpr py::ssize_t after = body_ratios.size();
    const ByScale by_scale{by.at(i, after), by.at(i, after + 1)};
    for (std::size_t k = 0; k < variables.size(); ++k)
      columns[k].mutable_at(i) = variables[k].derivative(by_ratios, body, by_scale);
  }
  py::dict arrays;
  for (std::size_t k = 0; k < variables.size(); ++k) arrays[py::str(variables[k].key)] = columns[k];
  return arrays;
}

py::object powers_in_si(const std::string& parameter, const std::string& text) {
  const Option* option = find_option("design", parameter);
  const auto* slot = option ? std::get_if<ParameterSlot>(&option->slot) : nullptr;
  for (const SameInSi& one : same_in_si)
    if (slot && slot->member == one.parameter && number_in_si(text, *find_own_unit(option->unit)))
      return py::make_tuple(one.with_mass, one.with_size);
  return py::none();
}

}  // namespace leapmap::python
