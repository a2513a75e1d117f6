// SPDX-License-Identifier: GPL-3.0-or-later
/// What every file of ours says about itself.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "map/hdf5.hpp"
#include "sweep/spec.hpp"

namespace leapmap {

/// Root attributes of any file: conventions, title, file type and version, program, date, host.
std::vector<hdf5::Attribute> file_provenance(std::string_view filetype, const std::string& title);

/// The same, resolved spec, method and tolerance.
std::vector<hdf5::Attribute> provenance(const Spec& spec, std::string_view filetype,
                                        const std::string& title);

}  // namespace leapmap
