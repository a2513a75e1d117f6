// SPDX-License-Identifier: GPL-3.0-or-later
#include "leapmap/errors.hpp"
#include "leapmap/prove.hpp"

namespace leapmap {

bool can_prove() { return false; }

Proof prove(const DesignBox&, const Scene&, bool) {
  throw InputError(
      "this leapmap was built without Arb, with which proofs compute; allowed: with libflint-arb-dev "
      "(Debian), "
      "and compiled again");
}

Proof prove(const Design& design, const Scene& scene) { return prove(DesignBox{design, design}, scene); }

}  // namespace leapmap
