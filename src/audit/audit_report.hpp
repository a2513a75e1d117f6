// SPDX-License-Identifier: GPL-3.0-or-later
/// How what an audit found is summed up, and how a map keeps it.
#pragma once

#include <string>
#include <vector>

#include "leapmap/audit.hpp"
#include "map/reader.hpp"
#include "spec/spec.hpp"

namespace leapmap {

/// Adds what was found on other designs of the same sweep. The order does not matter.
void merge(AuditReport& report, const AuditReport& other);

/// A sentence for each kind of disagreement, with its first design and the command that shows it. Empty:
/// every method agrees.
std::vector<std::string> disagreements(const Spec& spec, const AuditReport& report);

/// A report as a map's attributes, and back. The latter throws IoError if they are
/// not there; an error that the map's version did not measure is NaN.
std::vector<hdf5::Attribute> audit_attributes(const AuditReport& report);
AuditReport read_audit(const MapReader& map);

}  // namespace leapmap
