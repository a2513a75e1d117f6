// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap._core: what the Python package (leapmap/__init__.py) is made of. Arrays in, arrays out; everything
/// that computes lets go of Python's lock, and Ctrl-C ends solve and sweep.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <optional>

#include "engine/map_layout.hpp"
#include "engine/solve_blocks.hpp"
#include "hoop/units.hpp"
#include "leapmap/leapmap.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "python/arguments.hpp"
#include "python/calls.hpp"
#include "python/hoops.hpp"
#include "python/results.hpp"
#include "spec/designs.hpp"
#include "spec/options.hpp"
#include "spec/quantity.hpp"
#include "spec/spec.hpp"
#include "support/printable.hpp"

namespace py = pybind11;

namespace leapmap::python {
namespace {

Scene scene_of(const std::string& friction) {
  if (const Model* model = find_model(friction)) return {.friction = model->friction};
  throw InputError(
      fmt::format("friction = '{}' is not a model; allowed: {}", friction, fmt::join(model_names(), ", ")));
}

py::dict solve(const py::dict& given, const std::string& friction, const std::vector<std::string>& fields,
               const std::string& method, double tolerance, long max_steps, int threads) {
  const Designs designs(given, scene_of(friction));
  Columns columns(fields, designs.scene(), designs.shape());
  Interrupts interrupts;
  SolveOptions options{
      .method = method, .tolerance = tolerance, .max_steps = max_steps, .threads = threads_here(threads)};
  options.stop_requested = [&] { return interrupts(); };
  try {
    const py::gil_scoped_release unlocked;
    solve_blocks(designs.count(), designs.scene(), options, columns.fields(),
                 {[&](std::size_t first, std::span<Design> some) { designs.fill(first, some); },
                  [&](std::size_t first, std::span<const Outcome> some) { columns.take(first, some); }});
  } catch (const Stopped&) {
    interrupts.rethrow();
    throw;
  }
  return columns.arrays();
}

py::dict gradient(const py::dict& given, const std::string& friction, const std::string& of, double tolerance,
                  int threads) {
  const Designs designs(given, scene_of(friction));
  const Field* field = find_field(of);
  const std::optional<OutcomeNumber> number =
      field && can_be_differentiated(*field) ? number_of(*field) : std::nullopt;
  if (!number || !has(designs.scene(), *field)) {
    std::vector<std::string_view> allowed;
    for (const Field* each : fields_of(designs.scene()))
      if (can_be_differentiated(*each)) allowed.push_back(each->name);
    throw InputError(
        fmt::format("of = '{}': has no derivatives; allowed: one of {}", of, fmt::join(allowed, ", ")));
  }
  Interrupts interrupts;
  SolveOptions options{.tolerance = tolerance, .threads = threads_here(threads)};
  options.stop_requested = [&] { return interrupts(); };
  std::vector<Design> found;
  try {
    const py::gil_scoped_release unlocked;
    std::vector<Design> all(designs.count());
    designs.fill(0, all);
    found = leapmap::gradient(all, *number, designs.scene(), options);
  } catch (const Stopped&) {
    interrupts.rethrow();
    throw;
  }
  py::dict arrays;
  for (const Parameter& parameter : parameters()) {
    const auto* member = std::get_if<double Design::*>(&parameter.member);
    if (!member || !has(designs.scene(), parameter.only_of)) continue;
    py::array_t<double> array(designs.shape());
    std::ranges::transform(found, array.mutable_data(), [&](const Design& one) { return one.**member; });
    arrays[py::str(std::string(parameter.name))] = array;
  }
  return arrays;
}

template <class Item>
py::array_t<double> numbers(const std::vector<Item>& items, double Item::*member) {
  py::array_t<double> array(static_cast<py::ssize_t>(items.size()));
  std::ranges::transform(items, array.mutable_data(), [&](const Item& item) { return item.*member; });
  return array;
}

py::dict gaits(const py::dict& given, int most_period, double tolerance) {
  const Designs designs(given, scene_of("sticking"));
  if (designs.count() != 1 || !designs.shape().empty())
    throw InputError("gaits takes one design; allowed: numbers, not arrays");
  Design design;
  designs.fill(0, {&design, 1});
  Gaits found;
  {
    const py::gil_scoped_release unlocked;
    found = find_gaits(design, designs.scene(), {.most_period = most_period, .tolerance = tolerance});
  }
  py::dict told, returns;
  py::list orbits;
  for (const Gait& gait : found.gaits) {
    py::dict one, jumps;
    one["period"] = gait.jumps.size(), one["multiplier"] = gait.multiplier, one["height"] = gait.height;
    one["speed"] = gait.speed, one["jump_time"] = gait.jump_time, one["energy_lost"] = gait.energy_lost;
    jumps["angle"] = numbers(gait.jumps, &Jump::angle), jumps["spin"] = numbers(gait.jumps, &Jump::spin);
    jumps["height"] = numbers(gait.jumps, &Jump::height), jumps["time"] = numbers(gait.jumps, &Jump::time);
    jumps["distance"] = numbers(gait.jumps, &Jump::distance);
    one["jumps"] = jumps;
    orbits.append(one);
  }
  returns["angle"] = numbers(found.returns, &ReturnPoint::angle);
  returns["next"] = numbers(found.returns, &ReturnPoint::next);
  returns["slope"] = numbers(found.returns, &ReturnPoint::slope);
  returns["height"] = numbers(found.returns, &ReturnPoint::height);
  py::array_t<bool> uphill(static_cast<py::ssize_t>(found.returns.size()));
  std::ranges::transform(found.returns, uphill.mutable_data(), &ReturnPoint::uphill);
  returns["uphill"] = uphill;
  told["gaits"] = orbits, told["returns"] = returns, told["is_whole"] = found.is_whole;
  return told;
}

py::dict trace(const py::dict& given, const std::string& friction, double interval, const std::string& method,
               double tolerance, long max_steps) {
  const Designs designs(given, scene_of(friction));
  if (designs.count() != 1 || !designs.shape().empty())
    throw InputError("trace takes one design; allowed: numbers, not arrays");
  Design design;
  designs.fill(0, {&design, 1});
  Motion motion;
  {
    const py::gil_scoped_release unlocked;
    motion = leapmap::trace(
        design, designs.scene(),
        {.interval = interval, .method = method, .tolerance = tolerance, .max_steps = max_steps});
  }
  return dict_of(motion, designs.scene());
}

py::dict scatter(const std::string& path_or_text, const std::optional<std::string>& origin,
                 const std::vector<std::string>& overrides, int threads) {
  const Spec spec = spec_of(path_or_text, origin, overrides);
  Interrupts interrupts;
  ScatterOptions options{.threads = threads_here(threads)};
  options.stop_requested = [&] { return interrupts(); };
  ScatterReport report;
  try {
    const py::gil_scoped_release unlocked;
    report = leapmap::scatter(spec, options);
  } catch (const Stopped&) {
    interrupts.rethrow();
    throw;
  }
  return dict_of(report, spec);
}

/// How far a sweep has come, for a thread of Python's to look at; and its order to stop.
struct Watch {
  std::atomic<std::size_t> done = 0, total = 0;
  std::atomic<bool> stop = false;
};

/// False: a power cut may undo the map's taking its place.
bool sweep(const std::string& path_or_text, const std::optional<std::string>& origin,
           const std::vector<std::string>& overrides, const std::string& file, bool resume, bool overwrite,
           int threads, Watch& watch) {
  const Spec spec = spec_of(path_or_text, origin, overrides);
  Interrupts interrupts;
  SweepOptions options{.resume = resume, .overwrite = overwrite, .threads = threads_here(threads)};
  options.stop_requested = [&] { return watch.stop || interrupts(); };
  options.progress = [&](std::size_t done, std::size_t total) { watch.done = done, watch.total = total; };
  Report report;
  {
    const py::gil_scoped_release unlocked;
    report = leapmap::sweep(spec, file, options);
  }
  interrupts.rethrow();
  return report.durable;
}

py::list spec_key_rows() {
  py::list rows;
  for (const Option& option : spec_options()) {
    py::dict row;
    row["section"] = std::string(option.section), row["key"] = std::string(option.key);
    row["meaning"] = std::string(option.meaning), row["unit"] = std::string(option.unit);
    row["axis"] = std::holds_alternative<ParameterSlot>(option.slot);
    row["one_of_many"] =
        std::holds_alternative<SpreadSlot>(option.slot) || std::holds_alternative<GoalSlot>(option.slot);
    row["allowed"] = allowed_values(option), row["default"] = default_value(option);
    rows.append(row);
  }
  return rows;
}

/// The model and the friction without which there is no such thing.
void tell_who_has(const OnlyOf& only_of, py::dict& row) {
  row["model"] = only_of.model ? py::object(py::str(std::string(name_of(*only_of.model)))) : py::none();
  row["friction"] =
      only_of.friction ? py::object(py::str(std::string(model_of(*only_of.friction).name))) : py::none();
}

py::list parameter_rows() {
  py::list rows;
  for (const Parameter& parameter : parameters()) {
    py::dict row;
    row["name"] = parameter.name, row["unit"] = parameter.unit, row["meaning"] = parameter.meaning;
    row["allowed"] = allowed_values(parameter.range, parameter.unit);
    const auto* of_design = std::get_if<double Design::*>(&parameter.member);
    row["array"] = of_design != nullptr;
    row["default"] = of_design ? Design{}.**of_design : Scene{}.*std::get<double Scene::*>(parameter.member);
    tell_who_has(parameter.only_of, row);
    rows.append(row);
  }
  return rows;
}

py::list field_rows() {
  py::list rows;
  for (const Field& field : map_fields()) {
    py::dict row;
    row["name"] = field.name, row["unit"] = field.unit, row["meaning"] = field.long_name;
    tell_who_has(field.only_of, row);
    const auto* code = std::get_if<Code>(&field.source);
    row["codes"] =
        code ? py::cast(std::vector<std::string>(code->names.begin(), code->names.end())) : py::none();
    row["type"] = code ? "uint8" : std::holds_alternative<Word>(field.source) ? "uint64" : "float64";
    rows.append(row);
  }
  return rows;
}

}  // namespace
}  // namespace leapmap::python

