// SPDX-License-Identifier: GPL-3.0-or-later
/// A design's motion on disk: one dataset a quantity along the dimension `t`, its lift-offs along
/// `candidate`.
#pragma once

#include <span>
#include <string>

#include "map/hdf5.hpp"
#include "trajectory/story.hpp"

namespace leapmap {

/// Writes the story in SI units (forces in weights) as a netCDF-readable HDF5 file, replacing path only once
/// it is whole. Throws InputError if path is a file other than a trace, IoError if it cannot be written.
void write_trace(const std::string& path, const Story& story, const Scene& scene,
                 std::span<const hdf5::Attribute> attributes);

}  // namespace leapmap
