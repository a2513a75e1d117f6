// SPDX-License-Identifier: GPL-3.0-or-later
/// What an audit of a sweep found: how far a second method, and a third, are from what was stored.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace leapmap {

/// What the two methods disagree on.
struct AuditReport {
  std::size_t designs = 0;
  std::string method;  ///< of the audit
  double max_abs_height_error =
      0.0;  ///< [hoop diameters], of jump, first lift-off and dip, where the flags agree
  double max_rel_time_error = 0.0;  ///< of the times to lift-off, apex and landing
  double max_rel_motion_error =
      0.0;                 ///< of angles, spins, distances and energies, relative to one more than their size
  std::size_t failed = 0;  ///< designs the sweep gave up on: their status says so, nothing is compared
  std::size_t flag_mismatches = 0;  ///< designs whose status, spurious flag or number of candidates differ
  /// Designs on which the audit's method gave up, or whose flags it cannot tell within its own error.
  std::size_t undecided = 0;
  double allowed_error = 0.0;                   ///< see audit; for heights, relative to 1 + height
  std::size_t beyond_tolerance = 0;             ///< designs whose error is larger
  std::optional<std::size_t> first_mismatch;    ///< the least design number whose flags differ
  std::optional<std::size_t> first_inaccurate;  ///< the least design number beyond the tolerance
  // The referee's part (src/referee). From the paper's (7) to (9) it solves a tenth of these designs,
  // and those that the second method convicts exact of: it may acquit them.
  std::size_t refereed = 0;                    ///< designs it looked at
  std::size_t referee_undecided = 0;           ///< of those, designs it gave up on or is in doubt about
  std::size_t overruled = 0;                   ///< designs that it finds wrong
  double referee_max_error = 0.0;              ///< the largest of the three errors above, by the referee
  std::optional<std::size_t> first_overruled;  ///< the least design number that it finds wrong
  // The derivatives' part, where the sweep stores some: by differences of the exact solver in long double.
  std::size_t gradient_designs = 0;    ///< designs whose derivatives by one parameter were looked at
  std::size_t gradient_undecided = 0;  ///< of those, designs whose outcome is another a hair away
  std::size_t gradients_wrong = 0;     ///< designs one of whose derivatives is off by more than 1e-6
  double gradient_max_error = 0.0;     ///< relative; of derivatives below a thousandth, to that
  std::optional<std::size_t> first_wrong_gradient;  ///< the least design number of those
  // Later jumps' part, where the sweep asks for any: by the second method, as far as the condition allows.
  std::size_t jumps_compared = 0;  ///< jumps after the first, of all these designs together
  std::size_t jumps_beyond =
      0;  ///< jumps that are not: errors have grown by more than 1e5, or the second method is in doubt itself
  std::size_t sequences_wrong = 0;  ///< designs that make other jumps, or one farther off than errors grow
  double jump_max_error = 0.0;  ///< the largest of their heights' and times', over how much errors have grown
  std::optional<std::size_t> first_wrong_sequence;  ///< the least design number of those
  // Gaits' part: once round each of them by the second method, and its multiplier by differences.
  std::size_t gaits = 0;              ///< designs that settle on one
  std::size_t gaits_undecided = 0;    ///< of those, designs that make other jumps a hair away
  std::size_t gaits_wrong = 0;        ///< designs whose gait is none, or is another
  double gait_max_error = 0.0;        ///< of height, speed and energy, relative to one more than their size
  double multiplier_max_error = 0.0;  ///< relative to one more than its size
  std::optional<std::size_t> first_wrong_gait;  ///< the least design number of those
};

/// Whether the second method or the referee disagrees on some design, by flags or beyond the tolerance.
inline bool disagree(const AuditReport& report) {
  return report.first_mismatch || report.first_inaccurate || report.first_overruled ||
         report.first_wrong_gradient || report.first_wrong_sequence || report.first_wrong_gait;
}

}  // namespace leapmap
