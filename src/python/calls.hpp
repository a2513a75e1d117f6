// SPDX-License-Identifier: GPL-3.0-or-later
/// What calls from Python have in common: Ctrl-C, threads after a fork, specs.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "spec/spec.hpp"

namespace leapmap::python {

namespace py = pybind11;

/// Whether Python wants a call to end: asked of the thread that made it, now and then, the lock taken for it.
class Interrupts {
 public:
  bool operator()() {
    if (stopped_ || std::this_thread::get_id() != caller_) return stopped_;
    const auto now = Clock::now();
    if (now - asked_ < between) return false;
    asked_ = now;
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) caught_.emplace(), stopped_ = true;
    return stopped_;
  }

  /// What Python raised meanwhile is raised now.
  void rethrow() const {
    if (caught_) throw py::error_already_set(*caught_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds between{20};
  std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point asked_ = Clock::now();
  std::optional<py::error_already_set> caught_;  // looked at with the lock only
  std::atomic<bool> stopped_ = false;
};

/// Whether this process was forked of one that had OpenMP's threads: they are not there, and one does all.
inline bool& forked() {
  static bool is_forked = false;
  return is_forked;
}
inline int threads_here(int threads) { return forked() ? 1 : threads; }

/// The spec of a file, or of a text if `origin` is given.
inline Spec spec_of(const std::string& path_or_text, const std::optional<std::string>& origin,
                    const std::vector<std::string>& overrides) {
  Spec spec = origin ? parse_spec(path_or_text, *origin, overrides) : read_spec(path_or_text, overrides);
  if (origin) read_points_of(spec);
  for (const std::string& note : spec.notes)
    if (PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) != 0) throw py::error_already_set();
  return spec;
}

/// leapmap.design and the problem it solves.
void add_design(py::module_& module);

}  // namespace leapmap::python
