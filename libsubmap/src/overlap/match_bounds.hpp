// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace hmt::submap {

/// Readings begin..end-1 of a sensor. Consecutive keyframes see the same things, so lists of
/// readings are kept as runs.
struct ReadingRun {
  int begin = 0;
  int end = 0;
};

/// Adds `reading` to runs that end at or before it.
void append(std::vector<ReadingRun>& runs, int reading);
/// Sorts runs and joins those that overlap or touch.
std::vector<ReadingRun> join(std::vector<ReadingRun> runs);

/// Readings begin..end-1 have what so many elements of the reading asked for can match at most.
struct MatchBound {
  int begin = 0;
  int end = 0;
  int matches = 0;
};

/// Adds up, for all readings at once, how many elements can match.
class BoundSum {
 public:
  /// Of so many readings.
  explicit BoundSum(size_t num_readings) : num_readings_(num_readings) {}
  /// So many elements can match something in each of the runs.
  void add(std::span<const ReadingRun> runs, int elements);
  /// The sums: disjoint, by increasing number; readings that cannot match are left out. No more
  /// than `most`.
  std::vector<MatchBound> bounds(int most) &&;

 private:
  struct Step {
    int at;
    int change;
  };
  void sort_steps();

  size_t num_readings_ = 0;
  std::vector<Step> steps_;
};

}  // namespace hmt::submap
