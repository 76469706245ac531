// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>

namespace hmt::submap {

/// Recently used values by a number, up to a number of bytes. Safe for many threads. A value is
/// shared with those who asked for it and may still look at it when it is dropped here.
template <typename Value>
class RecentlyUsed {
 public:
  explicit RecentlyUsed(size_t most_bytes) : most_bytes_(most_bytes) {}

  void set_most_bytes(size_t most_bytes) {
    const std::lock_guard lock(mutex_);
    most_bytes_ = most_bytes;
    drop_oldest();
  }

  /// Null where it is not held.
  std::shared_ptr<const Value> find(int64_t key) {
    const std::lock_guard lock(mutex_);
    const auto found = by_key_.find(key);
    if (found == by_key_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return entries_.front().value;
  }

  /// Keeps what is there where two threads made the same one.
  void insert(int64_t key, std::shared_ptr<const Value> value, size_t bytes) {
    const std::lock_guard lock(mutex_);
    if (by_key_.contains(key)) return;
    entries_.push_front({key, std::move(value), bytes});
    by_key_[key] = entries_.begin();
    bytes_ += bytes;
    drop_oldest();
  }

 private:
  /// Down to the bound; the last one stays. With the mutex held.
  void drop_oldest() {
    while (bytes_ > most_bytes_ && entries_.size() > 1) {
      bytes_ -= entries_.back().bytes;
      by_key_.erase(entries_.back().key);
      entries_.pop_back();
    }
  }

  struct Entry {
    int64_t key = 0;
    std::shared_ptr<const Value> value;
    size_t bytes = 0;
  };
  size_t most_bytes_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // the most recently used first
  std::unordered_map<int64_t, typename std::list<Entry>::iterator> by_key_;
  size_t bytes_ = 0;
};

}  // namespace hmt::submap
