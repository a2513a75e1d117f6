// SPDX-License-Identifier: GPL-3.0-or-later
/// In a browser nothing inside a design is asked to stop: a worker that is no longer wanted is ended.
#include "support/stop.hpp"

namespace leapmap {

void throw_if_stopped() {}

}  // namespace leapmap
