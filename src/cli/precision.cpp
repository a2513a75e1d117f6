// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap precision: speed against accuracy, all methods in one run.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/quick_first.hpp"
#include "cli/spoken.hpp"
#include "cli/sweep.hpp"
#include "engine/provenance.hpp"
#include "leapmap/errors.hpp"
#include "map/hdf5_driver.hpp"
#include "map/table_file.hpp"
#include "model/model.hpp"
#include "spec/designs.hpp"
#include "spec/point_list.hpp"
#include "study/precision.hpp"
#include "support/output_file.hpp"
#include "support/printable.hpp"

namespace leapmap::cli {
namespace {

constexpr const char* precision_filetype = "leapmap precision";

struct PrecisionArguments {
  std::string table = "maps/precision.h5", points;
  PrecisionOptions options;
  Friction friction = Friction::sticking;
  Locking locking = Locking::required;
  bool thorough = false, designs_given = false;
};

void print_head() {
  say("{:<7} {:<20} {:<9} {:>8}  {:>9} {:>9} {:>9}  {:>7} {:>7}  {:>9} {:>10}  {}\n", "designs", "method",
      "control", "setting", "height", "time", "angle", "wrong", "failed", "rhs", "designs/s", "model");
}

void print_row(const PrecisionRow& row) {
  const Measurement& m = row.measurement;
  say("{:<7} {:<20} {:<9} {:>8.1e}  {:>9.1e} {:>9.1e} {:>9.1e}  {:>6.1f}% {:>6.1f}%  {:>9} {:>10.4g}  {}\n",
      row.designs, row.contestant.method, row.contestant.fixed_step ? "step" : "tolerance",
      row.contestant.setting, m.max_height_error, m.max_time_error, m.max_angle_error, 100.0 * m.wrong,
      100.0 * m.failed, std::isnan(m.evaluations) ? "none" : fmt::format("{:.4g}", m.evaluations),
      1.0 / m.seconds, name_of(row.contestant.model));
  flush_out();
}

Table table_of(const std::vector<PrecisionRow>& rows) {
  Table columns{numbered_rows(rows.size())};
  const auto texts = [&](const char* name, const char* long_name, auto value) {
    std::vector<std::string> values;
    for (const PrecisionRow& row : rows) values.push_back(value(row));
    columns.push_back({name, "1", long_name, values});
  };
  const auto numbers = [&](const char* name, const char* unit, const char* long_name, auto value) {
    std::vector<double> values;
    for (const PrecisionRow& row : rows) values.push_back(value(row));
    columns.push_back({name, unit, long_name, values});
  };
  const auto measured = [&](const char* name, const char* unit, const char* long_name,
                            double Measurement::*member) {
    numbers(name, unit, long_name, [member](const PrecisionRow& row) { return row.measurement.*member; });
  };
  texts("designs", "which designs: random, the paper's hoop alone, or from a list",
        [](const auto& r) { return r.designs; });
  texts("method", "exact, a stepper of GSL, or a method of game engines",
        [](const auto& r) { return r.contestant.method; });
  texts("model", "energy integral (exact), one coordinate by (10), or three with multipliers by (7) to (9)",
        [](const auto& r) { return std::string(name_of(r.contestant.model)); });
  texts("control", "kind of setting: tolerance or step",
        [](const auto& r) { return std::string(r.contestant.fixed_step ? "step" : "tolerance"); });
  numbers("setting", "1", "tolerance, or step in sqrt(R/g)",
          [](const auto& r) { return r.contestant.setting; });
  numbers("order", "1", "theoretical order of the error at fixed steps; 0: varies or does not apply",
          [](const auto& r) { return static_cast<double>(r.contestant.order); });
  measured("seconds", "s", "for one design on one thread, minimum of several runs", &Measurement::seconds);
  measured("evaluations", "1", "of the acceleration for one design; NaN: none", &Measurement::evaluations);
  measured("max_height_error", "1", "of the jump's height, in hoop diameters, if flags are right",
           &Measurement::max_height_error);
  measured("median_height_error", "1", "the same, median", &Measurement::median_height_error);
  measured("max_time_error", "1", "of jump_time, relative, if flags are right", &Measurement::max_time_error);
  measured("median_time_error", "1", "the same, median", &Measurement::median_time_error);
  measured("max_angle_error", "rad", "of jump_angle, if flags are right", &Measurement::max_angle_error);
  measured("median_angle_error", "rad", "the same, median", &Measurement::median_angle_error);
  measured("wrong", "1", "fraction of designs whose status, flag or number of lift-offs is silently wrong",
           &Measurement::wrong);
  measured("failed", "1", "fraction of designs for which the method reports failure", &Measurement::failed);
  measured("drift", "1",
           "largest violation of a constraint, lengths in R, times in sqrt(R/g); NaN: none there",
           &Measurement::drift);
  return columns;
}

/// The designs of a CSV list, as sweeps read it.
std::vector<Design> read_designs(const std::string& path) {
  Spec spec;
  std::vector<std::string> none;
  spec.list = read_points(path, "leapmap precision", {}, {}, none);
  std::vector<Design> designs;
  for (std::size_t i = 0; i < spec.list.count; ++i) designs.push_back(DesignSpace(spec).at(i));
  return designs;
}

/// Measures and writes the table. False: a signal came first.
bool measure(const PrecisionArguments& arguments, const Scene& scene, bool quick) {
  PrecisionOptions options = arguments.options;
  options.quick = quick;
  if (quick && !arguments.designs_given) options.designs = 40;
  if (quick) options.budget = 0.3;
  const auto begin = std::chrono::steady_clock::now();
  print_head();
  const std::vector<PrecisionRow> rows =
      study_precision(options, scene, print_row, [] { return noted_signal() != 0; });
  if (noted_signal() != 0) return false;
  std::vector<hdf5::Attribute> attributes =
      file_provenance(precision_filetype, "Speed against accuracy of methods for passive hoops");
  attributes.emplace_back("random_designs",
                          static_cast<std::int64_t>(options.points.empty() ? options.designs : 0));
  attributes.emplace_back("friction", std::string(model_of(scene).name));
  attributes.emplace_back("seed", static_cast<std::int64_t>(options.seed));
  attributes.emplace_back("budget", options.budget);
  attributes.emplace_back("wall_time",
                          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  const std::array tables{table_of(rows)};
  if (!write_tables(behind_links(arguments.table), precision_filetype, tables, attributes, arguments.locking))
    tell_of_folder(arguments.table);
  say("table    {} rows in {}\nchart    /usr/bin/python3 -m leapmap.charts precision {}\n", rows.size(),
      arguments.table, shell_quoted(arguments.table));
  return true;
}

int run(PrecisionArguments arguments) {
  PrecisionOptions& options = arguments.options;
  const std::array inputs{NamedPath{"--points", arguments.points}};
  const std::array outputs{NamedPath{"-o", arguments.table, true}};
  refuse_same_files(inputs, outputs);
  if (!arguments.points.empty()) options.points = read_designs(arguments.points);
  const Scene scene{.friction = arguments.friction, .runway = 4.0};
  const std::vector<Contestant> contestants = precision_contestants(true, scene.friction);
  for (const std::string& method : options.methods)
    if (std::ranges::find(contestants, method, &Contestant::method) == contestants.end())
      throw InputError(fmt::format(
          "--methods {}: lacks friction; allowed with --friction coulomb: exact, gsl-...", method));
  refuse_taken(arguments.table, precision_filetype, arguments.locking);  // not after minutes of work
  note_signals();
  return run_quick_first(arguments.thorough, arguments.table,
                         [&](bool quick) { return measure(arguments, scene, quick); });
}

}  // namespace

void add_precision(CommandLine& line, int& status) {
  Command command = line.command("precision", "measure speed against accuracy of every method, in one run");
  command.examples(
      {{"leapmap precision", "ten seconds; then python3 -m leapmap.charts precision maps/precision.h5"},
       {"leapmap precision --thorough", "the same table first, then two minutes for a finer one"}});
  auto arguments = std::make_shared<PrecisionArguments>();
  command.value("-o,--output", arguments->table, "the HDF5 table to write; default: maps/precision.h5")
      .check(named_file());
  const Flag designs = command
                           .value("--designs", arguments->options.designs,
                                  "number of random designs; default: 40, with --thorough 200 in the end")
                           .check(whole_number(1, 1e6));
  command.value("--seed", arguments->options.seed, "seed of the random designs; default: 1")
      .check(whole_number(0, most_seed));
  command
      .value("--points", arguments->points,
             "a CSV list of designs, instead of random ones and the paper's hoop")
      .check(named_file())
      .excludes("--designs")
      .excludes("--seed");
  std::vector<std::string> methods;
  for (const Contestant& contestant : precision_contestants(true))
    if (std::ranges::find(methods, contestant.method) == methods.end()) methods.push_back(contestant.method);
  command
      .value(
          "--methods", arguments->options.methods,
          fmt::format("methods to measure, separated by commas; default: all, {}", fmt::join(methods, ", ")))
      .with_commas()
      .check(one_of(methods));
  std::vector<std::string> frictions;
  for (const std::string_view name : model_names()) frictions.emplace_back(name);
  command
      .value(
          "--friction",
          [arguments](const std::string& word) { arguments->friction = find_model(word)->friction; },
          "contact model; coulomb: with random mu_static and mu_kinetic; default: sticking")
      .check(one_of(frictions));
  add_quick_and_thorough(command, arguments->thorough, "designs and settings");
  add_no_lock(command, arguments->locking);
  command.footer(
      "Errors are the largest over the designs with the right status, flag and number of lift-offs. The "
      "reference is exact in long double if gsl-rk8pd at 1e-13 agrees with it, and gsl-rk8pd otherwise.\n"
      "wrong: fraction of the other designs. rhs: evaluations of the acceleration per design.\n"
      "One thread. Settings that take longer than a few seconds are left out.");
  command.runs([arguments, designs, &status] {
    arguments->designs_given = designs.is_given();
    status = run(*arguments);
  });
}

}  // namespace leapmap::cli
