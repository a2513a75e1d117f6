// SPDX-License-Identifier: GPL-3.0-or-later
/// A design's motion on disk: one dataset a quantity along the dimension `t`, its lift-offs along
/// `candidate`.
#pragma once

#include <span>
#include <string>

#include "leapmap/motion.hpp"
#include "map/hdf5.hpp"
#include "map/journaled_file.hpp"

namespace leapmap {

/// Writes the motion as a netCDF-readable HDF5 file, replacing path only once
/// it is whole and was read again. Returns false if a power cut may undo that (JournaledFile::rename). Throws
/// InputError if path is a file other than a trace, IoError if it cannot be written.
[[nodiscard]] bool write_trace(const std::string& path, const Motion& motion,
                               std::span<const hdf5::Attribute> attributes, Locking locking);

}  // namespace leapmap
