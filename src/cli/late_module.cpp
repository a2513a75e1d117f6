// SPDX-License-Identifier: GPL-3.0-or-later
/// The module's side: the library's own functions, and a stop that is the program's.
#include "cli/late.hpp"
#include "film/unzip.hpp"
#include "leapmap/errors.hpp"
#include "proof/walked.hpp"
#include "support/stop.hpp"

namespace leapmap {
namespace {

thread_local void (*program_may_stop)() = nullptr;

}  // namespace

void throw_if_stopped() { program_may_stop(); }

namespace cli {
namespace {

Proof walked_here(const DesignBox& box, std::span<double Design::*const> varying, const Scene& scene,
                  bool times, void (*may_stop)()) {
#ifdef LEAPMAP_HAS_ARB
  program_may_stop = may_stop;
  return walked(box, varying, scene, times);
#else
  static_cast<void>(box), static_cast<void>(varying), static_cast<void>(scene), static_cast<void>(times);
  static_cast<void>(may_stop);
  return {};  // never asked: the library says before that it was built without Arb
#endif
}

constexpr Late late{LEAPMAP_GIT_REVISION, walked_here, unzipped};

}  // namespace
}  // namespace cli
}  // namespace leapmap

extern "C" __attribute__((visibility("default"))) const leapmap::cli::Late* leapmap_late() {
  return &leapmap::cli::late;
}
