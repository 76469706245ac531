// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_index.hpp"

#include <cmath>

namespace hmt::submap {
namespace {

// Large against the gates of most points, small against rooms.
constexpr float kCellSize_m = 1.0F;

}  // namespace

SensorIndex::Entry SensorIndex::entry(const SensedReading& reading, const OverlapOptions& options) {
  if (const auto* points = std::get_if<SensedPoints>(&reading)) {
    const double size = points->size();
    return {size, size, count_cells(points->points(), kCellSize_m), {}, {}};
  }
  if (const auto* voxels = std::get_if<SensedVoxels>(&reading)) {
    // A voxel takes 16 bytes, a point with its share of the tree some 100.
    return {
        voxels->size(), static_cast<double>(voxels->voxels().size()) / 6, {}, voxels->blocks(), {}};
  }
  if (const auto* landmarks = std::get_if<SensedLandmarks>(&reading)) {
    const double size = landmarks->size();
    return {size, size, {}, {}, landmark_places(*landmarks, options)};
  }
  return {};
}

SensorIndex::SensorIndex(std::vector<Entry> entries, const OverlapOptions& options) {
  std::vector<std::vector<CellCount>> cells, blocks;
  std::vector<std::vector<LandmarkPlace>> places;
  for (Entry& entry : entries) {
    sizes_.push_back(entry.size);
    memory_.push_back(entry.memory);
    blocks.push_back(std::move(entry.blocks));
    cells.push_back(std::move(entry.cells));
    places.push_back(std::move(entry.landmarks));
  }
  const double pose_gate = options.max_mahalanobis * options.max_pose_deviation_m;
  points_ = CellIndex(std::move(cells), kCellSize_m, pose_gate * pose_gate);
  voxels_.emplace(std::move(blocks));
  landmarks_.emplace(places, options);
}

std::vector<MatchBound> SensorIndex::bounds(int keyframe) const {
  BoundSum sum(sizes_.size());
  points_.add_matches(keyframe, sum);
  voxels_->add_matches(keyframe, sum);
  landmarks_->add_matches(keyframe, sum);
  return std::move(sum).bounds(static_cast<int>(std::ceil(size(keyframe).value_or(0))));
}

}  // namespace hmt::submap
