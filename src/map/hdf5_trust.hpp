// SPDX-License-Identifier: GPL-3.0-or-later
/// What an HDF5 file may hold before anything of it is read. A file that somebody sent may refer to other
/// files of the machine: what leads there, or wants more memory than the file has bytes for, is refused.
#pragma once

#include <functional>
#include <set>
#include <string>

#include "map/hdf5.hpp"

namespace leapmap::hdf5 {

/// Files that virtual datasets are made of. They lie beside the file that has those, and have no folder here.
using SourceNames = std::set<std::string, std::less<>>;

/// Throws ForeignFile, naming the part, if the file holds an external link, external storage, a virtual
/// dataset made of anything but datasets of its name in files beside it, a dataset of references, a filter
/// other than shuffle, deflate and fletcher32, a chunk beyond all use, or more objects than any file of ours.
/// `path` is for messages. Returns the files beside it that its virtual datasets are made of.
SourceNames refuse_foreign_parts(hid_t file, const std::string& path);

/// Throws BrokenFile if a chunk that holds a part of [start, start + extent) would take more memory than its
/// values: what is stored for it is more than deflate ever makes of them, or inflates to something else. To
/// be asked before HDF5 reads them, as its filters take whatever memory they are told to.
void refuse_inflation(hid_t dataset, const std::vector<std::size_t>& start,
                      const std::vector<std::size_t>& extent, const std::string& what);

/// The bytes of a dataset's values. Throws IoError if the bytes stored for it could not hold so many: to be
/// asked before memory is taken for all of them. `what` is for messages.
std::size_t bytes_in_memory(hid_t dataset, const std::string& what);

}  // namespace leapmap::hdf5
