// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap info: what is in a map.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>

#include "audit/audit_report.hpp"
#include "cli/audit_lines.hpp"
#include "cli/commands.hpp"
#include "cli/info_place.hpp"
#include "cli/output.hpp"
#include "cli/shown_units.hpp"
#include "cli/spoken.hpp"
#include "leapmap/errors.hpp"
#include "map/reader.hpp"
#include "map/schema.hpp"
#include "map/writer.hpp"
#include "model/fields.hpp"
#include "spec/designs.hpp"
#include "spec/map_spec.hpp"
#include "spec/options.hpp"
#include "spec/spec_hoop.hpp"
#include "support/printable.hpp"

namespace leapmap::cli {
namespace {

struct InfoArguments {
  std::string path;
  std::string at, units;
  bool only_spec = false, failed = false;
  std::size_t limit = 20;
  Locking locking = Locking::required;
};

struct Extreme {
  double value;
  std::size_t design;
};

/// What a field's values come to. Codes have no extremes worth telling: they are counted.
struct Summary {
  std::size_t missing = 0;
  Extreme least{std::numeric_limits<double>::infinity(), 0},
      most{-std::numeric_limits<double>::infinity(), 0};
  std::array<std::size_t, 256> counts{};
  std::map<double, std::size_t> words;
};

/// Calls visit(block, its tile, values) on a field block by block, so that no map is too large.
template <class Visit>
void for_each_block(const MapReader& map, const std::string& field, const Visit& visit) {
  const Tiling blocks = map.blocks(field);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Tile tile = blocks.tile(b);
    visit(blocks, tile, map.read(field, tile));
  }
}

Summary summarise(const MapReader& map, const std::string& name) {
  constexpr std::size_t most_words = 100'000;  // that are told apart
  const Field* field = find_field(name);
  const bool code = field && std::holds_alternative<Code>(field->source);
  const bool word = field && std::holds_alternative<Word>(field->source);
  Summary summary;
  for_each_block(map, name, [&](const Tiling& blocks, const Tile& tile, const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = values[i];
      if (code) ++summary.counts[value >= 0.0 && value < 256.0 ? static_cast<std::uint8_t>(value) : 255];
      if (word && (summary.words.size() < most_words || summary.words.contains(value)))
        ++summary.words[value];
      if (std::isnan(value)) ++summary.missing;
      // The first of equals, in the order of the map, as blocks are in another.
      const auto better = [&](const Extreme& extreme, bool beats) {
        return beats || (value == extreme.value && blocks.number(tile, i) < extreme.design);
      };
      if (better(summary.least, value < summary.least.value)) summary.least = {value, blocks.number(tile, i)};
      if (better(summary.most, value > summary.most.value)) summary.most = {value, blocks.number(tile, i)};
    }
  });
  return summary;
}

/// By what a map's numbers are converted: what its designs share, what manufactured hoops do, and of each
/// design its own. Of a map whose spec cannot be read nothing is known, which matters where units are asked
/// for.
class MapScales {
 public:
  MapScales(const MapReader& map, const InfoArguments& arguments) {
    try {
      spec_ = spec_of(map, arguments.path);
      shared = common_scales(*spec_);
    } catch (const std::exception&) {
      if (!arguments.units.empty()) throw;
    }
  }

  Scales of(std::size_t design) const {
    if (!spec_ || !(mass_varies(*spec_) || find_varying(*spec_, "hoop.diameter"))) return shared;
    return scales_of(*spec_, DesignSpace(*spec_).at(design));
  }

  /// Of a parameter, which may be in the units of the nominal hoop.
  Scales of(const std::string& parameter, std::size_t design) const {
    return spec_ && is_held(*spec_, parameter) ? nominal_scales(*spec_) : of(design);
  }
  Scales of_all(const std::string& parameter) const {
    return spec_ && is_held(*spec_, parameter) ? nominal_scales(*spec_) : shared;
  }

  /// The unit of a parameter where none is asked for: the SI's if the hoops share it there, else the map's.
  ShownUnit unasked(const std::string& parameter, std::string_view of_map) const {
    if (spec_)
      if (const std::optional<SiUnit> si = si_unit(*spec_, parameter))
        return {std::string(si->name), si->size};
    return {of_map == "1" ? "" : printable(std::string(of_map)), 1.0};
  }
  /// Of statistics, as far as the hoops made after a design share them.
  Scales of_manufactured(const std::string& field, std::size_t design) const {
    return spec_ ? scales_of_manufactured(*spec_, of(field, design)) : shared;
  }

