// SPDX-License-Identifier: GPL-3.0-or-later
/// The section [hoop] of a spec: a hoop as a drawing has it.
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hoop/body.hpp"
#include "spec/spec.hpp"
#include "spec/spec_entry.hpp"

namespace leapmap {

/// The weights of the section by their names alone; its numbers are added to the entries. Throws InputError
/// for keys that it lacks or that are unknown.
Body read_hoop(const toml::node& section, const std::string& origin, std::vector<Entry>& entries);

/// An entry for "hoop.slug.mass" of the command line. Throws as check_hoop_key does.
Entry hoop_override(const Body& body, const std::string& key, const toml::node& value);

/// Throws InputError if the body has no number of that key.
void check_hoop_key(const Body& body, const std::string& key, const std::string& place);

/// Puts the entry's number into spec.hoop, or its axis into spec.axes.
void assign_to_hoop(const Entry& entry, Spec& spec);

/// Throws InputError for a body that cannot be, nominal or along the axes.
void check_hoop(const Spec& spec);

/// What is possible but most likely a slip of units, in words for spec.notes.
std::vector<std::string> doubts_of_hoop(const Spec& spec);

/// What units of the spec's numbers are converted by: without the mass, or the radius, of which each design
/// has its own.
Scales common_scales(const Spec& spec);
/// Those of the nominal hoop.
Scales nominal_scales(const Spec& spec);
/// Those of the hoop that one of the spec's designs is.
Scales scales_of(const Spec& spec, const Design& design);
/// The same as far as hoops that are made after the design with the spec's tolerances share it.
Scales scales_of_manufactured(const Spec& spec, Scales scales);
/// Whether hoops that differ in mass or size may have the same of a parameter in the SI.
bool may_be_held(double Design::*parameter);
/// Has the spec's hoops share a parameter in the SI, that of the nominal one.
void hold(const std::string& parameter, Spec& spec);
/// Whether they do, and all the parameters that they share.
bool is_held(const Spec& spec, const std::string& parameter);
std::vector<SameInSi> held_in_si(const Spec& spec);
/// The SI's unit of a parameter that the hoops share, and how many of it are one of the nominal hoop's; none
/// of any other parameter.
struct SiUnit {
  double size;
  std::string_view name;
};
std::optional<SiUnit> si_unit(const Spec& spec, const std::string& parameter);
/// Whether masses of the body differ from design to design.
bool mass_varies(const Spec& spec);
/// Where masses of the body vary, no total mass is known.
void forget_mass_that_varies(Spec& spec);

/// "hoop.diameter", "hoop.slug.mass" and so on: of all numbers of the spec's body; none without [hoop].
std::vector<std::string> body_keys(const Spec& spec);

/// The keys, for --help.
std::string hoop_help();

/// The section as a resolved spec has it; empty: there is none.
std::string hoop_text(const Spec& spec, const std::function<std::string(const Axis&)>& text_of_axis);

}  // namespace leapmap
