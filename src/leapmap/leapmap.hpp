// SPDX-License-Identifier: GPL-3.0-or-later
/// @file
/// All of leapmap: passive and driven jumping hoops, solved one by one, by the million, or into maps.
#pragma once

#include "leapmap/audit.hpp"
#include "leapmap/body.hpp"
#include "leapmap/boundaries.hpp"
#include "leapmap/design.hpp"
#include "leapmap/errors.hpp"
#include "leapmap/estimate.hpp"
#include "leapmap/find_designs.hpp"
#include "leapmap/fit.hpp"
#include "leapmap/gait.hpp"
#include "leapmap/gradient.hpp"
#include "leapmap/map.hpp"
#include "leapmap/motion.hpp"
#include "leapmap/outcome.hpp"
#include "leapmap/prove.hpp"
#include "leapmap/scatter.hpp"
#include "leapmap/scene.hpp"
#include "leapmap/solve.hpp"
#include "leapmap/spec.hpp"
#include "leapmap/sweep.hpp"
#include "leapmap/trace.hpp"
#include "leapmap/units.hpp"
#include "leapmap/version.hpp"
#include "leapmap/worst_case.hpp"
