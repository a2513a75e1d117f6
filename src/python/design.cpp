// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

#include "design/judge.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/find_designs.hpp"
#include "leapmap/fit.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "model/variable.hpp"
#include "python/arguments.hpp"
#include "python/calls.hpp"
#include "python/results.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A column of numbers, one for each design found.
template <class Value>
py::array_t<double> column_of(const FoundDesigns& found, const Value& value) {
  py::array_t<double> column(static_cast<py::ssize_t>(found.designs.size()));
  std::transform(found.designs.begin(), found.designs.end(), column.mutable_data(), value);
  return column;
}

py::dict dict_of(const FoundDesigns& found, const Spec& spec) {
  const Question question = question_of(spec);
  py::dict told, parameters, objectives, gradients, missed;
  for (std::size_t k = 0; k < question.free.size(); ++k)
    parameters[py::str(question.free[k].name)] =
        column_of(found, [&](const FoundDesign& one) { return one.free[k]; });
  for (std::size_t k = 0; k < question.objectives.size(); ++k)
    objectives[py::str(question.objectives[k].name)] =
        column_of(found, [&](const FoundDesign& one) { return one.objectives[k]; });
  for (std::size_t k = 0; !found.designs.empty() && k < found.designs[0].gradients.size(); ++k) {
    py::dict by;
    for (std::size_t j = 0; j < question.free.size(); ++j)
      by[py::str(question.free[j].name)] =
          column_of(found, [&](const FoundDesign& one) { return one.gradients[k].by_free[j]; });
    gradients[py::str(found.designs[0].gradients[k].of)] = by;
  }
  for (std::size_t k = 0; k < found.missed.size(); ++k)
    missed[py::str(spec.goals[k].field)] = found.missed[k];
  py::list binds;
  std::vector<Outcome> outcomes;
  std::vector<Design> designs;
  for (const FoundDesign& one : found.designs) {
    binds.append(py::cast(one.binds));
    outcomes.push_back(one.outcome), designs.push_back(one.design);
  }
  Columns columns({}, spec.scene, {static_cast<py::ssize_t>(outcomes.size())});
  columns.take(0, outcomes);
  told["reached"] = found.reached, told["parameters"] = parameters, told["objectives"] = objectives;
  told["outcomes"] = columns.arrays(), told["scales"] = scales_of_each(spec, designs);
  told["gradients"] = gradients, told["binds"] = binds;
  told["cliff_distance"] = column_of(found, [](const FoundDesign& one) {
    return one.cliff.empty() ? std::numeric_limits<double>::quiet_NaN() : one.cliff[0].distance;
  });
  told["yield_"] = column_of(found, [](const FoundDesign& one) { return one.yield.value; });
  told["missed"] = missed, told["hypervolume"] = found.hypervolume;
  told["evaluations"] = found.evaluations, told["seconds"] = found.seconds;
  return told;
}

py::dict design(const std::string& path_or_text, const std::optional<std::string>& origin,
                const std::vector<std::string>& overrides, std::uint64_t seed, std::size_t most,
                std::size_t sample, int threads) {
  const Spec spec = spec_of(path_or_text, origin, overrides);
  Interrupts interrupts;
  FindOptions options{.seed = seed, .most = most, .sample = sample, .threads = threads_here(threads)};
  options.stop_requested = [&] { return interrupts(); };
  FoundDesigns found;
  try {
    const py::gil_scoped_release unlocked;
    found = find_designs(spec, options);
  } catch (const Stopped&) {
    interrupts.rethrow();
    throw;
  }
  return dict_of(found, spec);
}

/// A question for optimizers of others.
class Problem {
 public:
  Problem(const std::string& path_or_text, const std::optional<std::string>& origin,
          const std::vector<std::string>& overrides, int threads)
      : question_(question_of(spec_of(path_or_text, origin, overrides))), judge_(question_, threads, {}) {}