PYBIND11_MODULE(_core, module) {
  using namespace leapmap;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      PyErr_SetString(PyExc_ValueError, printable(error.what()).c_str());
    } catch (const IoError& error) {
      PyErr_SetString(PyExc_OSError, printable(error.what()).c_str());
    } catch (const Stopped& error) {
      PyErr_SetString(PyExc_KeyboardInterrupt, error.what());
    }
  });
  module.def("solve", &python::solve);
  module.def("gradient", &python::gradient);
  module.def("scatter", &python::scatter);
  python::add_design(module);
  module.def("trace", &python::trace);
  module.def("gaits", &python::gaits);
  module.def("sweep", &python::sweep);
  module.def("spec_file", [](const std::string& path_or_text, const std::optional<std::string>& origin,
                             const std::vector<std::string>& overrides) {
    return python::spec_of(path_or_text, origin, overrides).output.file;
  });
  module.def("sweep_bytes", [](const std::string& path_or_text, const std::optional<std::string>& origin,
                               const std::vector<std::string>& overrides) {
    const Spec spec = python::spec_of(path_or_text, origin, overrides);
    check_spec(spec);
    return map_file_bytes(layout_of(spec), tiling_of(spec));
  });
  module.def("parameters", &python::parameter_rows);
  module.def("fields", &python::field_rows);
  module.def("spec_keys", &python::spec_key_rows);
  module.def("phase_letters", &phase_letters);
  module.def("program_version", &program_version);
  module.def("number", [](const std::string& name, const std::string& text, const py::dict& beside) {
    return parse_number(*find_option({}, name), text, scales_of(python::Designs(beside, {}).scene()));
  });
  module.def("quantity", [](const std::string& text, const std::string& unit) {
    return number_in_own_unit(text, unit, {});
  });
  module.def("units_in_own", [](const std::string& unit, const std::string& field, const py::dict& beside) {
    const Field* known = find_field(field);
    return known ? units_in_own(unit, own_unit(*known), scales_of(python::Designs(beside, {}).scene()))
                 : std::nullopt;
  });
  module.def("reduce_hoops", &python::reduce_hoops);
  module.def("differentiate_by_hoop", &python::differentiate_by_hoop);
  module.def("powers_in_si", &python::powers_in_si);
  module.def("grows_with_size", [](const std::string& field) {
    const auto number = number_of(*find_field(field));
    return number && grows_with_size(*number);
  });
  module.def("after_fork_in_child", [] { python::forked() = true; });
  py::class_<python::Watch>(module, "Watch")
      .def(py::init<>())
      .def_property_readonly("done", [](const python::Watch& watch) { return watch.done.load(); })
      .def_property_readonly("total", [](const python::Watch& watch) { return watch.total.load(); })
      .def("stop", [](python::Watch& watch) { watch.stop = true; });
  module.def("instruction_set", &instruction_set);
  module.def("instruction_sets", &instruction_sets);
  module.def("use_instruction_set", &use_instruction_set);
}
