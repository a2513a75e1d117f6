// SPDX-License-Identifier: GPL-3.0-or-later
/// Python's keyword arguments as designs and a scene: numbers, arrays that broadcast, angles like "30 deg".
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"
#include "spec/options.hpp"

namespace leapmap::python {

inline constexpr std::array<std::string_view, 2> words{"model",
                                                       "motor_law"};  ///< a scene's, but for friction
inline constexpr std::string_view motor_switch = "motor_in_flight";   ///< a scene's bool
/// Numbers of the scene that are whole.
inline constexpr std::array<std::pair<std::string_view, long Scene::*>, 3> whole_numbers{
    {{"jumps", &Scene::jumps}, {"settle", &Scene::settle}, {"most_period", &Scene::most_period}}};

/// The designs of one call: one number or one array for each parameter, of shapes that broadcast.
class Designs {
 public:
  /// Reads the parameters of designs and of the scene from `given`. Throws InputError, naming the parameter,
  /// for one that is not known, is no number, or has a shape that does not fit.
  Designs(const pybind11::dict& given, Scene scene);

  const Scene& scene() const { return scene_; }
  const std::vector<pybind11::ssize_t>& shape() const { return shape_; }  ///< empty: all are numbers
  std::size_t count() const { return count_; }

  /// Designs first, first + 1, ... in C order, the last dimension fastest. From any thread, Python's lock not
  /// needed.
  void fill(std::size_t first, std::span<Design> designs) const;

 private:
  static constexpr int aligned = pybind11::detail::npy_api::NPY_ARRAY_ALIGNED_;
  using Numbers = pybind11::array_t<double, int{pybind11::array::forcecast} | aligned>;
  struct Column {
    std::string name;
    double Design::*member;
    Numbers numbers;  // keeps the memory
    const char* begin;
    std::vector<pybind11::ssize_t> strides;  // of the broadcast shape, in bytes; 0 along what is repeated
  };

  void take(const std::string& name, const pybind11::handle& value);
  void take_word(const Option& option, const pybind11::handle& value);
  void broadcast();

  Scene scene_;
  Design common_;
  std::vector<Column> columns_;
  std::vector<pybind11::ssize_t> shape_;
  std::size_t count_ = 1;
};

}  // namespace leapmap::python
