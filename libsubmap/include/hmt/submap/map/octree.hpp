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

struct OctreeOptions {
  /// Side of a cell, metres, [0.005, 10]; raising it makes maps smaller and coarser.
  double resolution_m = 0.05;
};

/// OctoMap of one submap in its own frame, in OctoMap's .ot format, from all its observations in
/// the given order: the same log odds that OctoMap's insertPointCloud gives reading by reading,
/// with OctoMap's default sensor model. Beams that met nothing clear the first 5 m. In Space::se2
/// the tree is one layer, whose cells have their lower side at z = 0. Points beyond 32767 cells and
/// those that are not finite are left out. Memory grows with the area that was seen.
std::string build_octree(std::span<const PlacedObservation> observations,
                         const ObservationStore& store, Space space, const OctreeOptions& options);

/// One leaf of an octree.
struct OctreeCell {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double size_m = 0;
  double log_odds = 0;
  bool occupied = false;
};

/// The leaves of an .ot tree. Throws InputError where the bytes are not a whole tree.
std::vector<OctreeCell> octree_cells(std::string_view ot_bytes);
/// For each point in the frame of an .ot tree, whether it lies in an occupied cell.
std::vector<bool> in_occupied_cells(std::string_view ot_bytes,
                                    std::span<const Eigen::Vector3d> points);
/// Side of the smallest cells of an .ot tree, metres.
double octree_resolution(std::string_view ot_bytes);
/// The same tree in OctoMap's smaller .bt format: free and occupied only.
std::string octree_to_bt(std::string_view ot_bytes);

}  // namespace hmt::submap
