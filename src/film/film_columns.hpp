// SPDX-License-Identifier: GPL-3.0-or-later
/// What the columns of a film's table hold: found from their headers.
#pragma once

#include "film/film_table.hpp"
#include "leapmap/film.hpp"

namespace leapmap {

/// Adds a table's tracks or angles to a recording, and a line on how they were read. Throws InputError if no
/// column is of a point or an angle, times are missing, or a unit is of another kind.
void add_table(const FilmTable& table, const RecordingOptions& options, Recording& recording);

}  // namespace leapmap
