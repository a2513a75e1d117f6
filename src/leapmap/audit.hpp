// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// Result of a sweep's cross-check: the differences between stored numbers and independent methods.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace leapmap {

/// Differences between what a map stores and what independent methods find for a sample of its designs.
///
/// The second method integrates in time, or is the exact solver if the map was integrated. The referee is a
/// third, independent solver: it starts from the paper's equations (7) to (9) and shares no formula with the
/// others. It solves a tenth of the sample, and every design that the second method finds wrong.
struct AuditReport {
  std::size_t designs = 0;          ///< sample size
  std::string method;               ///< name of the second method
  double max_abs_height_error = 0;  ///< of jump, first lift-off and dip [hoop diameters], if flags agree
  double max_rel_time_error = 0;    ///< of the times to lift-off, apex and landing, relative
  double max_rel_motion_error = 0;  ///< of angles, spins, distances and energies, relative to 1 + size
  std::size_t failed = 0;           ///< designs with status failed in the map; they are not compared
  std::size_t flag_mismatches =
      0;                      ///< designs whose status, the first lift-off or number of lift-offs differ
  std::size_t undecided = 0;  ///< designs that the second method cannot decide within its own error
  double allowed_error = 0;   ///< error above which a design counts as wrong; heights: times 1 + height
  std::size_t beyond_tolerance = 0;             ///< designs whose error is larger than that
  std::optional<std::size_t> first_mismatch;    ///< lowest design number whose flags differ
  std::optional<std::size_t> first_inaccurate;  ///< lowest design number beyond the tolerance

  std::size_t refereed = 0;                    ///< designs that the referee solved
  std::size_t referee_undecided = 0;           ///< of these, designs that the referee could not decide
  std::size_t overruled = 0;                   ///< designs that the referee finds wrong
  double referee_max_error = 0;                ///< largest of the three errors above, by the referee
  std::optional<std::size_t> first_overruled;  ///< lowest design number that the referee finds wrong

  // Derivatives, if the map stores any: by differences of the exact solver in long double.
  std::size_t gradient_designs = 0;    ///< designs for which one parameter's derivatives were compared
  std::size_t gradient_undecided = 0;  ///< of these, designs with another outcome within the difference
  std::size_t gradients_wrong = 0;     ///< designs with a derivative off by more than 1e-6
  double gradient_max_error = 0;       ///< largest error, relative to the larger of the derivative and 1e-3
  std::optional<std::size_t> first_wrong_gradient;  ///< lowest design number with a wrong derivative

  // Later jumps, if the map stores any: by the second method.
  std::size_t jumps_compared = 0;   ///< jumps after the first, over the whole sample
  std::size_t jumps_beyond = 0;     ///< jumps not compared: initial errors grow by more than 1e5,
                                    ///< or the second method is inconclusive
  std::size_t sequences_wrong = 0;  ///< designs with other jumps, or farther off than errors grow
  double jump_max_error = 0;        ///< largest error of height or time over the growth of errors
  std::optional<std::size_t> first_wrong_sequence;  ///< lowest design number of a wrong sequence

  // Gaits, if the map stores any: one period by the second method, the multiplier by differences.
  std::size_t gaits = 0;                        ///< designs with a gait
  std::size_t gaits_undecided = 0;              ///< of these, designs with other jumps within the difference
  std::size_t gaits_wrong = 0;                  ///< designs whose gait does not repeat, or is another one
  double gait_max_error = 0;                    ///< of height, speed and energy, relative to 1 + size
  double multiplier_max_error = 0;              ///< relative to 1 + size
  std::optional<std::size_t> first_wrong_gait;  ///< lowest design number of a wrong gait
};

/// Whether an independent method contradicts any stored design.
inline bool disagree(const AuditReport& report) {
  return report.first_mismatch || report.first_inaccurate || report.first_overruled ||
         report.first_wrong_gradient || report.first_wrong_sequence || report.first_wrong_gait;
}

}  // namespace leapmap
