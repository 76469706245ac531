// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_index.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

// Covers the rounding of places to float.
constexpr double kSlack = 1.01;

double pose_gate_m2(const OverlapOptions& options) {
  const double gate_m = options.max_mahalanobis * options.max_pose_deviation_m;
  return gate_m * gate_m;
}

/// As wide as two middling landmarks reach, so that few cells are near each other.
float cell_side(const std::vector<std::vector<LandmarkPlace>>& readings, double pose_gate) {
  std::vector<float> gates;
  for (const auto& reading : readings) {
    for (const LandmarkPlace& landmark : reading) gates.push_back(landmark.place.gate);
  }
  if (gates.empty()) return 1;
  const auto middle = gates.begin() + static_cast<std::ptrdiff_t>(gates.size() / 2);
  std::nth_element(gates.begin(), middle, gates.end());
  return std::sqrt(2 * *middle + static_cast<float>(pose_gate));
}

}  // namespace

std::vector<LandmarkPlace> landmark_places(const SensedLandmarks& landmarks,
                                           const OverlapOptions& options) {
  const double square_distance = options.max_mahalanobis * options.max_mahalanobis;
  std::vector<LandmarkPlace> places;
  for (const SensedLandmark& l : landmarks.landmarks()) {
    const double pose_gate = square_distance * l.max_pose_deviation_m * l.max_pose_deviation_m;
    const double gate = kSlack * (l.gate + pose_gate) - pose_gate_m2(options);
    places.push_back({l.id, {l.position.cast<float>(), static_cast<float>(std::max(0.0, gate))}});
  }
  return places;
}

LandmarkIndex::LandmarkIndex(const std::vector<std::vector<LandmarkPlace>>& readings,
                             const OverlapOptions& options) {
  for (int reading = 0; reading < static_cast<int>(readings.size()); ++reading) {
    std::vector<int64_t>& names = names_.emplace_back();
    for (const LandmarkPlace& landmark : readings[static_cast<size_t>(reading)]) {
      if (landmark.id == kUnknownLandmark) {
        has_unnamed_ = true;
        continue;
      }
      names.push_back(landmark.id);
      append(with_name_[landmark.id], reading);
    }
  }
  if (!has_unnamed_) return;
  const float cell_m = cell_side(readings, pose_gate_m2(options));
  std::vector<std::vector<CellCount>> cells;
  for (const auto& reading : readings) {
    std::vector<SensedPoint> places;
    for (const LandmarkPlace& landmark : reading) places.push_back(landmark.place);
    cells.push_back(count_cells(places, cell_m));
  }
  cells_ = CellIndex(std::move(cells), cell_m, pose_gate_m2(options));
}

void LandmarkIndex::add_matches(int reading, BoundSum& sum) const {
  for (const int64_t name : names_[static_cast<size_t>(reading)]) sum.add(with_name_.at(name), 1);
  if (has_unnamed_) cells_.add_matches(reading, sum);
}

}  // namespace hmt::submap