  Scales shared{.radius = Outcome::none, .gravity = Outcome::none, .mass = 0.0};

 private:
  std::optional<Spec> spec_;
};

/// A value of a dimension; a design's number whole.
std::string coordinate(const MapReader::Dimension& dimension, std::size_t position, ShownUnits& units,
                       const Scales& scales, const ShownUnit& unasked) {
  if (dimension.values.empty()) return fmt::format("{}", position);
  units.scale(scales);
  const ShownUnit shown = units.are_asked_for() ? units.of(dimension.name) : unasked;
  return fmt::format("{:.6g}{}{}", dimension.values[position] * shown.factor, shown.unit.empty() ? "" : " ",
                     shown.unit);
}

std::string place(const MapReader& map, const std::vector<std::string>& labels, std::size_t design,
                  ShownUnits& units, const MapScales& scales) {
  std::vector<std::size_t> position;
  unravel(design, map.shape(), position);
  std::vector<std::string> coordinates;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const auto& dimension = map.dimensions()[i];
    coordinates.push_back(
        fmt::format("{} {}", printable(dimension.name),
                    coordinate(dimension, position[i], units, scales.of(dimension.name, design),
                               scales.unasked(dimension.name, "1"))));
  }
  if (design < labels.size()) coordinates.back() += fmt::format(" ({})", printable(labels[design]));
  return fmt::format("{}", fmt::join(coordinates, ", "));
}

void print_counts(const Code& code, const Summary& summary, std::size_t designs) {
  constexpr std::size_t most_told = 12;
  std::size_t told = 0;
  for (std::size_t i = 0; i < summary.counts.size(); ++i) {
    if (summary.counts[i] == 0 || ++told > most_told) continue;
    std::string meaning = i < code.names.size() ? std::string(code.names[i])
                          : i == code.fill      ? "(no lift-off, or not computed)"
                                                : fmt::format("{}", i);
    say("  {:>12} {:5.1f} %  {}\n", summary.counts[i],
        100.0 * static_cast<double>(summary.counts[i]) / static_cast<double>(designs), meaning);
  }
  if (told > most_told) say("  and {} larger values\n", told - most_told);
}

/// The commonest phase sequences. Doubles hold those of up to 26 phases.
void print_sequences(const Summary& summary, std::size_t designs) {
  constexpr std::size_t most_told = 12;
  std::vector<std::pair<std::size_t, std::string>> counted;
  for (const auto& [word, count] : summary.words)
    counted.emplace_back(count, word < 0x1p53 ? phase_letters(static_cast<std::uint64_t>(word)) : "(longer)");
  std::ranges::stable_sort(counted, std::greater<>(), [](const auto& entry) { return entry.first; });
  for (std::size_t i = 0; i < std::min(counted.size(), most_told); ++i)
    say("  {:>12} {:5.1f} %  {}\n", counted[i].first,
        100.0 * static_cast<double>(counted[i].first) / static_cast<double>(designs), counted[i].second);
  if (counted.size() > most_told) say("  and {} other sequences\n", counted.size() - most_told);
}

/// Lists failed designs, each with the command that shows what happens.
int list_failed(const MapReader& map, const InfoArguments& arguments) {
  if (!map.has("status"))
    throw InputError(arguments.path + ": lacks the field status; allowed: a map with it");
  const Spec spec = spec_of(map, arguments.path);
  if (shape_of(spec) != map.shape())
    throw BrokenFile(arguments.path + ": is damaged: its spec describes other designs");
  const DesignSpace space(spec);
  std::size_t failed = 0;
  for_each_block(map, "status",
                 [&](const Tiling& blocks, const Tile& tile, const std::vector<double>& values) {
                   for (std::size_t i = 0; i < values.size(); ++i) {
                     if (values[i] != static_cast<double>(Status::failed) || ++failed > arguments.limit)
                       continue;
                     const std::size_t number = blocks.number(tile, i);
                     say("{}  # design {}\n", hop_command(spec, space.at(number)), told_design(spec, number));
                   }
                 });
  if (failed > arguments.limit)
    say("# and {} more (--limit {})\n", grouped(failed - arguments.limit), failed);
  say("# {} failed designs{}\n", grouped(failed),
      failed > 0 ? fmt::format("; solve them again: leapmap info --spec {0} > spec.toml && leapmap sweep "
                               "spec.toml -o {0} --retry-failed",
                               shell_quoted(arguments.path))
                 : "");
  return 0;
}

