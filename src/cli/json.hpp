// SPDX-License-Identifier: GPL-3.0-or-later
/// What commands print for programs. A number that does not apply, NaN, is null in JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>  // the whole takes seconds to compile: for files that make JSON

#include "model/fields.hpp"
#include "spec/spec.hpp"

namespace leapmap::cli {

/// Objects keep their members in the order in which they were added.
using Json = nlohmann::ordered_json;

/// The parameters of the spec's model, by name; null: follows another one.
Json design_json(const Spec& spec, const Design& design);

/// A field's number; of a code a whole one; null where it does not apply.
Json number_json(const Field& field, const Outcome& outcome);

/// Prints the object, a line for each member and for each item of a list of objects or lists. Throws as
/// write_out does.
void say_json(const Json& object);

}  // namespace leapmap::cli
