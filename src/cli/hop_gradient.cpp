// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/hop_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/output.hpp"
#include "model/fields.hpp"
#include "model/model.hpp"
#include "request/solver.hpp"
#include "spec/options.hpp"

namespace leapmap::cli {
namespace {

struct Row {
  const Field* quantity;
  std::vector<double> by;
};

/// The rows of what the design has, and the parameters of the columns.
struct Table {
  std::vector<const Option*> parameters;
  std::vector<Row> rows;
};

Table table_of(const Spec& original) {
  Spec spec = original;
  spec.output = {};
  for (const Field* field : fields_of(spec.scene))
    if (can_be_differentiated(*field)) spec.output.gradients.emplace_back(field->name);
  check_spec(spec);
  const Request request = request_of(spec);
  const GradientWanted wanted = derivatives_of(request);
  Gradients gradients(wanted);
  Outcome outcome;
  make_gradient_solver(request)({&spec.design, 1}, {&outcome, 1}, gradients);

  Table table;
  for (const std::size_t by : wanted.by)
    for (const Option* parameter : design_parameters(spec))
      if (member_of(*parameter) == differentiable[by]) table.parameters.push_back(parameter);
  for (std::size_t i = 0; i < wanted.of.size(); ++i) {
    if (std::isnan(wanted.of[i].of(outcome))) continue;
    Row row{find_field(spec.output.gradients[i]), {}};
    for (std::size_t j = 0; j < wanted.by.size(); ++j) row.by.push_back(gradients.column(i, j)[0]);
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
  for (const Option* parameter : table.parameters) say(" {:>14}", parameter->key);
  say("\n");
  bool infinite = false;
  for (const Row& row : table.rows) {
    const std::string_view unit = row.quantity->unit;
    say("{:<22}",
        unit == "1" ? std::string(row.quantity->name) : fmt::format("{} [{}]", row.quantity->name, unit));
    for (const double value : row.by) say(" {:>14.7g}", value);
    infinite = infinite || std::ranges::any_of(row.by, [](double value) { return std::isnan(value); });
    say("\n");
  }
  if (infinite)
    say("nan: infinite, as on a fold, at which a lift-off appears, or known to fewer than six digits. If\n"
        "mu_kinetic follows mu_static, the column mu_static is the derivative by both.\n");
}

Json gradient_json(const Spec& spec) {
  const Table table = table_of(spec);
  Json json = Json::object();
  for (const Row& row : table.rows) {
    Json& by = json[std::string(row.quantity->name)] = Json::object();
    for (std::size_t j = 0; j < row.by.size(); ++j) by[std::string(table.parameters[j]->key)] = row.by[j];
  }
  return json;
}

}  // namespace leapmap::cli