/// How much of a stopped sweep's map is there, and how to go on.
void print_incomplete(const MapReader& map, const std::string& part) {
  const std::size_t designs = designs_of(map.shape()), done = designs_in(map.status_counts());
  const std::string name = part.ends_with(".part") ? part.substr(0, part.size() - 5) : part;
  say("INCOMPLETE: {} of {} designs, {:.3g} %; resume: leapmap sweep SPEC.toml -o {} --resume\n",
      grouped(done), grouped(designs), 100.0 * static_cast<double>(done) / static_cast<double>(designs),
      shell_quoted(name));
}

/// The map's own words on how it was made.
struct Attributes {
  const MapReader& map;

  bool has(const char* name) const { return hdf5::has_attribute(map.file(), name); }
  std::string operator()(const char* name) const { return printable(map.attribute(name)); }
  std::string operator()(const char* name, fmt::format_string<double> form) const {
    return has(name) ? fmt::format(form, hdf5::read_number(map.file(), name)) : "?";
  }
};

void print_origin(const MapReader& map, const std::string& path) {
  const Attributes attribute{map};
  say("{}\n", attribute("title"));
  const std::string shards = map.attribute(shards_attribute);
  say("made {} on {} by leapmap {} (git {}), {} threads{}, {} s{}\n", attribute("date"), attribute("host"),
      attribute("program_version"), attribute("git_revision"), attribute("threads"),
      shards.empty() ? "" : " at most", attribute("wall_time", "{:.3g}"),
      shards.empty() ? ""
                     : fmt::format(" in all, in {} shards{}", printable(shards),
                                   map.shards().empty() ? "" : ", which hold its values and lie beside it"));
  if (!map.is_whole()) print_incomplete(map, path);
  say("method {}, tolerance {}\n", attribute("method"), attribute("tolerance"));
}

/// What the cross-check found.
void print_audit(const MapReader& map) {
  const Attributes attribute{map};
  if (attribute.has("audit_designs")) try {
      say_audit(read_audit(map));
    } catch (const IoError& error) {
      say("check    cannot be read: {}\n", printable(error.what()));
    }
  if (attribute.has("retry_designs"))
    say("retried  {} failed designs, after the check, by {} at tolerance {}\n", attribute("retry_designs"),
        attribute("retry_method"), attribute("retry_tolerance"));
}

void print_dimensions(const MapReader& map, ShownUnits& units, const MapScales& scales) {
  say("\ndimensions\n");
  for (const auto& dimension : map.dimensions()) {
    if (dimension.values.empty()) {
      say("  {:<16} {:>7} in a list\n", dimension.name, dimension.size);
      continue;
    }
    const auto [least, most] = std::ranges::minmax(dimension.values);
    units.scale(scales.of_all(dimension.name));
    const ShownUnit shown =
        units.are_asked_for() ? units.of(dimension.name) : scales.unasked(dimension.name, dimension.unit);
    say("  {:<16} {:>7} values from {:.6g} to {:.6g} {}\n", printable(dimension.name), dimension.size,
        least * shown.factor, most * shown.factor, shown.unit);
  }
}

