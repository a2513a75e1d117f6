// SPDX-License-Identifier: GPL-3.0-or-later
/// Hands on what many threads finish in any order in the order of its numbers, from one thread of its own.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "engine/places.hpp"

namespace leapmap {

/// Holds at most `most_bytes` of items that wait for their turn or for the taker; a thread that brings more
/// waits, so that memory stays bounded when one item, or whoever takes them, is slow. Items must be begun in
/// order for that wait to end. The taker looks every few milliseconds for what is due: waking it for each
/// item would cost more than a small item takes. A single item needs no thread of its own: whoever finishes
/// takes it.
template <class Item>
class OrderedDelivery {
 public:
  using Take = std::function<void(Item&)>;

  /// items: so many will come at most.
  OrderedDelivery(std::size_t first, Take take, std::size_t most_bytes,
                  std::size_t items = std::numeric_limits<std::size_t>::max())
      : take_(std::move(take)), most_bytes_(most_bytes), next_(first) {
    if (items > 1) taker_ = std::thread([this] { leave_place(), take_all(); });
  }
  /// Abandons what still waits.
  ~OrderedDelivery() { end(State::abandoned); }

  /// Brings item `number`. False: the delivery has been closed or abandoned, bring no more.
  bool bring(std::size_t number, Item item, std::size_t bytes) {
    std::unique_lock lock(mutex_);
    const auto refused = [&] { return state_ != State::open || number >= end_; };
    const auto may_bring = [&] { return refused() || number == next_ || bytes_ + bytes <= most_bytes_; };
    if (!may_bring()) {
      ++held_up_;
      changed_.notify_all();
      changed_.wait(lock, may_bring);
      --held_up_;
    }
    if (refused()) return false;
    bytes_ += bytes;
    waiting_.emplace(number, Waiting{std::move(item), bytes});
    if (held_up_ > 0) changed_.notify_all();
    return true;
  }

  /// Waits until everything brought has been taken, and throws on what `take` threw. Nothing may be brought
  /// after.
  void finish() {
    if (!taker_.joinable() && state_ == State::open) {
      state_ = State::finished;
      take_all();
    }
    end(State::finished);
    if (failure_) std::rethrow_exception(failure_);
  }

  /// Item `number` will never come, and so none after it is taken.
  void close(std::size_t number) {
    const std::lock_guard lock(mutex_);
    end_ = std::min(end_, number);
    changed_.notify_all();
  }

  /// Ends the delivery: whoever waits is let go.
  void abandon() {
    const std::lock_guard lock(mutex_);
    state_ = State::abandoned;
    changed_.notify_all();
  }

 private:
  static constexpr std::chrono::milliseconds pause{5};
  enum class State { open, finished, abandoned };
  struct Waiting {
    Item item;
    std::size_t bytes;
  };

  void take_all() {
    std::unique_lock lock(mutex_);
    for (;;) {
      const auto due = [&] { return !waiting_.empty() && waiting_.begin()->first == next_; };
      while (state_ == State::open && !due())
        changed_.wait_for(lock, pause, [&] { return state_ != State::open || (held_up_ > 0 && due()); });
      if (state_ == State::abandoned || !due()) return;
      auto node = waiting_.extract(waiting_.begin());
      lock.unlock();
      try {
        take_(node.mapped().item);
      } catch (...) {
        failure_ = std::current_exception();
        abandon();
        return;
      }
      lock.lock();
      ++next_;
      bytes_ -= node.mapped().bytes;
      if (held_up_ > 0) changed_.notify_all();
    }
  }

  void end(State state) {
    if (!taker_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      if (state_ == State::open) state_ = state;
      changed_.notify_all();
    }
    taker_.join();
  }

  Take take_;
  std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::size_t, Waiting> waiting_;
  std::size_t next_, bytes_ = 0;
  std::size_t held_up_ = 0;                                    ///< threads that wait for room
  std::size_t end_ = std::numeric_limits<std::size_t>::max();  ///< the first number that will never come
  State state_ = State::open;
  std::exception_ptr failure_;
  std::thread taker_;  // last: it uses all of the above
};

}  // namespace leapmap
