// SPDX-License-Identifier: GPL-3.0-or-later
/// What the library itself asks of a spec. Every key is declared once, in options.cpp; parsing, validation,
/// --help, the resolved text and the map's axes all read that table.
#pragma once

#include "leapmap/spec.hpp"
#include "model/fields.hpp"

namespace leapmap {

/// A spec that a map tells. Those of older versions name what their model has no effect for; that is let
/// pass.
Spec parse_map_spec(std::string_view text, const std::string& origin);

/// The spec's file, for messages; "command line" if there is none.
std::string origin_of(const Spec& spec);

/// Reads the list that spec.points names, if it names one: a path beside the spec's file, or from the working
/// folder. Throws as read_points does, and InputError for a column that the scene has no effect for.
void read_points_of(Spec& spec);

/// As resolved_text, but for people: axes by their bounds where those give the same values here. Another
/// machine's exp and log may differ in the last bits of a log axis.
std::string readable_text(const Spec& spec);

/// A spread and a goal as a spec writes them, without their key: { normal = "2 %" }, { is = "jumped" }.
std::string text_of(const Spread& spread);
std::string text_of(const Goal& goal);

/// Whether maps hold a field: whether output.fields names it or, where that names none, it is stored then.
bool stores(const Output& output, const Field& field);

/// Throws InputError: [hoop] beside a model that has no drawing.
[[noreturn]] void refuse_drawing(const Spec& spec);

/// The name of the method that numerics.method stands for: "auto" is settled here. Rolling conserves energy
/// and sliding reduces to quadratures, so that hoops are solved exactly; a pendulum is integrated.
std::string resolved_method(const Numerics& numerics, const Scene& scene);
/// Of a spec or a request.
template <class Asked>
std::string resolved_method(const Asked& asked) {
  return resolved_method(asked.numerics, asked.scene);
}

}  // namespace leapmap
