// SPDX-License-Identifier: GPL-3.0-or-later
/// How accurate this very sweep is: a random share of its outcomes, on their way to the map, solved again by
/// an independent method.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "leapmap/outcome.hpp"
#include "map/reader.hpp"
#include "map/tile.hpp"
#include "sweep/designs.hpp"
#include "sweep/solver.hpp"
#include "sweep/spec.hpp"

namespace leapmap {

/// An outcome taken from a sweep on its way to the map.
struct AuditSample {
  std::size_t number;  ///< of the design, C order over the whole map
  Outcome outcome;
};

/// The designs of a tile that the audit looks at, by their place in it; which ones depends on share and map
/// alone. Over all tiles, ceil(share * designs).
std::vector<std::size_t> audit_draw(double share, const Tiling& tiling, const Tile& tile);

/// The samples drawn from a tile's outcomes, rounded as the map rounds them.
std::vector<AuditSample> audit_samples(const Spec& spec, const Tiling& tiling, const Tile& tile,
                                       std::span<const Outcome> outcomes);

/// The samples of a tile of a finished map: the outcomes are the solver's, but all that the map stores is the
/// map's.
std::vector<AuditSample> audit_samples(const MapReader& map, const Spec& spec, double share,
                                       const Tiling& tiling, const Tile& tile, const Solver& solve);

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
  // The referee's part (referee/referee.hpp). From the paper's (7) to (9) it solves a tenth of these designs,
  // and those that the second method convicts exact of: it may acquit them.
  std::size_t refereed = 0;                    ///< designs it looked at
  std::size_t referee_undecided = 0;           ///< of those, designs it gave up on or is in doubt about
  std::size_t overruled = 0;                   ///< designs that it finds wrong
  double referee_max_error = 0.0;              ///< the largest of the three errors above, by the referee
  std::optional<std::size_t> first_overruled;  ///< the least design number that it finds wrong
};

/// How far two outcomes are apart.
struct AuditDifference {
  bool flags = false;
  double height = 0.0, time = 0.0, motion = 0.0;
};

/// The method that audits another: exact audits integration, integration by gsl-rk8pd at 1e-13 audits exact.
std::string audit_method(const Numerics& numerics);

/// Whether the second method or the referee disagrees on some design, by flags or beyond the tolerance.
inline bool disagree(const AuditReport& report) {
  return report.first_mismatch || report.first_inaccurate || report.first_overruled;
}

/// Adds what was found on other designs of the same sweep. The order does not matter.
void merge(AuditReport& report, const AuditReport& other);

/// A report as a map's attributes, and back. The latter throws IoError if they are not there.
std::vector<hdf5::Attribute> audit_attributes(const AuditReport& report);
AuditReport read_audit(const MapReader& map);

/// Solves samples again, one after the other, and compares. One a thread.
class Auditor {
 public:
  /// Keeps a reference to spec. The referee sees one design in so many; 0: one in ten, or all of an audit of
  /// thirty or fewer.
  explicit Auditor(const Spec& spec, std::size_t referee_every = 0);
  /// Adds what a sample comes to. An error is beyond the tolerance if it is larger than numerics.tolerance (a
  /// hundred times that for an adaptive stepper, whose tolerance is per step; no less than 1e-11, the audit's
  /// own error), and larger than 10 times what one unit in the last place of the inputs, or a coarser
  /// tolerance, makes of the second method's own answer. A map in f4 is allowed a rounding of f4 on top.
  void look_at(const AuditSample& sample, AuditReport& report) const;
  /// A report on no design yet.
  AuditReport begin() const;

 private:
  /// A method that judges another, and itself at a coarser tolerance.
  struct Judge {
    Solver solve, coarser;
  };
  struct Verdict {
    bool undecided = false, wrong_flags = false, inaccurate = false;
    AuditDifference difference;

    bool convicts() const { return !undecided && (wrong_flags || inaccurate); }
  };
  std::vector<Outcome> outcomes_beside(const Judge& judge, const Design& design, bool of_flags) const;
  Verdict verdict_of(const Judge& judge, const Design& design, const Outcome& ours) const;
  Verdict verdict_among(const Outcome& ours, const std::vector<Outcome>& beside) const;
  bool exceeds(const AuditDifference& d, const AuditDifference& doubt, const Outcome& ours) const;

  const Spec& spec_;
  DesignSpace space_;
  Judge second_, referee_;
  std::size_t referee_every_;
  double allowed_;
};

/// Looks at all samples on all threads. stop_requested is asked after each design; once true, the report
/// covers what was done until then.
AuditReport audit(const Spec& spec, std::span<const AuditSample> samples, int threads,
                  const std::function<bool()>& stop_requested = {}, std::size_t referee_every = 0);

}  // namespace leapmap
