// SPDX-License-Identifier: GPL-3.0-or-later
/// The kernels: all that is compiled once for each instruction set, and what the rest of the library sees of
/// it. cmake/kernels.cmake makes everything in them invisible to each other and to the rest: not even an
/// inline function compiled for a newer machine can become the one that an older one runs.
#pragma once

#include <span>

#include "model/model.hpp"

namespace leapmap {

struct Kernels {
  std::span<const Model> models;
  int lanes;  ///< doubles that one instruction works on
};

/// Those in use: of the instruction set chosen, or the best that this machine has.
const Kernels& kernels();

}  // namespace leapmap
