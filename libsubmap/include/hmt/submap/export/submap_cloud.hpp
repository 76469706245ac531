// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hmt/submap/map/placed_observation.hpp"
#include "hmt/submap/observation/observation_store.hpp"

namespace hmt::submap {

/// The surfaces of a submap as points in its frame: one for each occupied cell of its octree (.ot
/// bytes), the mean of the points measured in that cell. Ordered by cell. Memory grows with the
/// area that was seen.
std::vector<Eigen::Vector3f> submap_cloud(std::span<const PlacedObservation> observations,
                                          const ObservationStore& store, std::string_view ot_bytes);

/// Binary little-endian PLY with x, y and z.
std::string to_ply(std::span<const Eigen::Vector3f> points);
/// Binary PCD 0.7 with x, y and z.
std::string to_pcd(std::span<const Eigen::Vector3f> points);

}  // namespace hmt::submap
