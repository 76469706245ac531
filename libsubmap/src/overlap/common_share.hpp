// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/overlap/overlap.hpp"

namespace hmt::submap {

/// Throws InputError naming the option that is out of its range.
void check(const OverlapOptions& options);
/// Throws InputError where a number of the pose is not finite.
void check_finite(const Pose& pose);

/// Elements of a that match one of b and of b that match one of a, for one sensor.
struct Matches {
  double of_a = 0;
  double of_b = 0;
};

/// |a intersection b| / |a union b| [Blanco 2009, Eq. 13] of readings of so many elements, matches
/// counted in both directions and averaged; 0 if one is empty.
double sensed_space_overlap(double size_a, double size_b, const Matches& matches);

/// Mean of the overlaps of the sensors that two observations have in common. A sensor that sensed
/// nothing in either says nothing (0 / 0 in Eq. 13) and does not count.
class MeanOverlap {
 public:
  void add(double size_a, double size_b, const Matches& matches) {
    if (size_a > 0 || size_b > 0) add(sensed_space_overlap(size_a, size_b, matches));
  }
  void add(double overlap) {
    sum_ += overlap;
    ++count_;
  }
  /// 0 without any sensor.
  double mean() const { return count_ > 0 ? sum_ / count_ : 0.0; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

}  // namespace hmt::submap
