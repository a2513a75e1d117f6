// SPDX-License-Identifier: GPL-3.0-or-later
/// Virtual datasets: those whose values lie in datasets of the same name in files beside it, the shards of a
/// map. HDF5 fills what a source does not give with the fill value and says nothing, so that whoever reads
/// one sees to it first that all are there (MapReader).
#pragma once

#include <hdf5.h>

#include <span>
#include <string>
#include <vector>

namespace leapmap::hdf5 {

/// A block of a dataset.
struct Block {
  std::vector<hsize_t> start, extent;
};

/// Part of a virtual dataset: blocks of it, which lie at the same places in the source's.
struct Source {
  std::string file;  ///< beside the virtual dataset's, without a folder
  std::vector<Block> blocks;
};

/// Makes a dataset of that shape and name virtual, by the property list that is to create it; not, without
/// sources. Throws IoError.
void add_sources(hid_t creation, std::span<const Source> sources, std::span<const hsize_t> shape,
                 const std::string& name);

/// The path of a file beside a map: beside the map itself, where the path to that goes over links.
std::string path_beside(const std::string& map, const std::string& file);

/// The files that a dataset is made of, in their order; none: it is not virtual. Throws IoError.
std::vector<std::string> sources_of(hid_t dataset);

/// Why a virtual dataset of this name is none of ours: one of its sources is no file beside it, or another
/// dataset there. Empty: it is.
std::string refusal_of_sources(hid_t creation, const std::string& name);

}  // namespace leapmap::hdf5
