// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_index.hpp"

#include <algorithm>

namespace hmt::submap {
namespace {

// Large against the gates of most points, small against rooms.
constexpr float kCellSize_m = 1.0F;

}  // namespace

SensorIndex::Entry SensorIndex::entry(const SensedReading& reading, const OverlapOptions& options) {
  if (const auto* points = std::get_if<SensedPoints>(&reading)) {
    return {points->size(), count_cells(points->points(), kCellSize_m), {}};
  }
  if (const auto* landmarks = std::get_if<SensedLandmarks>(&reading)) {
    return {landmarks->size(), {}, landmark_places(*landmarks, options)};
  }
  return {};
}

SensorIndex::SensorIndex(std::vector<Entry> entries, const OverlapOptions& options) {
  std::vector<std::vector<CellCount>> cells;
  std::vector<std::vector<LandmarkPlace>> places;
  for (Entry& entry : entries) {
    sizes_.push_back(entry.size);
    cells.push_back(std::move(entry.cells));
    places.push_back(std::move(entry.landmarks));
  }
  const double pose_gate = options.max_mahalanobis * options.max_pose_deviation_m;
  points_ = CellIndex(std::move(cells), kCellSize_m, pose_gate * pose_gate);
  landmarks_.emplace(places, options);
}

std::vector<MatchBound> SensorIndex::bounds(int keyframe) const {
  BoundSum sum;
  points_.add_matches(keyframe, sum);
  landmarks_->add_matches(keyframe, sum);
  return std::move(sum).bounds(size(keyframe).value_or(0));
}

}  // namespace hmt::submap