void print_fields(const MapReader& map, ShownUnits& units, const MapScales& scales) {
  const std::size_t designs = designs_of(map.shape());
  say("\nfields, {} designs\n", designs);
  if (!map.has("status") && hdf5::has_attribute(map.file(), "status_counts")) {
    say("status, not stored but counted\n");
    Summary counted;
    std::ranges::copy(map.status_counts(), counted.counts.begin());
    print_counts(std::get<Code>(find_field("status")->source), counted, designs);
  }
  const std::vector<std::string> labels = map.labels();
  for (const std::string& name : map.fields()) {
    const Field* field = find_field(name);
    const Summary summary = summarise(map, name);
    say("{}\n", printable(name));
    if (field && std::holds_alternative<Code>(field->source)) {
      print_counts(std::get<Code>(field->source), summary, designs);
    } else if (field && std::holds_alternative<Word>(field->source)) {
      print_sequences(summary, designs);
    } else if (summary.missing == designs) {
      say("  none\n");
    } else {
      const bool listed = !field && find_option("", name);  // a number that a list of designs gives
      const bool of_made = field && std::holds_alternative<OfMade>(field->source);
      for (const auto& [words, extreme] :
           {std::pair{"least", &summary.least}, std::pair{"most", &summary.most}}) {
        units.scale(of_made ? scales.of_manufactured(name, extreme->design)
                            : scales.of(name, extreme->design));
        const ShownUnit shown = !units.are_asked_for() || (!field && !listed)
                                    ? scales.unasked(name, map.unit(name))
                                : field ? units.of(*field)
                                        : units.of(name);
        const std::string beside = field ? units.beside(extreme->value, *field) : "";
        say("  {:<5} {:<12.8g}{}{}{} at {}\n", words, extreme->value * shown.factor,
            shown.unit.empty() ? "" : " ", shown.unit, beside,
            place(map, labels, extreme->design, units, scales));
      }
      if (summary.missing > 0) say("  none  in {} designs\n", summary.missing);
    }
  }
}

int run(const InfoArguments& arguments) {
  std::error_code ignored;
  if (!std::filesystem::exists(arguments.path, ignored) && has_part(arguments.path, arguments.locking))
    throw IoError(fmt::format(
        "{}: does not exist yet, only {}; allowed: that file, or leapmap sweep --resume to complete it",
        arguments.path, part_of(arguments.path)));
  const MapReader map(arguments.path, arguments.locking);
  if (arguments.only_spec) {
    write_out(readable_text(parse_map_spec(map.attribute("spec"), arguments.path)));
    return 0;
  }
  if (arguments.failed) return list_failed(map, arguments);
  if (!arguments.at.empty()) {
    print_place(parse_map_spec(map.attribute("spec"), arguments.path), arguments.at, arguments.units);
    return 0;
  }
  const MapScales scales(map, arguments);
  ShownUnits units(arguments.units, scales.shared);
  print_origin(map, arguments.path);
  print_audit(map);
  print_dimensions(map, units, scales);
  print_fields(map, units, scales);
  units.refuse_unused();
  return 0;
}

}  // namespace

void add_info(CommandLine& line, int& status) {
  Command command = line.command("info", "summarise a map: axes, statuses, extremes and their places");
  command.examples({{"leapmap info m.h5", "axes, statuses, extremes"},
                    {"leapmap info m.h5 --at slope=0.4,mass_ratio=2.4",
                     "one design, and the distance to the nearest discontinuity"},
                    {"leapmap info m.h5 --units \"mm deg ms\"", "lengths in mm, angles in degrees"},
                    {"leapmap info m.h5 --spec > again.toml", "the spec that makes it again"},
                    {"leapmap info m.h5 --failed --limit 3", "commands that show what failed"}});
  auto arguments = std::make_shared<InfoArguments>();
  command.value("MAP", arguments->path, "a map, or the .part of an unfinished one (HDF5)")
      .required()
      .check(named_file());
  command.flag("--spec", arguments->only_spec, "print only the resolved spec that made it");
  command.flag("--failed", arguments->failed, "list failed designs, each with the command that reproduces it")
      .excludes("--spec");
  command
      .value("--at", arguments->at,
             "AXIS=VALUE,...: report one design: outcome, derivatives, nearest discontinuities")
      .check({[](std::string& at) { return at.empty() ? "is empty; allowed: AXIS=VALUE,..." : ""; }, "PLACE"})
      .excludes("--spec")
      .excludes("--failed");
  command
      .value("--units", arguments->units,
             "units of axes and fields, with blanks between them, for example \"mm deg ms\"; default: the "
             "map's, and beside them those of a drawing")
      .excludes("--spec")
      .excludes("--failed");
  command.value("--limit", arguments->limit, "longest list of failed designs; default: 20")
      .needs("--failed")
      .check(whole_number(0, 1e15));
  add_no_lock(command, arguments->locking);
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
