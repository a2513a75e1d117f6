// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/hop_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/output.hpp"
#include "cli/shown_units.hpp"
#include "cli/spoken.hpp"
#include "model/fields.hpp"
#include "model/variable.hpp"
#include "numerics/sobol_points.hpp"
#include "spec/options.hpp"
#include "spec/quantity.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap::cli {
namespace {

/// Counts of values in bins of equal width.
struct Histogram {
  double from = 0.0, to = 0.0;
  std::vector<std::size_t> counts;
};

Histogram histogram_of(const ScatterReport& report, double Outcome::*quantity, std::size_t bins) {
  std::vector<double> values;
  for (const Outcome& outcome : report.outcomes)
    if (outcome.status == Status::jumped && std::isfinite(outcome.*quantity))
      values.push_back(outcome.*quantity);
  if (values.empty()) return {};
  const auto [least, most] = std::ranges::minmax(values);
  Histogram histogram{least, most, std::vector<std::size_t>(bins)};
  const double width = (most - least) / static_cast<double>(bins);
  for (const double value : values)
    ++histogram
          .counts[width > 0.0 ? std::min(bins - 1, static_cast<std::size_t>((value - least) / width)) : 0];
  return histogram;
}

/// Half of the 95 % interval.
double half_interval(const Estimate& estimate) { return 1.96 * estimate.error; }

/// With as many digits as the error leaves.
std::string told(const Estimate& share) {
  const int digits =
      share.error > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(share.error))), 1, 12) : 4;
  return fmt::format("{:.{}f} +- {:.{}f}", share.value, digits, share.error, digits);
}

std::string index_of(const Estimate& index) {
  if (std::isnan(index.value)) return "-";
  return std::isnan(index.error) ? fmt::format("{:.2f} +- ?", index.value)
                                 : fmt::format("{:.2f} +- {:.2f}", index.value, half_interval(index));
}

/// Its width in the unit in which people give such numbers, if that does not depend on the hoop.
std::string law_of(const Spread& spread) {
  const OwnUnit* own = find_own_unit(find_option("scatter", spread.parameter)->unit);
  const bool in_si = own && own->name == own->si && !spread.percent;
  const double factor = in_si ? *units_in_own(own->example, own->name, {}) : 1.0;
  return fmt::format("{} {:.4g}{}{}", spread.law == Spread::Law::normal ? "normal" : "uniform",
                     spread.width * factor, spread.percent || in_si ? " " : "",
                     spread.percent ? "%"
                     : in_si        ? own->example
                                    : "");
}

/// For example "jump_height { at_least = 0.8 }".
std::string goal_of(const Goal& goal) { return goal.field + " " + text_of(goal); }

/// Of the column that names the tolerances.
std::size_t name_width(const Spec& spec) {
  std::size_t width = 16;
  for (const Spread& spread : spec.scatter.spreads) width = std::max(width, spread.parameter.size());
  return width;
}

void print_spreads(const Spec& spec, const ScatterReport& report) {
  say("{:<{}} {:<18} {:>9}", "tolerance", name_width(spec), "distribution", "truncated");
  say("{}\n", report.shrink.empty() ? "" : "   yield without it; largest width for a yield of 99 %");
  for (std::size_t k = 0; k < spec.scatter.spreads.size(); ++k) {
    const Spread& spread = spec.scatter.spreads[k];
    say("{:<{}} {:<18} {:>8.2g} %", spread.parameter, name_width(spec), law_of(spread),
        100.0 * report.cut_off[k]);
    if (!report.shrink.empty())
      say("   {:.4f}; {}", report.without[k],
          report.shrink[k] >= 1.0   ? "unchanged"
          : report.shrink[k] <= 0.0 ? "no width is small enough"
                                    : fmt::format("{:.1f} % of its width", 100.0 * report.shrink[k]));
    say("\n");
  }
  if (!report.shrink.empty() && report.shrink_all < 1.0)
    say("{}\n", report.shrink_all > 0.0
                    ? fmt::format("All together must shrink to {:.1f} %.", 100.0 * report.shrink_all)
                    : "No tolerance is tight enough: the nominal design misses a goal.");
}

