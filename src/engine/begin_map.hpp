// SPDX-License-Identifier: GPL-3.0-or-later
/// What lies where a map is to be, and how a sweep begins or goes on with it.
#pragma once

#include <span>
#include <string>

#include "leapmap/sweep.hpp"
#include "map/writer.hpp"

namespace leapmap {

/// Refuses (InputError) to write the map over what it is made from: the spec or its list of designs.
void refuse_own_input(const Spec& spec, const std::string& map);

/// True if a sweep to be resumed has ended already: its map is there, of the same spec; or its shard, begun
/// as this one would be. opening: as of begin_map.
bool is_done(const std::string& map, const Spec& spec, std::span<const hdf5::Attribute> opening,
             const SweepOptions& options, Locking locking);

/// Begins a map, or goes on with what an earlier sweep left of it. opening: the root's attributes of a new
/// one.
MapWriter begin_map(const std::string& map, const Spec& spec, const MapLayout& layout, const Tiling& tiling,
                    std::span<const hdf5::Attribute> opening, const SweepOptions& options, Locking locking);

}  // namespace leapmap
