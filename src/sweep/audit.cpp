// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep/audit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>

#include "sweep/designs.hpp"
#include "sweep/parallel.hpp"

namespace leapmap {
namespace {

/// splitmix64: a well-mixed number from a counter.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// The number of the i-th of `count` designs to audit, one at random from each of `count` equal shares of the
/// sweep.
std::size_t drawn(std::size_t i, std::size_t count, std::size_t designs) {
  const double share = static_cast<double>(designs) / static_cast<double>(count);
  const auto begin = static_cast<std::size_t>(share * static_cast<double>(i));
  const auto end = std::max(begin + 1, static_cast<std::size_t>(share * static_cast<double>(i + 1)));
  return std::min(begin + mix(i) % (end - begin), designs - 1);
}

void compare(AuditReport& report, std::size_t number, const Outcome& ours, const Outcome& theirs) {
  ++report.designs;
  if (ours.status != theirs.status || ours.spurious_first_jump != theirs.spurious_first_jump ||
      ours.candidates != theirs.candidates) {
    ++report.flag_mismatches;
    report.first_mismatch = std::min(report.first_mismatch.value_or(number), number);
  } else if (ours.status == Status::jumped) {
    report.max_abs_height_error =
        std::max(report.max_abs_height_error, std::abs(ours.jump_height - theirs.jump_height));
    report.max_rel_time_error =
        std::max(report.max_rel_time_error, std::abs(ours.jump_time / theirs.jump_time - 1.0));
  }
}

}  // namespace

AuditMethod audit_method(const Numerics& numerics) {
  AuditMethod audit;
  audit.name = resolved_method(numerics) == "gsl-rk8pd" ? "gsl-rkck" : "gsl-rk8pd";
  audit.options.stepper = find_gsl_stepper(audit.name);
  audit.options.control.relative = audit.options.control.absolute = 1e-13;
  return audit;
}

AuditReport audit(const Spec& spec, int threads, const std::function<bool()>& stop_requested) {
  const DesignSpace space(spec);
  const std::size_t designs = Tiling(shape_of(spec)).designs();
  const auto count = static_cast<std::size_t>(std::ceil(spec.numerics.audit * static_cast<double>(designs)));
  const AuditMethod method = audit_method(spec.numerics);
  AuditReport report;
  report.method = method.name;
  std::mutex reporting;
  parallel_for_each(count, threads, [&] {
    return [&, ours = std::make_unique<RollingIntegration>(integration_options(spec.numerics)),
            theirs = std::make_unique<RollingIntegration>(method.options)](std::size_t i) {
      const std::size_t number = drawn(i, count, designs);
      const Design design = space.at(number);
      const Outcome our_outcome = ours->solve(design, spec.scene),
                    their_outcome = theirs->solve(design, spec.scene);
      const std::lock_guard lock(reporting);
      compare(report, number, our_outcome, their_outcome);
      return !(stop_requested && stop_requested());
    };
  });
  return report;
}

}  // namespace leapmap
