// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap stability: where methods fail, and how.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/quick_first.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "engine/provenance.hpp"
#include "map/hdf5_driver.hpp"
#include "map/table_file.hpp"
#include "study/stability.hpp"
#include "support/output_file.hpp"
#include "support/printable.hpp"

namespace leapmap::cli {
namespace {

constexpr const char* stability_filetype = "leapmap stability";
constexpr std::string_view landing_case = "landing";

struct StabilityArguments {
  std::string table = "maps/stability.h5";
  std::vector<std::string> cases;  // empty: all
  Locking locking = Locking::required;
  bool thorough = false;
};

/// The rows of one method in one case, which stand together, and their verdict.
struct Series {
  std::span<const StabilityRow> rows;
  std::string_view verdict;
};

bool same_series(const StabilityRow& a, const StabilityRow& b) {
  return a.study == b.study && a.method == b.method && a.control == b.control;
}

std::vector<Series> series_of(std::span<const StabilityRow> rows) {
  std::vector<Series> series;
  for (auto begin = rows.begin(); begin != rows.end();) {
    const auto end =
        std::find_if_not(begin, rows.end(), [&](const auto& r) { return same_series(r, *begin); });
    std::vector<Finding> findings;
    for (auto row = begin; row != end; ++row) findings.push_back(row->finding);
    series.push_back({{begin, end}, verdict_of(findings)});
    begin = end;
  }
  return series;
}

void print_verdicts(std::span<const StabilityRow> rows) {
  for (const Series& series : series_of(rows)) {
    const StabilityRow& first = series.rows.front();
    const auto count = [&](Finding finding) {
      return std::ranges::count(series.rows, finding, &StabilityRow::finding);
    };
    double worst = NAN, evaluations = NAN;
    for (const StabilityRow& row : series.rows) {
      if (row.finding != Finding::undecided) worst = std::fmax(worst, row.error);
      evaluations = std::fmax(evaluations, row.evaluations);
    }
    const auto shown = [](double value) { return std::isnan(value) ? "none" : fmt::format("{:.1e}", value); };
    say("{:<10} {:<27} {:<9}  {:<20} {:>5} {:>5} {:>6} {:>5} {:>9}  {:>9}  {:>9}\n", first.study,
        first.method, first.control, series.verdict, count(Finding::fine), count(Finding::lossy),
        count(Finding::failed), count(Finding::wrong), count(Finding::undecided), shown(worst),
        shown(evaluations));
  }
  flush_out();
}

Table table_of(std::span<const StabilityRow> rows) {
  Table columns{numbered_rows(rows.size())};
  const auto texts = [&](const char* name, const char* long_name, auto value) {
    std::vector<std::string> values;
    for (const StabilityRow& row : rows) values.emplace_back(value(row));
    columns.push_back({name, "1", long_name, values});
  };
  const auto numbers = [&](const char* name, const char* unit, const char* long_name,
                           double StabilityRow::*member) {
    std::vector<double> values;
    for (const StabilityRow& row : rows) values.push_back(row.*member);
    columns.push_back({name, unit, long_name, values});
  };
  texts("study", "the case", [](const auto& r) { return r.study; });
  texts("abscissa", "meaning of x", [](const auto& r) { return r.abscissa; });
  texts("method", "exact, a stepper, or a rule for arming a landing event",
        [](const auto& r) { return r.method; });
  texts("control", "kind of setting: tolerance, step, or rule for a landing event",
        [](const auto& r) { return r.control; });
  numbers("setting", "1", "tolerance, or step in sqrt(R/g); NaN: a rule", &StabilityRow::setting);
  numbers("x", "1", "position along the abscissa of the case", &StabilityRow::x);
  numbers(
      "error", "1",
      "largest of the error of the jump's height in hoop diameters and the relative errors of both times; "
      "NaN: none to compare",
      &StabilityRow::error);
  numbers("energy_drift", "1", "at the jump, over 1 + its kinetic energy; NaN: no jump",
          &StabilityRow::energy_drift);
  numbers("condition", "1", "growth factor of a relative change of the inputs", &StabilityRow::condition);
  numbers("evaluations", "1", "of the acceleration; NaN: none", &StabilityRow::evaluations);
  numbers("seconds", "s", "for this one design on one thread, once", &StabilityRow::seconds);
  texts("failure", "reason of a reported failure; empty: none", [](const auto& r) { return r.failure; });
  texts("finding", "fine, undecided, lossy, failed or wrong",
        [](const auto& r) { return name_of(r.finding); });
  texts("witness", "method that gives the right answer", [](const auto& r) { return name_of(r.witness); });
  std::vector<std::string> verdicts;
  for (const Series& series : series_of(rows))
    verdicts.insert(verdicts.end(), series.rows.size(), std::string(series.verdict));
  columns.push_back({"verdict", "1", "of the method in this case", verdicts});
  return columns;
}

/// Runs the cases and writes the table. False: a signal came first.
bool study(const StabilityArguments& arguments, bool quick) {
  const StabilityOptions options{.quick = quick};
  const auto begin = std::chrono::steady_clock::now();
  say("{:<10} {:<27} {:<9}  {:<20} {:>5} {:>5} {:>6} {:>5} {:>9}  {:>9}  {:>9}\n", "case", "method",
      "control", "verdict", "fine", "lossy", "failed", "wrong", "undecided", "worst", "most rhs");
  std::vector<StabilityRow> rows;
  const auto stop_requested = [] { return noted_signal() != 0; };
  const auto wanted = [&](std::string_view name) {
    return arguments.cases.empty() || std::ranges::find(arguments.cases, name) != arguments.cases.end();
  };
  for (const NamedCase& named : stability_cases()) {
    if (!wanted(named.name)) continue;
    const std::vector<StabilityRow> more = run_case(stability_case(named, options), stop_requested);
    if (stop_requested()) return false;
    print_verdicts(more);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  if (wanted(landing_case)) {
    const std::vector<StabilityRow> landings = run_landing_case(options);
    print_verdicts(landings);
    rows.insert(rows.end(), landings.begin(), landings.end());
  }
  std::vector<hdf5::Attribute> attributes =
      file_provenance(stability_filetype, "Where methods for passive hoops fail");
  attributes.emplace_back("quick", std::int64_t{quick});
  attributes.emplace_back("wall_time",
                          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  const std::array tables{table_of(rows)};
  if (!write_tables(behind_links(arguments.table), stability_filetype, tables, attributes, arguments.locking))
    tell_of_folder(arguments.table);
  say("table    {} rows in {}\ncharts   /usr/bin/python3 -m leapmap.charts stability {}\n", rows.size(),
      arguments.table, shell_quoted(arguments.table));
  return true;
}

int run(const StabilityArguments& arguments) {
  refuse_taken(arguments.table, stability_filetype, arguments.locking);  // not after minutes of work
  note_signals();
  return run_quick_first(arguments.thorough, arguments.table,
                         [&](bool quick) { return study(arguments, quick); });
}

}  // namespace

void add_stability(CommandLine& line, int& status) {
  Command command = line.command("stability", "find where methods fail: every method in thirteen cases");
  command.examples(
      {{"leapmap stability", "ten seconds; then python3 -m leapmap.charts stability maps/stability.h5"},
       {"leapmap stability --thorough", "the same table first, then ten minutes for one of more positions"}});
  auto arguments = std::make_shared<StabilityArguments>();
  command.value("-o,--output", arguments->table, "the HDF5 table to write; default: maps/stability.h5")
      .check(named_file());
  std::vector<std::string> cases{std::string(landing_case)};
  for (const NamedCase& each : stability_cases()) cases.emplace_back(each.name);
  command.value("--cases", arguments->cases, "cases to run, separated by commas; default: all of those below")
      .with_commas()
      .check(one_of(cases));
  add_quick_and_thorough(command, arguments->thorough, "positions in each case");
  add_no_lock(command, arguments->locking);
  command.footer(
      "Each case approaches a difficult design:\n"
      "  needle       a mass on the rim of an ever lighter hoop\n"
      "  release      ever closer to the unstable equilibrium\n"
      "  graze        across the fold at which a pair of lift-offs appears\n"
      "  long         up to 10,000 revolutions to the jump\n"
      "  step         ever longer fixed steps\n"
      "  tolerance    down to 1e-30\n"
      "  landing      flights that enter the plane, or start with a triple root\n"
      "  chaos        jump after jump of a hoop without a stable gait\n"
      "and with friction:\n"
      "  painleve     a slide that barely misses Painleve's paradox\n"
      "  slow         ever slower releases\n"
      "  dip          the normal force of a slide barely touches zero\n"
      "  stick        friction barely holds\n"
      "  bounces      ever more rebounds\n"
      "\n"
      "Findings:\n"
      "  fine         error within the tolerance (at best 1e-12; fixed steps: 1e-6)\n"
      "               or within what four ulps of the inputs change\n"
      "  lossy        error up to 5 %\n"
      "  failed       the method reports failure\n"
      "  wrong        anything else\n"
      "  undecided    four ulps of an input, with friction a hundred, change the flags;\n"
      "               not counted against any method\n"
      "\n"
      "Verdict of a method in a case: silently wrong, if any answer is wrong; breaks down, if all failed; "
      "reports failure, if some failed; loses digits, if some are lossy; otherwise fine.\n"
      "The reference is exact in long double if gsl-rk8pd at 1e-13 agrees with it, and gsl-rk8pd otherwise; "
      "the column witness names it. One thread.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
