// SPDX-License-Identifier: GPL-3.0-or-later
/// Hands on what many threads finish in any order in the order of its numbers, one at a time.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

namespace leapmap {

/// Holds at most `most_waiting` items that came before their turn; a thread that brings more waits, so memory
/// stays bounded when one item, or whoever takes them, is slow. Items must be begun in order for that wait to
/// end.
template <class Item>
class OrderedDelivery {
 public:
  using Take = std::function<void(std::size_t number, const Item&)>;

  OrderedDelivery(Take take, std::size_t most_waiting)
      : take_(std::move(take)), most_waiting_(most_waiting) {}

  /// Brings item `number`, and takes every item whose turn has come. False: the delivery has been abandoned,
  /// bring no more. What `take` throws abandons the delivery and goes to the thread that brought the item.
  bool bring(std::size_t number, Item item) {
    std::unique_lock lock(mutex_);
    turn_.wait(lock, [&] { return abandoned_ || number == next_ || waiting_.size() < most_waiting_; });
    if (abandoned_) return false;
    try {
      waiting_.emplace(number, std::move(item));
      for (auto first = waiting_.begin(); first != waiting_.end() && first->first == next_;
           first = waiting_.begin()) {
        take_(next_, first->second);
        waiting_.erase(first);
        ++next_;
      }
    } catch (...) {
      abandoned_ = true;  // before the lock is given up: nobody may take the same item again
      turn_.notify_all();
      throw;
    }
    turn_.notify_all();
    return true;
  }

  /// Ends the delivery: whoever waits is let go.
  void abandon() {
    const std::lock_guard lock(mutex_);
    abandoned_ = true;
    turn_.notify_all();
  }

 private:
  Take take_;
  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable turn_;
  std::map<std::size_t, Item> waiting_;
  std::size_t next_ = 0;
  bool abandoned_ = false;
};

}  // namespace leapmap
