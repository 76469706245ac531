// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>

namespace hmt::submap {

/// task(i) for first <= i < last, on up to `threads` threads; tasks write only to their own slot.
template <typename Task>
void for_each_index(size_t first, size_t last, int threads, const Task& task) {
  tbb::task_arena arena(std::max(1, threads));
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<size_t>(first, last, 1),
                      [&](const tbb::blocked_range<size_t>& range) {
                        for (size_t i = range.begin(); i < range.end(); ++i) task(i);
                      });
  });
}

}  // namespace hmt::submap
