// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/places.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <sched.h>

#include <new>
#include <vector>

namespace leapmap {

void leave_place() noexcept try {
  if (omp_get_proc_bind() == omp_proc_bind_false || omp_get_num_places() == 0) return;
  cpu_set_t everywhere;
  CPU_ZERO(&everywhere);
  for (int place = 0; place < omp_get_num_places(); ++place) {
    std::vector<int> processors(static_cast<std::size_t>(omp_get_place_num_procs(place)));
    omp_get_place_proc_ids(place, processors.data());
    for (const int processor : processors)
      if (processor < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(processor), &everywhere);
  }
  // Where that is not allowed it shares its place, no more.
  sched_setaffinity(0, sizeof everywhere, &everywhere);
} catch (const std::bad_alloc&) {  // it shares its place
}

std::string told_places() {
  if (omp_get_proc_bind() == omp_proc_bind_false || omp_get_num_places() == 0) return {};
  int processors = 0;
  for (int place = 0; place < omp_get_num_places(); ++place) processors += omp_get_place_num_procs(place);
  return fmt::format("{} places of {} processors, threads bound to them (OMP_PLACES, OMP_PROC_BIND)",
                     omp_get_num_places(), processors);
}

}  // namespace leapmap