  py::list free() const {
    py::list rows;
    for (const FreeParameter& parameter : question_.free)
      rows.append(
          py::make_tuple(parameter.name, parameter.side.low, parameter.side.high, parameter.side.log));
    return rows;
  }
  std::vector<std::string> objectives() const {
    std::vector<std::string> names;
    for (const Objective& objective : question_.objectives) names.push_back(objective.name);
    return names;
  }
  std::vector<std::string> names_of_free() const {
    std::vector<std::string> names;
    for (const FreeParameter& parameter : question_.free) names.push_back(parameter.name);
    return names;
  }
  /// Whether a number of the scene is another for each design: the size or the mass of a hoop.
  bool of_each_hoop(std::string_view number) const {
    return std::ranges::any_of(question_.free, [number](const FreeParameter& free) {
      return (number == "radius" && free.name == "hoop.diameter") ||
             (number == "mass" && is_body_mass(free.name));
    });
  }
  std::size_t evaluations() const { return judge_.evaluations(); }
  /// What is not free, as leapmap.solve takes it: all but gait.tolerance.
  py::dict fixed() const {
    py::dict numbers;
    const Scene& scene = question_.one.scene;
    numbers["friction"] = std::string(model_of(scene).name);
    for (const Parameter& parameter : parameters()) {
      const auto* of_design = std::get_if<double Design::*>(&parameter.member);
      const bool is_free =
          std::ranges::find(question_.free, parameter.name, &FreeParameter::name) != question_.free.end();
      const bool follows = of_design && question_.designs.varies_body() && follows_from_body(*of_design);
      const double value =
          of_design ? question_.one.design.**of_design : scene.*std::get<double Scene::*>(parameter.member);
      if (is_free || follows || of_each_hoop(parameter.name) || std::isnan(value) ||
          !has(scene, parameter.only_of))
        continue;
      const py::str name{std::string(parameter.name)};
      if (const std::optional<SiUnit> si = si_unit(question_.one, std::string(parameter.name)))
        numbers[name] = py::str(fmt::format("{} {}", value * si->size, si->name));
      else
        numbers[name] = value;
    }
    if (scene.clear_height_in_metres) numbers["clear_height"] = fmt::format("{} m", scene.clear_height);
    if (!scene.motor_in_flight) numbers[py::str(std::string(motor_switch))] = false;
    for (const auto& [key, member] : whole_numbers)
      if (scene.*member != Scene{}.*member) numbers[py::str(std::string(key))] = scene.*member;
    return numbers;
  }

  /// Of designs, a row of parameters each: costs, less is better, and violations, 0 where every goal is
  /// reached.
  py::tuple judge(const Numbers& places) {
    const auto count = static_cast<std::size_t>(places.ndim() == 2 ? places.shape(0) : 0),
               dimensions = question_.dimensions();
    if (places.ndim() != 2 || static_cast<std::size_t>(places.shape(1)) != dimensions)
      throw InputError(
          fmt::format("a design is a row with a number for each free parameter; allowed: {} "
                      "numbers a row: {}",
                      dimensions, fmt::join(names_of_free(), ", ")));
    const double* given = places.data();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < dimensions; ++k) {
        const FreeParameter& parameter = question_.free[k];
        const double value = given[i * dimensions + k];
        if (!(value >= parameter.side.low && value <= parameter.side.high))
          throw InputError(fmt::format("{} = {} is outside its bounds; allowed: from {} to {}",
                                       parameter.name, value, parameter.side.low, parameter.side.high));
      }
    std::vector<Verdict> verdicts(count);
    {
      const py::gil_scoped_release unlocked;
      const std::lock_guard one_at_a_time(busy_);
      if (forked())
        judge_.alone()->judge_values({given, count * dimensions}, verdicts);
      else
        judge_.judge_values({given, count * dimensions}, verdicts);
    }
    const std::size_t objectives = question_.objectives.size();
    py::array_t<double> costs({static_cast<py::ssize_t>(count), static_cast<py::ssize_t>(objectives)});
    py::array_t<double> violations(static_cast<py::ssize_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(verdicts[i].cost.begin(), objectives, costs.mutable_data() + i * objectives);
      violations.mutable_data()[i] = verdicts[i].violation;
    }
    return py::make_tuple(costs, violations);
  }

 private:
  Question question_;
  Judge judge_;
  std::mutex busy_;  // its workspaces are for one call at a time
};