void print_quantities(const Spec& spec, const ScatterReport& report, ShownUnits& units) {
  say("\n{:<20} {:>12} {:>12} {:>12} {:>12} {:>12}\n", "if it jumps", "mean", "deviation", "5 %", "50 %",
      "95 %");
  for (const MadeQuantity& told : report.quantities) {
    const Field& field = *find_field(told.field);
    const ShownUnit shown = units.of(field);
    say("{:<20}", shown.unit.empty() ? told.field : fmt::format("{} [{}]", told.field, shown.unit));
    for (const Estimate* estimate : {&told.mean, &told.sd, &told.q05, &told.q50, &told.q95})
      say(" {:>12.5g}", estimate->value * shown.factor);
    say("\n{:<20}", "  error");
    for (const Estimate* estimate : {&told.mean, &told.sd, &told.q05, &told.q50, &told.q95})
      say(" {:>12.1e}", estimate->error * shown.factor);
    say("\n");
    if (!spec.hoop || units.beside(told.mean.value, field).empty()) continue;
    say("{:<20}", "");
    for (const Estimate* estimate : {&told.mean, &told.sd, &told.q05, &told.q50, &told.q95})
      say(" {:>12}", std::string_view(units.beside(estimate->value, field)).substr(1));
    say("\n");
  }
}

void print_histogram(const Spec& spec, const ScatterReport& report, ShownUnits& units) {
  constexpr std::size_t bins = 20;
  constexpr double widest = 50.0;
  const Histogram histogram = histogram_of(report, &Outcome::jump_height, bins);
  if (histogram.counts.empty()) return;
  auto goal = std::ranges::find(spec.goals, "jump_height", &Goal::field);
  // In mm it is at another place for hoops of every size.
  if (goal != spec.goals.end() && goal->unit_of_nominal > 0.0 &&
      std::isnan(scales_of_manufactured(spec, nominal_scales(spec)).radius))
    goal = spec.goals.end();
  const double unit = goal != spec.goals.end() && goal->unit_of_nominal > 0.0 ? goal->unit_of_nominal : 1.0;
  const double most = static_cast<double>(std::ranges::max(histogram.counts));
  const double width = (histogram.to - histogram.from) / static_cast<double>(bins);
  const ShownUnit shown = units.of(*find_field("jump_height"));
  say("\njump_height{}\n", shown.unit.empty() ? "" : fmt::format(" [{}]", shown.unit));
  for (std::size_t i = 0; i < bins; ++i) {
    const double from = histogram.from + width * static_cast<double>(i), to = from + width;
    const auto within = [&](double bound) { return bound >= from && bound < to; };
    const bool marked =
        goal != spec.goals.end() && (within(goal->at_least / unit) || within(goal->at_most / unit));
    say("{:>9.4f} {}{}\n", from * shown.factor, marked ? '>' : '|',
        std::string(
            static_cast<std::size_t>(std::ceil(widest * static_cast<double>(histogram.counts[i]) / most)),
            '#'));
    if (width == 0.0) break;
  }
  if (goal != spec.goals.end()) say("          > the goal\n");
}

/// Whether anything varies there.
bool tells(const Importance& importance) {
  return std::ranges::any_of(importance.total,
                             [](const Estimate& index) { return !std::isnan(index.value); });
}

void print_importance(const Spec& spec, const ScatterReport& report) {
  say("\nSobol' indices, first order and total, +- half of a 95 % interval; -: nothing varies, or none "
      "jumps\n{:<{}}",
      "", name_width(spec));
  for (const Importance& importance : report.importance)
    if (tells(importance)) say(" {:>15} {:>15}", importance.of, "in total");
  say("\n");
  for (std::size_t k = 0; k < spec.scatter.spreads.size(); ++k) {
    say("{:<{}}", spec.scatter.spreads[k].parameter, name_width(spec));
    for (const Importance& importance : report.importance)
      if (tells(importance))
        say(" {:>15} {:>15}", index_of(importance.first[k]), index_of(importance.total[k]));
    say("\n");
  }
  for (const Importance& importance : report.importance)
    if (importance.pairs < 1.0 && importance.pairs > 0.0)
      say("{}: from the {:.1f} % of pairs in which both hoops jump.\n", importance.of,
          100.0 * importance.pairs);
}

