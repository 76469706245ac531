// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "match_bounds.hpp"

#include <algorithm>

namespace hmt::submap {

void append(std::vector<ReadingRun>& runs, int reading) {
  if (!runs.empty() && runs.back().end >= reading) {
    runs.back().end = reading + 1;
  } else {
    runs.push_back({reading, reading + 1});
  }
}

std::vector<ReadingRun> join(std::vector<ReadingRun> runs) {
  std::sort(runs.begin(), runs.end(),
            [](const ReadingRun& a, const ReadingRun& b) { return a.begin < b.begin; });
  std::vector<ReadingRun> joined;
  for (const ReadingRun& run : runs) {
    if (joined.empty() || run.begin > joined.back().end) {
      joined.push_back(run);
    } else {
      joined.back().end = std::max(joined.back().end, run.end);
    }
  }
  return joined;
}

void BoundSum::add(std::span<const ReadingRun> runs, int elements) {
  for (const ReadingRun& run : runs) {
    steps_.push_back({run.begin, elements});
    steps_.push_back({run.end, -elements});
  }
}

void BoundSum::sort_steps() {
  if (steps_.size() < num_readings_) {
    std::sort(steps_.begin(), steps_.end(),
              [](const Step& a, const Step& b) { return a.at < b.at; });
    return;
  }
  // Many steps at few places.
  std::vector<int> changes(num_readings_ + 1, 0);
  for (const Step& step : steps_) changes[static_cast<size_t>(step.at)] += step.change;
  steps_.clear();
  for (int at = 0; at <= static_cast<int>(num_readings_); ++at) {
    const int change = changes[static_cast<size_t>(at)];
    if (change != 0) steps_.push_back({at, change});
  }
}

std::vector<MatchBound> BoundSum::bounds(int most) && {
  sort_steps();
  std::vector<MatchBound> bounds;
  int matches = 0;
  for (size_t i = 0; i < steps_.size(); ++i) {
    matches += steps_[i].change;
    if (i + 1 == steps_.size() || steps_[i + 1].at == steps_[i].at || matches == 0) continue;
    bounds.push_back({steps_[i].at, steps_[i + 1].at, std::min(matches, most)});
  }
  return bounds;
}

}  // namespace hmt::submap