std::vector<double> column_of(const py::handle& value) {
  const Numbers numbers = py::cast<Numbers>(value);
  return {numbers.data(), numbers.data() + numbers.size()};
}

/// Drops the times at which a point is missing.
void drop_missing(Track& track) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < track.t.size(); ++i) {
    if (std::isnan(track.x[i]) || std::isnan(track.y[i])) continue;
    track.t[kept] = track.t[i], track.x[kept] = track.x[i], track.y[kept] = track.y[i], ++kept;
  }
  for (auto* column : {&track.t, &track.x, &track.y}) column->resize(kept);
}

/// t, phi, spin; t and x_NAME, y_NAME of each point; or events as [(name, value, error)].
Measurements measurements_from(const py::dict& given, const Spec& spec, const MeasurementOptions& options) {
  if (!given.contains("t")) {
    Measurements measured{.origin = "measurements"};
    for (const auto& [key, value] : given) {
      const auto [measured_value, its_error] = py::cast<std::pair<double, double>>(value);
      measured.events.push_back({py::cast<std::string>(key), measured_value, its_error});
    }
    return measured;
  }
  Recording recording{.unit = "m"};
  const std::vector<double> t = column_of(given["t"]);
  for (const auto& [key, value] : given) {
    const auto name = py::cast<std::string>(key);
    if (name == "t") continue;
    const std::vector<double> column = column_of(value);
    if (column.size() != t.size())
      throw InputError(fmt::format("{}: a column of {} numbers beside {} times; allowed: equal numbers", name,
                                   column.size(), t.size()));
    if (name == "phi" || name == "spin") {
      recording.t = t, (name == "phi" ? recording.phi : recording.spin) = column;
    } else if (name.starts_with("x_") || name.starts_with("y_")) {
      auto track = std::ranges::find(recording.tracks, name.substr(2), &Track::name);
      if (track == recording.tracks.end())
        track = recording.tracks.insert(track, {.name = name.substr(2), .t = t});
      (name.starts_with("x_") ? track->x : track->y) = column;
    } else {
      throw InputError(
          fmt::format("'{}' is no column of a film; allowed: t, phi, spin, x_NAME, y_NAME", name));
    }
  }
  for (Track& track : recording.tracks) {
    if (track.x.empty() || track.y.empty())
      throw InputError(fmt::format("'{0}' has one coordinate; allowed: x_{0} and y_{0}", track.name));
    drop_missing(track);
  }
  return measurements_of(recording, spec, options);
}

/// A recording's columns by name.
py::dict dict_of(const Recording& recording) {
  const auto array = [](const std::vector<double>& values) {
    return Numbers(static_cast<py::ssize_t>(values.size()), values.data());
  };
  py::dict columns, tracks;
  for (const Track& track : recording.tracks) {
    py::dict one;
    one["t"] = array(track.t), one["x"] = array(track.x), one["y"] = array(track.y);
    tracks[py::str(track.name)] = one;
  }
  columns["tracks"] = tracks, columns["unit"] = recording.unit, columns["notes"] = py::cast(recording.notes);
  if (!recording.t.empty()) columns["t"] = array(recording.t), columns["phi"] = array(recording.phi);
  if (!recording.spin.empty()) columns["spin"] = array(recording.spin);
  return columns;
}

