// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap export: a map as a table for spreadsheets, a row a design, units in its header.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cli/commands.hpp"
#include "cli/output.hpp"
#include "cli/progress.hpp"
#include "cli/shown_units.hpp"
#include "cli/spoken.hpp"
#include "leapmap/errors.hpp"
#include "map/layout.hpp"
#include "map/reader.hpp"
#include "spec/designs.hpp"
#include "spec/map_spec.hpp"
#include "spec/spec_hoop.hpp"
#include "support/closest.hpp"
#include "support/csv.hpp"
#include "support/output_file.hpp"

namespace leapmap::cli {
namespace {

constexpr std::size_t most_rows = (1 << 20) - 1;  // what a spreadsheet has below its header

struct ExportArguments {
  std::string map, output, units;
  std::vector<std::string> fields;
  bool overwrite = false, quiet = false;
  Locking locking = Locking::required;
};

struct Column {
  std::string name{};
  const Field* field = nullptr;        ///< none: a parameter
  std::optional<std::size_t> along{};  ///< the axis whose values it has; none: a dataset
  ShownUnit shown{};
  bool held = false;     ///< in the unit of the nominal hoop
  bool by_hoop = false;  ///< the factor is another for each design's mass and radius
};

/// What is not found along the map is no column of it.
[[noreturn]] void refuse_field(const MapReader& map, const std::string& name) {
  if (find_option("design", name))
    throw InputError(
        fmt::format("--fields: {} is a parameter, which is always written; allowed: fields", name));
  std::vector<std::string_view> names;
  for (const std::string& field : map.fields())
    if (find_field(field)) names.emplace_back(field);
  throw InputError(fmt::format("--fields: {} has no '{}'{}; allowed: {}", map.path(), name,
                               did_you_mean(name, names), fmt::join(names, ", ")));
}

std::vector<Column> columns_of(const MapReader& map, const ExportArguments& arguments) {
  std::vector<Column> columns;
  if (!map.is_list())
    for (std::size_t k = 0; k < map.dimensions().size(); ++k)
      columns.push_back({.name = map.dimensions()[k].name, .along = k});
  for (const std::string& name : map.fields()) {
    const Field* field = find_field(name);
    const bool asked = !field || arguments.fields.empty() ||
                       std::ranges::find(arguments.fields, name) != arguments.fields.end();
    if (asked) columns.push_back({.name = name, .field = field});
  }
  for (const std::string& name : arguments.fields)
    if (!map.has(name) || !find_field(name)) refuse_field(map, name);
  return columns;
}

/// Of a column, where the hoop is of that size and mass.
ShownUnit shown_by(ShownUnits& units, const Column& column, const Spec& spec, const Scales& scales) {
  const bool of_made = column.field && std::holds_alternative<OfMade>(column.field->source);
  units.scale(of_made ? scales_of_manufactured(spec, scales) : scales);
  return column.field ? units.of(*column.field) : units.of(column.name);
}

void choose_units(std::vector<Column>& columns, ShownUnits& units, const Spec& spec) {
  Scales scales = nominal_scales(spec);
  for (Column& column : columns) {
    column.shown = shown_by(units, column, spec, scales);
    const std::optional<SiUnit> si = si_unit(spec, column.name);
    column.held = si.has_value();
    // What the hoops share in the SI is read back as that, unless another unit is asked for.
    if (si && column.shown.factor == 1.0) column.shown = {std::string(si->name), si->size};
  }
  for (const std::string& unit : units.without_column())
    tell(fmt::format("--units: no column of this map is in {}; a quantity that is, output.fields may name",
                     unit));
  if (!mass_varies(spec) && !find_varying(spec, "hoop.diameter")) return;
  scales.mass *= 2.0, scales.radius *= 3.0;
  for (Column& column : columns)
    column.by_hoop = !column.held && shown_by(units, column, spec, scales).factor != column.shown.factor;
}

/// The sizes and total masses of a block's designs.
std::vector<Scales> scales_of(const DesignSpace& space, const Spec& spec, const Tile& block) {
  std::vector<Design> designs(block.count);
  space.fill(block, 0, designs);
  std::vector<Scales> scales;
  for (const Design& design : designs) scales.push_back(leapmap::scales_of(spec, design));
  return scales;
}

/// Every digit of what the map holds; of what is converted as many as hold.
std::string text_of(double value, double factor) {
  return factor == 1.0 ? fmt::format("{}", value) : fmt::format("{:.15g}", value * factor);
}

/// A column's texts for the designs of a block.
/// hoops: of the block's designs, where their scales differ.
std::vector<std::string> texts_of(const MapReader& map, const Column& column, const Tile& block,
                                  ShownUnits& units, const Spec& spec, const std::vector<Scales>& hoops) {
  std::vector<std::string> texts(block.count);
  if (column.field && std::holds_alternative<Word>(column.field->source)) {
    const std::vector<std::uint64_t> words = map.read_words(column.name, block);
    std::ranges::transform(words, texts.begin(),
                           [](std::uint64_t word) { return word == 0 ? "" : phase_letters(word); });
    return texts;
  }
  const auto* code = column.field ? std::get_if<Code>(&column.field->source) : nullptr;
  const std::vector<double> values = column.along ? std::vector<double>{} : map.read(column.name, block);
  const auto told = [&](double value, std::size_t i) {
    const bool own = column.by_hoop && !hoops.empty();
    return text_of(value, own ? shown_by(units, column, spec, hoops[i]).factor : column.shown.factor);
  };
  for (std::size_t i = 0; i < block.count; ++i) {
    if (column.along) {
      const std::size_t k = *column.along;
      const std::size_t place = block.start[k] + place_along(block.extent, i, k);
      texts[i] = told(map.dimensions()[k].values[place], i);
    } else if (code) {
      const auto number = static_cast<std::size_t>(values[i]);
      if (number < code->names.size())
        texts[i] = code->names[number];
      else if (code->names.empty() && number != code->fill)
        texts[i] = fmt::format("{}", number);
    } else if (std::isfinite(values[i])) {
      texts[i] = told(values[i], i);
    }
  }
  return texts;
}

/// A map's designs in their order, some rows of its first dimension at a time.
template <class F>
void for_each_block(const std::vector<std::size_t>& shape, std::size_t rows, const F& f) {
  for (std::size_t first = 0; first < shape[0]; first += rows) {
    Tile block{std::vector<std::size_t>(shape.size(), 0), shape, 0};
    block.start[0] = first, block.extent[0] = std::min(rows, shape[0] - first);
    block.count = designs_of(block.extent);
    f(block);
  }
}

std::string table_of(const MapReader& map, const Spec& spec, const std::vector<Column>& columns,
                     ShownUnits& units) {
  const DesignSpace space(spec);
  const bool differ = std::ranges::any_of(columns, &Column::by_hoop);
  const std::vector<std::string> labels = map.is_list() ? map.labels() : std::vector<std::string>{};
  std::vector<std::string> header;
  if (!labels.empty()) header.emplace_back(label_name);
  for (const Column& column : columns)
    header.push_back(column.shown.unit.empty() ? column.name
                                               : fmt::format("{} [{}]", column.name, column.shown.unit));
  std::string text = fmt::format("{}\n", fmt::join(header, ","));
  const std::size_t rows = map.blocks(map.fields()[0]).tile_shape()[0];
  for_each_block(map.shape(), rows, [&](const Tile& block) {
    std::vector<std::vector<std::string>> cells;
    const auto hoops = differ ? scales_of(space, spec, block) : std::vector<Scales>{};
    for (const Column& column : columns) cells.push_back(texts_of(map, column, block, units, spec, hoops));
    for (std::size_t i = 0; i < block.count; ++i) {
      if (!labels.empty()) text += csv_quoted(labels[block.start[0] + i]) + ",";
      for (std::size_t k = 0; k < cells.size(); ++k) (text += k > 0 ? "," : "") += cells[k][i];
      text += '\n';
    }
    if (noted_signal() != 0) throw Stopped("the export was stopped");
  });
  return text;
}

int run(const ExportArguments& arguments) {
  const std::array inputs{NamedPath{"MAP", arguments.map}};
  const std::array outputs{NamedPath{"-o", arguments.output}};
  for (const std::string_view ending : {".xlsx", ".xls", ".ods", ".h5"})
    if (arguments.output.ends_with(ending))
      throw InputError(
          fmt::format("-o {}: is no name of a CSV file; allowed: one that ends in .csv, which "
                      "spreadsheets open",
                      arguments.output));
  refuse_same_files(inputs, outputs);
  const MapReader map(arguments.map, arguments.locking);
  const std::size_t designs = designs_of(map.shape());
  if (designs > most_rows)
    throw InputError(
        fmt::format("{}: has {} designs; allowed: at most {}, the rows of a spreadsheet; Python "
                    "reads larger maps",
                    arguments.map, grouped(designs), grouped(most_rows)));
  const Spec spec = spec_of(map, arguments.map);
  std::vector<Column> columns = columns_of(map, arguments);
  ShownUnits units(arguments.units, nominal_scales(spec));
  choose_units(columns, units, spec);
  if (!map.is_whole()) tell(arguments.map + ": is INCOMPLETE: designs not computed have empty cells");
  TextOutput file("-o", arguments.output, {}, arguments.overwrite);
  note_signals();
  try {
    const std::string table = table_of(map, spec, columns, units);
    file.commit(table);
  } catch (const Stopped&) {
    tell("interrupted; nothing was written");
    return 128 + noted_signal();
  }
  if (!arguments.quiet) say("table    {}: {} designs\n", arguments.output, grouped(designs));
  return 0;
}

}  // namespace

void add_export(CommandLine& line, int& status) {
  Command command = line.command("export", "write a map as a CSV table, with units in its header");
  command.examples(
      {{"leapmap export maps/best.h5 -o best.csv --units \"mm deg ms\"", "for a spreadsheet"},
       {"leapmap export maps/best.h5 -o best.csv --fields jump_height,status", "two fields alone"}});
  auto arguments = std::make_shared<ExportArguments>();
  command.value("MAP", arguments->map, "a map, or the .part of an unfinished one (HDF5)")
      .required()
      .check(named_file());
  command.value("-o,--output", arguments->output, "the CSV file").required().check(named_file());
  command.value(
      "--units", arguments->units,
      "units to convert to, for example \"mm deg ms rpm N.m\"; each column takes the first that fits; "
      "default: the map's own, which derivatives keep");
  command.value("--fields", arguments->fields, "fields to write, separated by commas; default: all")
      .with_commas();
  command.flag("--overwrite", arguments->overwrite, "replace an existing file");
  command.flag("--quiet", arguments->quiet, "print errors only");
  add_no_lock(command, arguments->locking);
  command.footer(
      "A row for each design, in the map's order: its parameters, then the fields. Codes are words, phase "
      "sequences letters; a cell without a value is empty. To solve designs of the table again, keep the "
      "parameters' columns, and give them to leapmap sweep --points.");
  command.runs([arguments, &status] { status = run(*arguments); });
}

}  // namespace leapmap::cli
