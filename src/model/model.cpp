// SPDX-License-Identifier: GPL-3.0-or-later
/// The kernels that the program was built with, and which of them is in use.
#include "model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "leapmap/errors.hpp"
#include "leapmap/version.hpp"
#include "model/kernels.hpp"

// kernel_list.inc, written by CMake: a line KERNELS(function, "name") for each instruction set, lowest first.
#define KERNELS(function, name) extern "C" const leapmap::Kernels* function();
#include "kernel_list.inc"
#undef KERNELS

namespace leapmap {
namespace {

struct Built {
  std::string_view name;
  const Kernels* (*kernels)();
};
constexpr Built built[]{
#define KERNELS(function, name) {name, function},
#include "kernel_list.inc"
#undef KERNELS
};

bool machine_has(std::string_view set) {
#ifdef __x86_64__
  __builtin_cpu_init();
  const bool v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (set == "x86-64-v3") return v3;
  if (set == "x86-64-v4")
    return v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#endif
  // Nothing is known of other names: such a set is for the machine that it was built on.
  return std::size(built) == 1 || set == "x86-64";
}

const Built* best() {
  const Built* found = nullptr;
  for (const Built& set : built)
    if (machine_has(set.name)) found = &set;
  return found;
}

std::atomic<const Built*>& chosen() {
  static std::atomic<const Built*> set = best();
  return set;
}

const Built& in_use() {
  if (const Built* set = chosen()) return *set;
  throw std::runtime_error(
      fmt::format("was built for {}, which this machine does not have; build it with "
                  "cmake --preset package",
                  built[0].name));
}

}  // namespace

const Kernels& kernels() { return *in_use().kernels(); }

std::span<const Model> models() { return kernels().models; }

namespace {

std::deque<Model>& added() {
  static std::deque<Model> models;
  return models;
}

}  // namespace

void add_model(const Model& model) { added().push_back(model); }

const Model* find_model(std::string_view name) {
  for (const Model& model : models())
    if (model.name == name) return &model;
  const auto found = std::ranges::find(added(), name, &Model::name);
  return found == added().end() ? nullptr : &*found;
}

std::vector<std::string_view> model_names() {
  std::vector<std::string_view> names;
  for (const Model& model : models())
    if (model.mechanism == Mechanism::hoop) names.push_back(model.name);
  for (const Model& model : added()) names.push_back(model.name);
  return names;
}

const Model& model_of(const Scene& scene) {
  for (const Model& model : models())
    if (model.friction == scene.friction && model.mechanism == scene.model) return model;
  return *std::ranges::find(added(), scene.friction, &Model::friction);
}

void refuse_lack(const Model& model, std::string_view what) {
  const bool is_hoop = model.mechanism == Mechanism::hoop;
  throw InputError(fmt::format("scene.{} = \"{}\": this model has no {}; allowed: a model that has",
                               is_hoop ? "friction" : "model",
                               is_hoop ? model.name : name_of(model.mechanism), what));
}

std::string instruction_set() { return fmt::format("{}, {} lanes", in_use().name, kernels().lanes); }

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const Built& set : built)
    if (machine_has(set.name)) names.emplace_back(set.name);
  return names;
}

bool uses_best_instruction_set() { return &in_use() == best(); }

void use_instruction_set(std::string_view name) {
  const auto found = std::ranges::find(built, name, &Built::name);
  if (found == std::end(built) || !machine_has(name))
    throw InputError(fmt::format("instruction set '{}' is {}; allowed: one of {}", name,
                                 found == std::end(built) ? "not built in" : "not this machine's",
                                 fmt::join(instruction_sets(), ", ")));
  chosen() = found;
}

}  // namespace leapmap