py::dict dict_of(const ModelFit& fit) {
  py::dict told, parameters;
  for (const FittedParameter& parameter : fit.parameters) {
    py::dict of;
    of["value"] = parameter.value, of["error"] = parameter.error, of["low"] = parameter.low,
    of["high"] = parameter.high;
    of["identified"] = parameter.identified, of["at_bound"] = parameter.at_bound;
    parameters[py::str(parameter.name)] = of;
  }
  const auto count = static_cast<py::ssize_t>(fit.parameters.size());
  py::array_t<double> correlations({count, count});
  std::copy(fit.correlations.begin(), fit.correlations.end(), correlations.mutable_data());
  told["friction"] = std::string(model_of(fit.scene).name), told["found"] = fit.found, told["why"] = fit.why;
  told["parameters"] = parameters, told["correlations"] = correlations, told["chi_square"] = fit.chi_square;
  told["judged"] = fit.judged, told["explains"] = explains(fit), told["probability"] = fit.probability,
  told["misfit"] = fit.misfit;
  told["after_landing"] = fit.after_landing, told["degrees"] = fit.degrees, told["error"] = fit.error,
  told["information"] = fit.information, told["correlation"] = fit.correlation,
  told["independent"] = fit.independent;
  told["model"] = py::array_t<double>(static_cast<py::ssize_t>(fit.model.size()), fit.model.data());
  told["outliers"] = py::cast(fit.outliers);
  told["residuals"] =
      py::array_t<double>(static_cast<py::ssize_t>(fit.residuals.size()), fit.residuals.data());
  return told;
}

py::list fit(const py::object& data, const std::string& path_or_text,
             const std::optional<std::string>& origin, const std::vector<std::string>& overrides,
             const std::vector<std::string>& names, double error, bool allow_gaps, std::uint64_t seed,
             int threads, const std::vector<std::string>& free,
             const std::vector<std::tuple<std::string, double, double>>& markers, double fps, double scale,
             bool robust) {
  const Spec spec = spec_of(path_or_text, origin, overrides);
  MeasurementOptions reading{.scale = scale, .allow_gaps = allow_gaps, .error = error, .free = free};
  reading.recording.fps = fps;
  for (const auto& [track, at, angle] : markers) reading.markers.push_back({track, at, angle});
  const Measurements measured =
      py::isinstance<py::dict>(data)
          ? measurements_from(py::cast<py::dict>(data), spec, reading)
          : read_measurements(py::cast<std::vector<std::string>>(data), spec, reading);
  Interrupts interrupts;
  FitOptions options{.models = {},
                     .free = parameters_among(free),
                     .loss = robust ? Loss::huber : Loss::squares,
                     .seed = seed,
                     .threads = threads_here(threads)};
  for (const std::string& name : names) {
    const Model* model = find_model(name);
    if (!model) throw InputError("model = '" + name + "' is unknown; allowed: sticking, coulomb, both");
    options.models.push_back(model->friction);
  }
  options.stop_requested = [&] { return interrupts(); };
  FitReport report;
  try {
    const py::gil_scoped_release unlocked;
    report = leapmap::fit(measured, spec, options);
  } catch (const Stopped&) {
    interrupts.rethrow();
    throw;
  }
  py::list told;
  for (const ModelFit& one : report.models) told.append(dict_of(one));
  return told;
}

}  // namespace

void add_design(py::module_& module) {
  module.def("fit", &fit);
  module.def("read_film", [](const std::vector<std::string>& paths, double fps) {
    return dict_of(leapmap::read_film(paths, {.fps = fps}));
  });
  module.def("design", &design);
  py::class_<Problem>(module, "Problem")
      .def(py::init<const std::string&, const std::optional<std::string>&, const std::vector<std::string>&,
                    int>())
      .def("free", &Problem::free)
      .def("objectives", &Problem::objectives)
      .def("evaluations", &Problem::evaluations)
      .def("fixed", &Problem::fixed)
      .def("judge", &Problem::judge);
}

}  // namespace leapmap::python
