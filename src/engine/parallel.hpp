// SPDX-License-Identifier: GPL-3.0-or-later
/// One loop over independent pieces of work on all threads.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "support/stop.hpp"

namespace leapmap {

/// As many as --threads takes; OMP_NUM_THREADS may ask for more than the machine can bear.
inline constexpr int most_threads = 4096;

/// The number of threads that will be used: threads, or OpenMP's own number if 0.
inline int thread_count(int threads) {
  return std::min(threads > 0 ? threads : omp_get_max_threads(), most_threads);
}

/// The same question, whose answer stays true once it was: a stop is not taken back half-way.
inline std::function<bool()> latched(std::function<bool()> stop_requested) {
  if (!stop_requested) return {};
  return [ask = std::move(stop_requested), stopped = std::make_shared<std::atomic<bool>>(false)] {
    if (!*stopped && ask()) *stopped = true;
    return stopped->load();
  };
}

/// Calls make_worker() once on each thread, then the worker it returns with 0, 1, ..., count - 1: numbers are
/// begun in order, each by whichever thread is free. A worker that returns false ends its thread's part. An
/// exception ends the loop and is thrown on from here (none may leave an OpenMP region). Loops inside designs
/// ask `stop` (support/stop.hpp).
template <class MakeWorker>
void parallel_for_each(std::size_t count, int threads, const std::function<bool()>& stop,
                       const MakeWorker& make_worker) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  const auto team =
      static_cast<int>(std::clamp<std::size_t>(count, 1, static_cast<std::size_t>(thread_count(threads))));
#pragma omp parallel num_threads(team)
  {
    try {
      const StopScope scope(stop);
      auto worker = make_worker();
      for (std::size_t number = next++; number < count; number = next++)
        if (!worker(number)) break;
    } catch (...) {
      next = count;
#pragma omp critical(leapmap_parallel_failure)
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace leapmap
