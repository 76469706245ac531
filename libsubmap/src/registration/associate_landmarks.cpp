// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "associate_landmarks.hpp"

#include <algorithm>

namespace hmt::submap {
namespace {

/// The paper's distance of 3, and the distance from which it is another landmark for sure.
constexpr double kNear = 3;
constexpr double kFar = 5;

int landmark_of(const LandmarkFilter& filter, const MeasuredLandmark& measured) {
  int near = kNewLandmark;
  int candidates = 0;
  bool between = false;
  for (const auto& [landmark, slot] : filter.landmarks()) {
    const double distance2 = filter.innovation(landmark, measured)->mahalanobis_squared;
    if (distance2 <= kNear * kNear) {
      near = landmark;
      ++candidates;
    } else if (distance2 <= kFar * kFar) {
      between = true;
    }
  }
  if (candidates == 0) return between ? kLeftOut : kNewLandmark;
  return candidates == 1 ? near : kLeftOut;
}

}  // namespace

std::vector<int> associate_landmarks(const LandmarkFilter& filter,
                                     std::span<const MeasuredLandmark> measured) {
  std::vector<int> landmarks;
  for (const MeasuredLandmark& one : measured) landmarks.push_back(landmark_of(filter, one));
  const std::vector<int> claimed = landmarks;
  for (int& landmark : landmarks)
    if (landmark >= 0 && std::count(claimed.begin(), claimed.end(), landmark) > 1)
      landmark = kLeftOut;
  return landmarks;
}

}  // namespace hmt::submap
