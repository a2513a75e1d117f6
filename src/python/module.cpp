// SPDX-License-Identifier: GPL-3.0-or-later
/// leapmap._core: what the Python package (leapmap/__init__.py) is made of. Arrays in, arrays out; everything
/// that computes lets go of Python's lock, and Ctrl-C ends it.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <thread>

#include "leapmap/leapmap.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "python/arguments.hpp"
#include "python/results.hpp"
#include "sweep/solve_blocks.hpp"

namespace py = pybind11;

namespace leapmap::python {
namespace {

/// Whether Python wants a call to end: asked of the thread that made it, now and then, the lock taken for it.
class Interrupts {
 public:
  bool operator()() {
    if (stopped_ || std::this_thread::get_id() != caller_) return stopped_;
    const auto now = Clock::now();
    if (now - asked_ < between) return false;
    asked_ = now;
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) caught_.emplace(), stopped_ = true;
    return stopped_;
  }

  /// Calls something of Python's; what it raises ends the work.
  template <class Call>
  void call(const Call& of_python) {
    const py::gil_scoped_acquire lock;
    try {
      of_python();
    } catch (py::error_already_set& error) {
      if (!caught_) caught_.emplace(error);
      stopped_ = true;
    }
  }

  /// What Python raised meanwhile is raised now.
  void rethrow() const {
    if (caught_) throw py::error_already_set(*caught_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds between{20};
  std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point asked_ = Clock::now();
  std::optional<py::error_already_set> caught_;  // looked at with the lock only
  std::atomic<bool> stopped_ = false;
};

Scene scene_of(const std::string& friction) {
  std::vector<std::string_view> names;
  for (const Model& model : models()) {
    if (model.name == friction) return {.friction = model.friction};
    names.push_back(model.name);
  }
  throw InputError(fmt::format("friction = '{}' is no model; allowed: {}", friction, fmt::join(names, ", ")));
}

py::dict solve(const py::dict& given, const std::string& friction, const std::vector<std::string>& fields,
               const std::string& method, double tolerance, long max_steps, int threads) {
  const Designs designs(given, scene_of(friction));
  Columns columns(fields, designs.scene(), designs.shape());
  Interrupts interrupts;
  SolveOptions options{.method = method, .tolerance = tolerance, .max_steps = max_steps, .threads = threads};
  options.stop_requested = [&] { return interrupts(); };
  try {
    const py::gil_scoped_release unlocked;
    solve_blocks(designs.count(), designs.scene(), options, columns.names(),
                 {[&](std::size_t first, std::span<Design> some) { designs.fill(first, some); },
                  [&](std::size_t first, std::span<const Outcome> some) { columns.take(first, some); }});
  } catch (const Stopped&) {
    interrupts.rethrow();
    throw;
  }
  return columns.arrays();
}

py::dict trace(const py::dict& given, const std::string& friction, double interval, const std::string& method,
               double tolerance, long max_steps) {
  const Designs designs(given, scene_of(friction));
  if (designs.count() != 1 || !designs.shape().empty())
    throw InputError("trace tells the motion of one design; allowed: numbers, no arrays");
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

/// The spec of a file, or of a text if `origin` is given.
Spec spec_of(const std::string& path_or_text, const std::optional<std::string>& origin,
             const std::vector<std::string>& overrides) {
  return origin ? parse_spec(path_or_text, *origin, overrides) : read_spec(path_or_text, overrides);
}

py::dict sweep(const std::string& path_or_text, const std::optional<std::string>& origin,
               const std::vector<std::string>& overrides, const std::string& file, bool resume,
               bool overwrite, int threads, const py::object& progress) {
  const Spec spec = spec_of(path_or_text, origin, overrides);
  Interrupts interrupts;
  SweepOptions options{.resume = resume, .overwrite = overwrite, .threads = threads};
  options.stop_requested = [&] { return interrupts(); };
  if (!progress.is_none())
    options.progress = [&](std::size_t done, std::size_t total) {
      interrupts.call([&] { progress(done, total); });
    };
  Report report;
  {
    const py::gil_scoped_release unlocked;
    report = leapmap::sweep(spec, file, options);
  }
  interrupts.rethrow();
  return dict_of(report);
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
    row["friction"] =
        parameter.only_of ? py::object(py::str(std::string(model_of(*parameter.only_of).name))) : py::none();
    rows.append(row);
  }
  return rows;
}

py::list field_rows() {
  py::list rows;
  for (const Field& field : map_fields()) {
    py::dict row;
    row["name"] = field.name, row["unit"] = field.unit, row["meaning"] = field.long_name;
    row["friction"] =
        field.only_of ? py::object(py::str(std::string(model_of(*field.only_of).name))) : py::none();
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
      PyErr_SetString(PyExc_ValueError, error.what());
    } catch (const IoError& error) {
      PyErr_SetString(PyExc_OSError, error.what());
    } catch (const Stopped& error) {
      PyErr_SetString(PyExc_KeyboardInterrupt, error.what());
    }
  });
  module.def("solve", &python::solve);
  module.def("trace", &python::trace);
  module.def("sweep", &python::sweep);
  module.def("spec_text", [](const std::string& path_or_text, const std::optional<std::string>& origin,
                             const std::vector<std::string>& overrides) {
    return resolved_text(python::spec_of(path_or_text, origin, overrides));
  });
  module.def("spec_file", [](const std::string& path_or_text, const std::optional<std::string>& origin,
                             const std::vector<std::string>& overrides) {
    return python::spec_of(path_or_text, origin, overrides).output.file;
  });
  module.def("parameters", &python::parameter_rows);
  module.def("fields", &python::field_rows);
  module.def("phase_letters", &phase_letters);
  module.def("program_version", &program_version);
  module.def("git_revision", &git_revision);
  module.def("instruction_set", &instruction_set);
  module.def("instruction_sets", &instruction_sets);
  module.def("use_instruction_set", &use_instruction_set);
}
