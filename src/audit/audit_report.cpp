// SPDX-License-Identifier: GPL-3.0-or-later
#include "audit/audit_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "leapmap/errors.hpp"
#include "leapmap/outcome.hpp"
#include "map/tile.hpp"
#include "spec/designs.hpp"

namespace leapmap {

namespace {

/// An attribute of a map, and since which minor version of the format it is there.
template <class Member>
struct AuditAttribute {
  const char* name;
  Member member;
  int since;
  long most = 1;  ///< of a count, a design
};
using Count = AuditAttribute<std::size_t AuditReport::*>;
using Error = AuditAttribute<double AuditReport::*>;
constexpr std::array counts{Count{"audit_designs", &AuditReport::designs, 0},
                            Count{"audit_flag_mismatches", &AuditReport::flag_mismatches, 0},
                            Count{"audit_undecided", &AuditReport::undecided, 1},
                            Count{"audit_beyond_tolerance", &AuditReport::beyond_tolerance, 1},
                            Count{"audit_failed", &AuditReport::failed, 4},
                            Count{"audit_referee_designs", &AuditReport::refereed, 5},
                            Count{"audit_referee_undecided", &AuditReport::referee_undecided, 5},
                            Count{"audit_overruled", &AuditReport::overruled, 5},
                            Count{"audit_gradient_designs", &AuditReport::gradient_designs, 7},
                            Count{"audit_gradient_undecided", &AuditReport::gradient_undecided, 7},
                            Count{"audit_gradients_wrong", &AuditReport::gradients_wrong, 7},
                            Count{"audit_jumps_compared", &AuditReport::jumps_compared, 10, most_jumps},
                            Count{"audit_jumps_beyond", &AuditReport::jumps_beyond, 10, most_jumps},
                            Count{"audit_sequences_wrong", &AuditReport::sequences_wrong, 10},
                            Count{"audit_gaits", &AuditReport::gaits, 10},
                            Count{"audit_gaits_undecided", &AuditReport::gaits_undecided, 10},
                            Count{"audit_gaits_wrong", &AuditReport::gaits_wrong, 10}};
constexpr std::array errors{Error{"audit_max_abs_height_error", &AuditReport::max_abs_height_error, 0},
                            Error{"audit_max_rel_time_error", &AuditReport::max_rel_time_error, 0},
                            Error{"audit_max_rel_motion_error", &AuditReport::max_rel_motion_error, 5},
                            Error{"audit_allowed_error", &AuditReport::allowed_error, 4},
                            Error{"audit_referee_max_error", &AuditReport::referee_max_error, 5},
                            Error{"audit_gradient_max_error", &AuditReport::gradient_max_error, 7},
                            Error{"audit_jump_max_error", &AuditReport::jump_max_error, 10},
                            Error{"audit_gait_max_error", &AuditReport::gait_max_error, 10},
                            Error{"audit_multiplier_max_error", &AuditReport::multiplier_max_error, 10}};
/// The lowest design number of a kind of disagreement. sentence: {0} is the second method, {1} the allowed
/// error.
struct First : AuditAttribute<std::optional<std::size_t> AuditReport::*> {
  std::string_view sentence;
};
constexpr std::array firsts{
    First{{"audit_first_mismatch", &AuditReport::first_mismatch, 4},
          "the stored status, first lift-off, number of lift-offs or phases are not those of {0}"},
    First{{"audit_first_inaccurate", &AuditReport::first_inaccurate, 4},
          "the stored numbers differ by more than {1:.1e} from those of {0}"},
    First{{"audit_first_overruled", &AuditReport::first_overruled, 5},
          "the reference solver, which integrates the paper's (7) to (9), finds another outcome"},
    First{{"audit_first_wrong_gradient", &AuditReport::first_wrong_gradient, 7},
          "a stored derivative differs by more than 1e-6 from differences in long double"},
    First{{"audit_first_wrong_sequence", &AuditReport::first_wrong_sequence, 10},
          "the stored later jumps differ from those of {0} by more than errors grow"},
    First{{"audit_first_wrong_gait", &AuditReport::first_wrong_gait, 10},
          "integration does not find the stored gait"}};

}  // namespace

void merge(AuditReport& report, const AuditReport& other) {
  for (const auto& row : counts) report.*row.member += other.*row.member;
  for (const auto& row : errors)
    if (row.member != &AuditReport::allowed_error)
      report.*row.member = std::max(report.*row.member, other.*row.member);
  for (const auto& row : firsts)
    if (const std::optional<std::size_t>& first = other.*row.member)
      report.*row.member = std::min((report.*row.member).value_or(*first), *first);
}

std::vector<std::string> disagreements(const Spec& spec, const AuditReport& report) {
  std::vector<std::string> found;
  for (const auto& row : firsts)
    if (const std::optional<std::size_t>& design = report.*row.member)
      found.push_back(
          fmt::format("design {}: {}; show it: {}", told_design(spec, *design),
                      fmt::format(fmt::runtime(row.sentence), report.method, report.allowed_error),
                      hop_command(spec, DesignSpace(spec).at(*design))));
  return found;
}

std::vector<hdf5::Attribute> audit_attributes(const AuditReport& report) {
  std::vector<hdf5::Attribute> attributes;
  for (const auto& row : counts)
    attributes.emplace_back(row.name, static_cast<std::int64_t>(report.*row.member));
  for (const auto& row : errors) attributes.emplace_back(row.name, report.*row.member);
  for (const auto& row : firsts) {
    const std::optional<std::size_t>& first = report.*row.member;
    attributes.emplace_back(row.name, first ? static_cast<std::int64_t>(*first) : std::int64_t{-1});
  }
  return attributes;
}

AuditReport read_audit(const MapReader& map) {
  AuditReport report;
  report.method = map.attribute("audit_method");
  if (report.method.empty()) throw BrokenFile("the attribute audit_method is missing");
  const std::vector<std::int64_t> version = hdf5::read_integers(map.file(), "version");
  const auto has = [&](const auto& row) { return version[1] >= row.since; };
  const auto designs = static_cast<std::int64_t>(designs_of(map.shape()));
  const auto count = [&](const char* name, std::int64_t least, std::int64_t most) {
    return hdf5::read_integer(map.file(), name, least, most);
  };
  for (const auto& row : counts)
    if (has(row)) report.*row.member = static_cast<std::size_t>(count(row.name, 0, designs * row.most));
  for (const auto& row : errors)
    report.*row.member = has(row) ? hdf5::read_number(map.file(), row.name, true) : Outcome::none;
  for (const auto& row : firsts)
    if (const std::int64_t design = has(row) ? count(row.name, -1, designs - 1) : -1; design >= 0)
      report.*row.member = static_cast<std::size_t>(design);
  return report;
}

}  // namespace leapmap
