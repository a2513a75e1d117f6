// SPDX-License-Identifier: GPL-3.0-or-later
/// The kernels that the program was built with, and which of them is in use.
#include "model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
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
#if defined(__x86_64__) && !defined(__clang__)
  if (set == "x86-64-v4") return __builtin_cpu_supports("x86-64-v4");
  if (set == "x86-64-v3") return __builtin_cpu_supports("x86-64-v3");
  if (set == "x86-64-v2") return __builtin_cpu_supports("x86-64-v2");
#endif
  return !set.empty();  // any other is the machine's own, or what every machine has
}

const Built* best() {
  const Built* found = built;
  for (const Built& set : built)
    if (machine_has(set.name)) found = &set;
  return found;
}

std::atomic<const Built*>& chosen() {
  static std::atomic<const Built*> set = best();
  return set;
}

}  // namespace

const Kernels& kernels() { return *chosen().load()->kernels(); }

std::span<const Model> models() { return kernels().models; }

const Model& model_of(Friction friction) { return *std::ranges::find(models(), friction, &Model::friction); }

std::string instruction_set() { return fmt::format("{}, {} lanes", chosen().load()->name, kernels().lanes); }

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  for (const Built& set : built)
    if (machine_has(set.name)) names.emplace_back(set.name);
  return names;
}

void use_instruction_set(std::string_view name) {
  const auto found = std::ranges::find(built, name, &Built::name);
  if (found == std::end(built) || !machine_has(name))
    throw InputError(fmt::format("instruction set '{}' is {}; allowed: one of {}", name,
                                 found == std::end(built) ? "not built in" : "not this machine's",
                                 fmt::join(instruction_sets(), ", ")));
  chosen() = found;
}

}  // namespace leapmap
