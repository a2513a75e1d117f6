// SPDX-License-Identifier: GPL-3.0-or-later
/// What every file of ours says about itself.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "map/hdf5.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// Those root attributes on which the last bits of numbers depend: what differs in one of them is no part of
/// the same map.
inline constexpr std::array bits_depend_on{"program_version", "git_revision", "instruction_set",
                                           "math_library"};

/// Root attributes of any file: conventions, title, file type and version, program, date, host.
std::vector<hdf5::Attribute> file_provenance(std::string_view filetype, const std::string& title);

/// The same, resolved spec, method and tolerance.
std::vector<hdf5::Attribute> provenance(const Spec& spec, std::string_view filetype,
                                        const std::string& title);

}  // namespace leapmap
