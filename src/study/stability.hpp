// SPDX-License-Identifier: GPL-3.0-or-later
/// Where methods fail: designs and settings chosen to be hard, and what every method makes of them.
///
/// A case is a walk along one number, its abscissa, into trouble. Every answer is compared with the truth
/// (study/truth.hpp), and with what the problem itself allows: how much the answer moves when the inputs move
/// by some ulps.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "integrate/contestant.hpp"
#include "leapmap/design.hpp"
#include "leapmap/scene.hpp"
#include "study/truth.hpp"

namespace leapmap {

/// What one answer is worth.
enum class Finding {
  fine,  ///< error within the tolerance asked (1e-6 of a fixed step, which asks for none; no tolerance below
         ///< 1e-12 counts), or within 100 roundings times the condition
  undecided,  ///< four ulps of an input, a hundred with friction, change status, flag, candidates or the
              ///< number of jumps, or the answer by more than 5 %: no method in double can be asked
  lossy,      ///< digits are lost beyond that, but not beyond 5 %
  failed,     ///< the method says that it failed
  wrong       ///< status, flag or candidates are wrong, or the error is beyond 5 %, and nothing says so
};
std::string_view name_of(Finding finding);

/// What a method is worth in one case: "silently wrong" if any answer is wrong; else "breaks down" if
/// it failed wherever the answer is decided, "reports failure" if it failed somewhere; else "loses digits"
/// if any answer is lossy; else "fine", or "undecided" if nothing was decided.
std::string_view verdict_of(std::span<const Finding> findings);

/// One design to be solved in its scene, at one place of its case's walk.
struct StabilitySubject {
  double x = 0.0;  ///< abscissa; of a case that walks along the settings it is not used
  Design design;
  Scene scene;
};

struct StabilityCase {
  std::string name;      ///< "needle", "release", ...
  std::string abscissa;  ///< what x is, with its unit
  std::vector<StabilitySubject> subjects;
  std::vector<Contestant> contestants;
  bool walks_settings = false;  ///< x is the contestant's step or tolerance
  long max_steps = 200'000;
};

struct StabilityRow {
  std::string study;     ///< the case's name
  std::string abscissa;  ///< the case's
  std::string method;
  std::string control;   ///< "tolerance", "step" or "rule" (landing)
  double setting = 0.0;  ///< tolerance or step; NaN for a rule
  double x = 0.0;
  double error = 0.0;  ///< largest of heights', absolute [diameters], and of times to lift-offs, relative;
                       ///< NaN where the finding is failed or flags are wrong
  double energy_drift =
      0.0;                 ///< at the jump, over 1 + its kinetic energy; NaN without a jump or with friction
  double condition = 0.0;  ///< times that a relative change of the inputs comes back in the answer
  double evaluations = 0.0;  ///< of the acceleration; NaN: none
  double seconds = 0.0;
  std::string failure;  ///< why the method says that it failed; empty: it does not
  Finding finding = Finding::fine;
  Witness witness = Witness::both;  ///< by what the right answer is known
};

struct StabilityOptions {
  bool quick = false;  ///< fewer places and fewer steps before a method gives up
};

/// A case before its subjects are made: some of them are solved for, which takes longer than a name should.
struct NamedCase {
  std::string_view name;
  StabilityCase (*make)(bool quick);
};

/// The cases whose subjects are designs: needle, release, graze, long, step, tolerance, chaos, and those of
/// friction_cases.
std::vector<NamedCase> stability_cases();

/// The case with its subjects; with options.quick with fewer of them, and fewer steps.
StabilityCase stability_case(const NamedCase& named, const StabilityOptions& options);

/// exact, all of GSL's steppers at the default tolerance, and at a fixed step the classical fourth order;
/// without friction also those that games use and the implicit midpoint rule (symplectic, for Hamiltonian
/// coordinates), which GSL calls rk2imp.
std::vector<Contestant> usual_contestants(Friction friction);

/// The cases with Coulomb friction: painleve, slow, dip, stick, bounces.
std::span<const NamedCase> friction_cases();

/// Every contestant on every subject, one contestant after another. One thread. stop_requested is asked
/// before each design; the rows are then those there are.
std::vector<StabilityRow> run_case(const StabilityCase& stability_case,
                                   const std::function<bool()>& stop_requested = {});

/// The case "landing": flights from lift-offs out of rolling, whose height dips below the plane, and out of
/// sliding, where y, y' and y'' vanish at once; by our closed form and by landing events armed in three ways.
std::vector<StabilityRow> run_landing_case(const StabilityOptions& options);

}  // namespace leapmap
