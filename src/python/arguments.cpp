// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "leapmap/errors.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "spec/options.hpp"
#include "support/closest.hpp"

namespace py = pybind11;

namespace leapmap::python {
namespace {

std::string shown(const py::handle& value) {
  const py::object text = py::repr(value);  // cut by characters, not by bytes
  constexpr int most = 60;
  const auto begin = py::reinterpret_steal<py::str>(PyUnicode_Substring(text.ptr(), 0, most));
  return std::string(begin) + (py::len(text) > most ? "..." : "");
}

/// Real numbers, none of them masked; anything else that numpy would turn into numbers is a mistake.
bool is_numbers(const py::handle& value, const py::array& array) {
  const char kind = array.dtype().kind();
  return (kind == 'f' || kind == 'i' || kind == 'u') &&
         !py::module_::import("numpy").attr("ma").attr("is_masked")(value).cast<bool>();
}

const Parameter& parameter_of(const std::string& name) {
  for (const Parameter& parameter : parameters())
    if (parameter.name == name) return parameter;
  std::vector<std::string_view> names{"friction", motor_switch};
  names.insert(names.end(), words.begin(), words.end());
  for (const auto& [key, member] : whole_numbers) names.push_back(key);
  for (const Parameter& parameter : parameters()) names.push_back(parameter.name);
  throw InputError(fmt::format("{}: unknown parameter{}; allowed: {}", name, did_you_mean(name, names),
                               fmt::join(names, ", ")));
}

}  // namespace

Designs::Designs(const py::dict& given, Scene scene) : scene_(scene) {
  // What other numbers and their units hang on comes first.
  constexpr std::array first{"model", "motor_law", "radius", "gravity", "mass"};
  for (const char* name : first)
    if (given.contains(name)) take(name, given[name]);
  for (const auto& [key, value] : given)
    if (const auto name = py::cast<std::string>(key); std::ranges::find(first, name) == first.end())
      take(name, value);
  broadcast();
}

/// A word of the scene: its model, or the law of its motor.
void Designs::take_word(const Option& option, const py::handle& value) {
  const std::string word = py::isinstance<py::str>(value) ? py::cast<std::string>(value) : std::string();
  if (!is_choice(option, word))
    throw InputError(
        fmt::format("{} = {} is unknown; allowed: {}", option.key, shown(value), allowed_values(option)));
  if (!has(scene_, option.only_of))
    throw InputError(fmt::format("{} = {} {}; allowed: {}", option.key, shown(value),
                                 no_use(scene_, option.only_of), with_model(option.only_of)));
  std::get<WordSlot>(option.slot).set(scene_, word);
}

void Designs::take(const std::string& name, const py::handle& value) {
  for (const auto& [key, member] : whole_numbers) {
    if (name != key) continue;
    if (!py::isinstance<py::int_>(value))
      throw InputError(fmt::format("{} = {} is not a whole number; allowed: {}", name, shown(value),
                                   allowed_values(*find_option("", key))));
    scene_.*member = py::cast<long>(value);
    return;
  }
  if (name == motor_switch) {
    if (!py::isinstance<py::bool_>(value))
      throw InputError(fmt::format("{} = {} is not a bool; allowed: True, False", name, shown(value)));
    scene_.motor_in_flight = py::cast<bool>(value);
    return;
  }
  if (std::ranges::find(words, name) != words.end()) return take_word(*find_option("", name), value);
  const Parameter& parameter = parameter_of(name);
  if (!has(scene_, parameter.only_of))
    throw InputError(fmt::format("{} = {} {}; allowed: {}", name, shown(value),
                                 no_use(scene_, parameter.only_of), with_model(parameter.only_of)));
  const auto put = [&](double number) {
    if (const auto* member = std::get_if<double Design::*>(&parameter.member)) {
      common_.** member = number;
    } else {
      scene_.*std::get<double Scene::*>(parameter.member) = number;
    }
  };
  if (PyFloat_Check(value.ptr())) return put(PyFloat_AS_DOUBLE(value.ptr()));
  if (py::isinstance<py::str>(value)) {
    try {
      return put(parse_number(*find_option({}, name), py::cast<std::string>(value), scales_of(scene_)));
    } catch (const py::cast_error&) {  // no UTF-8
      throw InputError(fmt::format("{} = {} is not a number", name, shown(value)));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{} = {}", name, error.what()));
    }
  }
  const auto array = py::array::ensure(value);
  const auto numbers = array && is_numbers(value, array) ? Numbers::ensure(array)
                                                         : py::reinterpret_steal<Numbers>(py::handle());
  if (!numbers) {
    PyErr_Clear();
    throw InputError(fmt::format("{} = {} is not a number or an array of numbers; allowed: {}", name,
                                 shown(value), allowed_values(parameter.range, parameter.unit)));
  }
  if (numbers.ndim() == 0) return put(*numbers.data());
  const auto* member = std::get_if<double Design::*>(&parameter.member);
  if (!member)
    throw InputError(fmt::format("{} = {} is an array; allowed: one number, for all designs of a call", name,
                                 shown(value)));
  columns_.push_back({name, *member, numbers, reinterpret_cast<const char*>(numbers.data()), {}});
}

void Designs::broadcast() {
  std::size_t dimensions = 0;
  for (const Column& column : columns_)
    dimensions = std::max(dimensions, static_cast<std::size_t>(column.numbers.ndim()));
  shape_.assign(dimensions, 1);
  const auto along = [&](const Column& column, std::size_t d, const py::ssize_t* of) -> py::ssize_t {
    const std::size_t missing = dimensions - static_cast<std::size_t>(column.numbers.ndim());
    return d < missing ? -1 : of[d - missing];
  };
  for (std::size_t d = 0; d < dimensions; ++d) {
    for (const Column& column : columns_) {
      const py::ssize_t extent = along(column, d, column.numbers.shape());
      if (extent < 0 || extent == 1 || extent == shape_[d]) continue;
      if (shape_[d] == 1) {
        shape_[d] = extent;
        continue;
      }
      std::vector<std::string> shapes;
      for (const Column& one : columns_)
        shapes.push_back(
            fmt::format("{} ({})", one.name,
                        fmt::join(one.numbers.shape(), one.numbers.shape() + one.numbers.ndim(), ", ")));
      throw InputError(
          fmt::format("shapes do not broadcast: {}; allowed: equal lengths, or 1, along each dimension",
                      fmt::join(shapes, ", ")));
    }
  }
  for (Column& column : columns_)
    for (std::size_t d = 0; d < dimensions; ++d)
      column.strides.push_back(
          along(column, d, column.numbers.shape()) <= 1 ? 0 : along(column, d, column.numbers.strides()));
  for (const py::ssize_t extent : shape_) count_ *= static_cast<std::size_t>(extent);
}

void Designs::fill(std::size_t first, std::span<Design> designs) const {
  if (designs.empty()) return;  // a shape without designs has no places to count
  std::fill(designs.begin(), designs.end(), common_);
  for (const Column& column : columns_) {
    std::vector<std::size_t> index(shape_.size());
    std::size_t rest = first;
    for (std::size_t d = shape_.size(); d-- > 0; rest /= static_cast<std::size_t>(shape_[d]))
      index[d] = rest % static_cast<std::size_t>(shape_[d]);
    // Runs along the last dimension, with the place in the others carried on.
    const std::size_t last = shape_.size() - 1, length = static_cast<std::size_t>(shape_[last]);
    for (std::size_t i = 0; i < designs.size();) {
      const char* at = column.begin;
      for (std::size_t d = 0; d <= last; ++d) at += static_cast<py::ssize_t>(index[d]) * column.strides[d];
      const std::size_t run = std::min(designs.size() - i, length - index[last]);
      for (std::size_t k = 0; k < run; ++k, ++i, at += column.strides[last])
        designs[i].*column.member = *reinterpret_cast<const double*>(at);
      index[last] = 0;
      for (std::size_t d = last; d-- > 0;) {
        if (++index[d] < static_cast<std::size_t>(shape_[d])) break;
        index[d] = 0;
      }
    }
  }
}

}  // namespace leapmap::python
