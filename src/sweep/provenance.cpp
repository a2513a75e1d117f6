// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <chrono>

#include "leapmap/version.hpp"
#include "map/schema.hpp"

namespace leapmap {

std::vector<hdf5::Attribute> file_provenance(std::string_view filetype, const std::string& title) {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return {{"Conventions", "CF-1.8"},
          {"title", title},
          {"filetype", std::string(filetype)},
          {"version", std::vector<std::int32_t>{format_major, format_minor}},
          {"program_version", std::string(program_version())},
          {"git_revision", std::string(git_revision())},
          {"instruction_set", std::string(instruction_set())},
          {"date", fmt::format("{:%FT%TZ}", fmt::gmtime(std::chrono::system_clock::now()))},
          {"host", std::string(host.data())}};
}

std::vector<hdf5::Attribute> provenance(const Spec& spec, std::string_view filetype,
                                        const std::string& title) {
  std::vector<hdf5::Attribute> attributes = file_provenance(filetype, title);
  attributes.emplace_back("spec", resolved_text(spec));
  attributes.emplace_back("method", resolved_method(spec.numerics));
  attributes.emplace_back("tolerance", spec.numerics.tolerance);
  return attributes;
}

}  // namespace leapmap
