// SPDX-License-Identifier: GPL-3.0-or-later
#include "python/results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "leapmap/errors.hpp"
#include "model/model.hpp"
#include "model/parameters.hpp"
#include "spec/spec_hoop.hpp"
#include "support/closest.hpp"

namespace py = pybind11;

namespace leapmap::python {
namespace {

py::dtype type_of(const Field& field) {
  if (std::holds_alternative<Code>(field.source)) return py::dtype::of<std::uint8_t>();
  return std::holds_alternative<Word>(field.source) ? py::dtype::of<std::uint64_t>()
                                                    : py::dtype::of<double>();
}

/// A member of each item as an array.
template <class Item, class Value>
py::array_t<Value> column(const std::vector<Item>& items, Value Item::*member) {
  py::array_t<Value> array(static_cast<py::ssize_t>(items.size()));
  std::ranges::transform(items, array.mutable_data(), [&](const Item& item) { return item.*member; });
  return array;
}

template <class Item>
py::array_t<std::uint8_t> phase_column(const std::vector<Item>& items) {
  py::array_t<std::uint8_t> array(static_cast<py::ssize_t>(items.size()));
  std::ranges::transform(items, array.mutable_data(),
                         [](const Item& item) { return static_cast<std::uint8_t>(item.phase); });
  return array;
}

}  // namespace

Columns::Columns(const std::vector<std::string>& fields, const Scene& scene,
                 const std::vector<py::ssize_t>& shape) {
  std::vector<std::string_view> known;
  const std::vector<const Field*> there = fields_of(scene);
  for (const Field* field : there) known.push_back(field->name);
  for (const std::string& name : fields)
    if (std::ranges::find(known, name) == known.end())
      throw InputError(fmt::format("fields = {}: is not a field of this model{}; allowed: {}", name,
                                   did_you_mean(name, known), fmt::join(known, ", ")));
  for (const Field* field : there) {
    if (fields.empty() ? field->by_default == ByDefault::left_out
                       : std::ranges::find(fields, field->name) == fields.end())
      continue;
    py::array array(type_of(*field), shape);
    columns_.push_back({field, array, array.mutable_data()});
  }
}

std::vector<const Field*> Columns::fields() const {
  std::vector<const Field*> fields;
  for (const Column& column : columns_) fields.push_back(column.field);
  return fields;
}

void Columns::take(std::size_t first, std::span<const Outcome> outcomes) {
  for (const Column& column : columns_) {
    const auto put = [&]<class Value>(Value*, const auto& value_of) {
      std::ranges::transform(outcomes, static_cast<Value*>(column.begin) + first, value_of);
    };
    if (const auto* quantity = std::get_if<Quantity>(&column.field->source)) {
      put(static_cast<double*>(nullptr), [&](const Outcome& outcome) { return outcome.*quantity->member; });
    } else if (const auto* later = std::get_if<OfJump>(&column.field->source)) {
      put(static_cast<double*>(nullptr), [&](const Outcome& outcome) { return later->number.of(outcome); });
    } else if (const auto* code = std::get_if<Code>(&column.field->source)) {
      put(static_cast<std::uint8_t*>(nullptr), code->value);
    } else {
      const auto& word = std::get<Word>(column.field->source);
      put(static_cast<std::uint64_t*>(nullptr), [&](const Outcome& outcome) { return outcome.*word.member; });
    }
  }
}

py::dict Columns::arrays() const {
  py::dict arrays;
  for (const Column& column : columns_) arrays[py::str(std::string(column.field->name))] = column.array;
  return arrays;
}

namespace {

py::tuple pair_of(const Estimate& estimate) { return py::make_tuple(estimate.value, estimate.error); }

}  // namespace

py::dict scales_of_each(const Spec& spec, std::span<const Design> designs) {
  const Scales nominal = nominal_scales(spec);
  py::dict scales;
  scales["gravity"] = nominal.gravity;
  if (std::ranges::all_of(designs, [](const Design& d) { return d.size == 1.0 && d.mass == 1.0; })) {
    scales["radius"] = nominal.radius;
    if (nominal.mass > 0.0) scales["mass"] = nominal.mass;
    return scales;
  }
  py::array_t<double> radius(static_cast<py::ssize_t>(designs.size())), mass(radius.size());
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const Scales own = scales_of(spec, designs[i]);
    radius.mutable_data()[i] = own.radius, mass.mutable_data()[i] = own.mass;
  }
  scales["radius"] = radius;
  if (nominal.mass > 0.0) scales["mass"] = mass;
  return scales;
}

