// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/hop_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/output.hpp"
#include "hoop/units.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"
#include "spec/spec_hoop.hpp"

namespace leapmap::cli {
namespace {

struct Row {
  const Field* quantity;
  std::vector<double> by;
};

/// The rows of what the design has, and the parameters or numbers of [hoop] of the columns.
struct Table {
  std::vector<Variable> variables;
  std::vector<Row> rows;
};

/// By what the design was given: its parameters, and in place of the ratios the numbers of [hoop].
std::vector<Variable> given_variables(const Spec& spec, const GradientWanted& wanted) {
  std::vector<Variable> given;
  for (const std::size_t by : wanted.by)
    for (const Option* parameter : design_parameters(spec)) {
      const bool follows = spec.hoop && follows_from_body(member_of(*parameter));
      if (member_of(*parameter) == differentiable[by] && !follows)
        given.push_back(*find_variable(parameter->key, nullptr));
    }
  if (spec.hoop) std::ranges::copy(variables_of(*spec.hoop), std::back_inserter(given));
  return given;
}

Table table_of(const Spec& original) {
  Spec spec = original;
  spec.output = {};
  for (const Field* field : fields_of(spec.scene))
    if (can_be_differentiated(*field, spec.scene)) spec.output.gradients.emplace_back(field->name);
  check_spec(spec);
  const Request request = request_of(spec);
  const GradientWanted wanted = derivatives_of(request);
  Gradients gradients(wanted);
  Outcome outcome;
  make_gradient_solver(request)({&spec.design, 1}, {&outcome, 1}, gradients);

  Table table;
  table.variables = given_variables(spec, wanted);
  for (std::size_t i = 0; i < wanted.of.size(); ++i) {
    if (std::isnan(wanted.of[i].of(outcome))) continue;
    Row row{find_field(spec.output.gradients[i]), {}};
    const Design by = gradients.of_design(wanted.of[i], 0);
    const ByScale by_scale = ByScale::of(spec.design, by, in_seconds(wanted.of[i], outcome), request.held);
    for (const Variable& variable : table.variables)
      row.by.push_back(variable.derivative(by, spec.hoop.value_or(Body{}), by_scale));
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace

void print_gradient(const Spec& spec) {
  const Table table = table_of(spec);
  if (table.rows.empty()) {
    say("\nNo derivatives: the hoop does not lift off.\n");
    return;
  }
  say("\nDerivatives, in the quantity's unit over the parameter's (angles in rad):\n{:<22}", "");
  const auto width = [&](std::size_t j) { return std::max<std::size_t>(14, table.variables[j].key.size()); };
  for (std::size_t j = 0; j < table.variables.size(); ++j) say(" {:>{}}", table.variables[j].key, width(j));
  say("\n");
  bool infinite = false;
  for (const Row& row : table.rows) {
    const std::string_view unit = row.quantity->unit;
    say("{:<22}",
        unit == "1" ? std::string(row.quantity->name) : fmt::format("{} [{}]", row.quantity->name, unit));
    for (std::size_t j = 0; j < row.by.size(); ++j) say(" {:>{}.7g}", row.by[j], width(j));
    infinite = infinite || std::ranges::any_of(row.by, [](double value) { return std::isnan(value); });
    say("\n");
  }
  if (spec.hoop)
    say("By numbers of [hoop], torques and spins are held in {}, and walls in hoop diameters.\n",
        spec.nominal_units.empty() ? "(m + m_p) g R and sqrt(g/R)"
                                   : fmt::format("the unit in which they are given: in N m or rad/s {}",
                                                 fmt::join(spec.nominal_units, ", ")));
  if (infinite)
    say("nan: infinite, as on a fold, at which a lift-off appears, or known to fewer than six digits. If\n"
        "mu_kinetic follows mu_static, the column mu_static is the derivative by both.\n");
}

Json gradient_json(const Spec& spec) {
  const Table table = table_of(spec);
  Json json = Json::object();
  for (const Row& row : table.rows) {
    Json& by = json[std::string(row.quantity->name)] = Json::object();
    for (std::size_t j = 0; j < row.by.size(); ++j) by[table.variables[j].key] = row.by[j];
  }
  return json;
}

}  // namespace leapmap::cli
