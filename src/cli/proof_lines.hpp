// SPDX-License-Identifier: GPL-3.0-or-later
/// What is proved, in words.
#pragma once

#include <string>
#include <string_view>

#include "cli/json.hpp"
#include "leapmap/prove.hpp"
#include "leapmap/worst_case.hpp"
#include "map/reader.hpp"
#include "spec/spec.hpp"

namespace leapmap::cli {

/// Of one design.
std::string proof_lines(const Proof& proof, const Spec& spec);
Json proof_json(const Proof& proof);

/// Of all hoops within tolerances; the worst of them as a command.
std::string worst_case_lines(const WorstCase& found, const Spec& spec);

/// The same in one line, and as JSON.
std::string worst_case_line(const WorstCase& found);
Json worst_case_json(const WorstCase& found);

/// How many cells, or designs, of a map are proved, crossed or open.
void say_findings(const MapReader& map, std::string_view of);

}  // namespace leapmap::cli
