// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <deque>
#include <exception>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

// The part of oneTBB that hmtmap uses, on std::thread. ThreadSanitizer cannot see how the installed
// libtbb.so synchronizes its workers and reports every loop as a race; of these few lines it sees
// everything, so what it reports is a race in our tasks. Neighbouring tasks get different threads,
// and nothing orders two tasks that oneTBB does not order, so a race is found whenever it exists.
namespace tbb {

namespace stand_in {

/// Threads that a loop of the calling thread may use; a loop inside a task runs in that task.
inline thread_local int threads = 1;

/// Threads that are joined together; the first exception that one of them threw is thrown then.
class ThreadGroup {
 public:
  void start(std::function<void()> work) {
    const std::lock_guard lock(mutex_);
    threads_.emplace_back([this, work = std::move(work)] { run(work); });
  }

  /// Returns when all have ended, also those that were started meanwhile.
  void join() {
    for (size_t i = 0; i < size(); ++i) at(i).join();
    if (first_) std::rethrow_exception(first_);
  }

 private:
  void run(const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!first_) first_ = std::current_exception();
    }
  }
  size_t size() {
    const std::lock_guard lock(mutex_);
    return threads_.size();
  }
  std::thread& at(size_t i) {
    const std::lock_guard lock(mutex_);
    return threads_[i];
  }

  std::mutex mutex_;
  std::deque<std::thread> threads_;
  std::exception_ptr first_;
};

}  // namespace stand_in

namespace info {
/// At least two, so that a machine with one core finds races too.
inline int default_concurrency() {
  return std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
}
}  // namespace info

class task_arena {
 public:
  explicit task_arena(int threads = info::default_concurrency()) : threads_(threads) {}

  template <typename Function>
  auto execute(Function&& function) {
    struct Restore {
      int before;
      ~Restore() { stand_in::threads = before; }
    } const restore{stand_in::threads};
    stand_in::threads = threads_;
    return function();
  }

 private:
  int threads_;
};

/// Thread t of n does the tasks t, t + n, t + 2 n, ...
template <typename Index, typename Function>
void parallel_for(Index first, Index last, const Function& function) {
  const auto step = static_cast<Index>(stand_in::threads);
  stand_in::ThreadGroup group;
  for (Index start = first; start < last && start < first + step; ++start)
    group.start([=, &function] {
      for (Index i = start; i < last; i += step) function(i);
    });
  group.join();
}

/// Every item gets a thread of its own.
template <typename Item>
class feeder {
 public:
  explicit feeder(std::function<void(Item, feeder&)> function) : function_(std::move(function)) {}
  void add(Item item) {
    group_.start([this, item] { function_(item, *this); });
  }
  void join() { group_.join(); }

 private:
  std::function<void(Item, feeder&)> function_;
  stand_in::ThreadGroup group_;
};

template <typename Iterator, typename Function>
void parallel_for_each(Iterator first, Iterator last, const Function& function) {
  feeder<typename std::iterator_traits<Iterator>::value_type> items(function);
  for (; first != last; ++first) items.add(*first);
  items.join();
}

template <typename Value>
class enumerable_thread_specific {
 public:
  Value& local() {
    const std::lock_guard lock(mutex_);
    return values_[std::this_thread::get_id()];
  }

 private:
  std::mutex mutex_;
  std::map<std::thread::id, Value> values_;
};

}  // namespace tbb