py::dict dict_of(const ScatterReport& report, const Spec& spec) {
  const auto by_spread = [&](const auto& values, const auto& told) {
    py::dict dict;
    for (std::size_t k = 0; k < values.size(); ++k)
      dict[py::str(spec.scatter.spreads[k].parameter)] = told(values[k]);
    return dict;
  };
  const auto number = [](double value) { return py::float_(value); };
  py::dict told, missed, made;
  told["samples"] = report.samples;
  told["yield"] = pair_of(report.yield), told["jumps"] = pair_of(report.jumps);
  for (std::size_t k = 0; k < spec.goals.size(); ++k)
    missed[py::str(spec.goals[k].field)] = pair_of(report.missed[k]);
  told["missed"] = missed;
  for (const MadeQuantity& quantity : report.quantities) {
    py::dict of;
    of["mean"] = pair_of(quantity.mean), of["sd"] = pair_of(quantity.sd), of["q05"] = pair_of(quantity.q05);
    of["q50"] = pair_of(quantity.q50), of["q95"] = pair_of(quantity.q95);
    told[py::str(quantity.field)] = of;
  }
  py::dict first, total, pairs;
  for (const Importance& importance : report.importance) {
    const py::str of(importance.of);
    first[of] = by_spread(importance.first, pair_of), total[of] = by_spread(importance.total, pair_of);
    pairs[of] = importance.pairs;
  }
  told["first"] = first, told["total"] = total, told["pairs"] = pairs;
  told["cut_off"] = by_spread(report.cut_off, number), told["shrink"] = by_spread(report.shrink, number);
  told["without"] = by_spread(report.without, number);
  told["shrink_all"] = report.shrink_all, told["unsolved"] = report.unsolved;
  for (const Parameter& parameter : parameters())
    if (const auto* member = std::get_if<double Design::*>(&parameter.member);
        member && has(spec.scene, parameter.only_of))
      made[py::str(std::string(parameter.name))] = column(report.made, *member);
  told["made"] = made;
  Columns outcomes({"jump_height", "jump_time", "spurious_first_jump", "status"}, spec.scene,
                   {static_cast<py::ssize_t>(report.samples)});
  outcomes.take(0, report.outcomes);
  told["outcomes"] = outcomes.arrays(), told["scales"] = scales_of_each(spec, report.made);
  return told;
}

py::dict dict_of(const Motion& motion, const Scene& scene) {
  py::dict told, points, phases, lift_offs;
  Columns outcome({}, scene, {});
  outcome.take(0, {&motion.outcome, 1});
  told["outcome"] = outcome.arrays();
  points["t"] = column(motion.points, &MotionPoint::t),
  points["phi"] = column(motion.points, &MotionPoint::phi);
  points["spin"] = column(motion.points, &MotionPoint::spin),
  points["x"] = column(motion.points, &MotionPoint::x);
  points["y"] = column(motion.points, &MotionPoint::y);
  points["normal_force"] = column(motion.points, &MotionPoint::normal_force);
  points["friction"] = column(motion.points, &MotionPoint::friction);
  if (!motion.points.empty() && !std::isnan(motion.points.front().pendulum_angle)) {
    points["pendulum_angle"] = column(motion.points, &MotionPoint::pendulum_angle);
    points["pendulum_spin"] = column(motion.points, &MotionPoint::pendulum_spin);
    points["motor_torque"] = column(motion.points, &MotionPoint::motor_torque);
  }
  points["phase"] = phase_column(motion.points);
  told["points"] = points;
  phases["t"] = column(motion.phases, &PhaseStart::t),
  phases["phi"] = column(motion.phases, &PhaseStart::phi);
  phases["spin"] = column(motion.phases, &PhaseStart::spin),
  phases["x"] = column(motion.phases, &PhaseStart::x);
  phases["direction"] = column(motion.phases, &PhaseStart::direction);
  phases["phase"] = phase_column(motion.phases);
  told["phases"] = phases;
  lift_offs["t"] = column(motion.candidates, &Candidate::t);
  lift_offs["phi"] = column(motion.candidates, &Candidate::phi);
  lift_offs["spin"] = column(motion.candidates, &Candidate::spin);
  lift_offs["height"] = column(motion.candidates, &Candidate::height);
  lift_offs["apex_time"] = column(motion.candidates, &Candidate::apex_time);
  lift_offs["flight_time"] = column(motion.candidates, &Candidate::flight_time);
  lift_offs["dip"] = column(motion.candidates, &Candidate::dip);
  lift_offs["is_jump"] = column(motion.candidates, &Candidate::is_jump);
  told["candidates"] = lift_offs;
  told["failure"] = motion.outcome.failure ? py::object(py::str(motion.outcome.failure)) : py::none();
  return told;
}

}  // namespace leapmap::python