Json json_of(const Estimate& estimate) { return {{"value", estimate.value}, {"error", estimate.error}}; }

Json json_of(const std::vector<Estimate>& estimates, const std::vector<Spread>& spreads) {
  Json json = Json::object();
  for (std::size_t k = 0; k < spreads.size(); ++k) json[spreads[k].parameter] = json_of(estimates[k]);
  return json;
}

Json json_of(const Histogram& histogram) {
  return {{"from", histogram.from}, {"to", histogram.to}, {"counts", histogram.counts}};
}

}  // namespace

void print_scatter(const Spec& spec, const ScatterReport& report, const std::string& unit_words) {
  ShownUnits units(unit_words, scales_of_manufactured(spec, nominal_scales(spec)));
  say("\nManufactured: {} hoops in {} replicates, seed {}. Errors are standard errors.\n",
      grouped(report.samples), SobolPoints::replicates, spec.scatter.seed);
  print_spreads(spec, report);
  say("\n");
  if (!spec.goals.empty()) say("{:<34} {}\n", "yield: reaches every goal", told(report.yield));
  for (std::size_t k = 0; k < spec.goals.size(); ++k)
    say("  misses {:<25} {}\n", goal_of(spec.goals[k]), told(report.missed[k]));
  say("{:<34} {}\n", "jumps", told(report.jumps));
  if (report.unsolved > 0.0)
    say("The method failed on {:.3g} % of the hoops, which the errors include.\n", 100.0 * report.unsolved);
  print_quantities(spec, report, units);
  print_histogram(spec, report, units);
  print_importance(spec, report);
}

Json scatter_json(const Spec& spec, const ScatterReport& report) {
  constexpr std::size_t bins = 60;
  const bool shrinks = !report.shrink.empty();
  Json json{{"samples", report.samples},
            {"seed", spec.scatter.seed},
            {"yield", json_of(report.yield)},
            {"jumps", json_of(report.jumps)},
            {"unsolved", report.unsolved},
            {"spreads", Json::object()},
            {"shrink_all", shrinks ? Json(report.shrink_all) : Json()},
            {"goals", Json::object()},
            {"quantities", Json::object()},
            {"importance", Json::object()}};
  for (std::size_t k = 0; k < spec.scatter.spreads.size(); ++k) {
    const Spread& spread = spec.scatter.spreads[k];
    json["spreads"][spread.parameter] = {{"law", spread.law == Spread::Law::normal ? "normal" : "uniform"},
                                         {"width", spread.width},
                                         {"percent", spread.percent},
                                         {"cut_off", report.cut_off[k]},
                                         {"without", shrinks ? Json(report.without[k]) : Json()},
                                         {"shrink", shrinks ? Json(report.shrink[k]) : Json()}};
  }
  for (std::size_t k = 0; k < spec.goals.size(); ++k) {
    const Goal& goal = spec.goals[k];
    const double unit = goal.unit_of_nominal > 0.0 ? goal.unit_of_nominal : 1.0;
    Json& told = json["goals"][goal.field] = {{"at_least", goal.at_least / unit},
                                              {"at_most", goal.at_most / unit},
                                              {"missed", json_of(report.missed[k])}};
    if (goal.unit_of_nominal > 0.0)  // the limits above are those of the nominal hoop
      told["of_each_hoop"] = text_of(goal);
  }
  for (const MadeQuantity& of : report.quantities) {
    const auto member = std::get<Quantity>(find_field(of.field)->source).member;
    json["quantities"][of.field] = {
        {"mean", json_of(of.mean)}, {"sd", json_of(of.sd)},
        {"q05", json_of(of.q05)},   {"q50", json_of(of.q50)},
        {"q95", json_of(of.q95)},   {"histogram", json_of(histogram_of(report, member, bins))}};
  }
  for (const Importance& of : report.importance)
    json["importance"][of.of] = {{"pairs", of.pairs},
                                 {"first", json_of(of.first, spec.scatter.spreads)},
                                 {"total", json_of(of.total, spec.scatter.spreads)}};
  return json;
}

}  // namespace leapmap::cli
