// SPDX-License-Identifier: GPL-3.0-or-later
/// Workspaces that are costly to make: threads take one each and give it back.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace leapmap {

template <class T>
class Pool {
 public:
  /// f(workspace) with one that nobody else has; make(): a new one, if there is none.
  template <class Make, class F>
  auto with(const Make& make, const F& f) {
    std::unique_ptr<T> one;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) one = std::move(idle_.back()), idle_.pop_back();
    }
    if (!one) {
      one = std::make_unique<T>(make());
      const std::lock_guard lock(mutex_);
      idle_.reserve(++made_);  // so that giving it back cannot fail
    }
    const Return back{*this, one};
    return f(*one);
  }

 private:
  struct Return {
    Pool& pool;
    std::unique_ptr<T>& one;
    ~Return() {
      const std::lock_guard lock(pool.mutex_);
      pool.idle_.push_back(std::move(one));
    }
  };

  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> idle_;
  std::size_t made_ = 0;
};

}  // namespace leapmap
