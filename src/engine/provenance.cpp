// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#if __has_include(<gnu/libc-version.h>)
#include <gnu/libc-version.h>
#endif

#include <array>
#include <chrono>

#include "leapmap/version.hpp"
#include "map/schema.hpp"

namespace leapmap {
namespace {

/// Whose sines and arc cosines the parts outside the lanes use. glibc has others for processors that multiply
/// and add in one rounding.
std::string math_library() {
#ifdef __GLIBC__
  std::string library = fmt::format("glibc {}", gnu_get_libc_version());
#ifdef __x86_64__
  if (__builtin_cpu_supports("fma") && __builtin_cpu_supports("avx2")) library += ", fma";
#endif
  return library;
#else
  return "other than glibc";
#endif
}

}  // namespace

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
          {"math_library", math_library()},
          {"date", fmt::format("{:%FT%TZ}", fmt::gmtime(std::chrono::system_clock::now()))},
          {"host", std::string(host.data())}};
}

std::vector<hdf5::Attribute> provenance(const Spec& spec, std::string_view filetype,
                                        const std::string& title) {
  std::vector<hdf5::Attribute> attributes = file_provenance(filetype, title);
  attributes.emplace_back("spec", resolved_text(spec));
  attributes.emplace_back("method", resolved_method(spec));
  attributes.emplace_back("tolerance", spec.numerics.tolerance);
  return attributes;
}

}  // namespace leapmap
