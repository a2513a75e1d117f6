// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/output.hpp"
#include "spec/options.hpp"

namespace leapmap::cli {
namespace {

/// What is not UTF-8 is replaced.
std::string text_of(const Json& value) { return value.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string lines_of(const Json& value) {
  if (!value.is_array() || value.empty() || !value.front().is_structured()) return text_of(value);
  std::vector<std::string> items;
  for (const Json& item : value) items.push_back(text_of(item));
  return fmt::format("[\n    {}]", fmt::join(items, ",\n    "));
}

}  // namespace

Json design_json(const Spec& spec, const Design& design) {
  Json json = Json::object();
  for (const Option* parameter : design_parameters(spec)) {
    const double value = value_of(*parameter, design);
    // JSON has no infinity, and null is what is not known.
    json[std::string(parameter->key)] = std::isinf(value) ? Json("inf") : Json(value);
  }
  return json;
}

Json number_json(const Field& field, const Outcome& outcome) {
  const double number = stored_number(field, outcome);
  if (std::holds_alternative<Code>(field.source) && !std::isnan(number)) return static_cast<int>(number);
  return number;
}

void say_json(const Json& object) {
  std::vector<std::string> members;
  for (const auto& [name, value] : object.items())
    members.push_back(fmt::format("{}: {}", text_of(name), lines_of(value)));
  write_out(fmt::format("{{\n  {}\n}}\n", fmt::join(members, ",\n  ")));
}

}  // namespace leapmap::cli
