// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/weighted_graph.hpp"
#include "hmt/submap/link/link.hpp"
#include "hmt/submap/link/loop_search.hpp"
#include "hmt/submap/local/submap.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/sighting.hpp"
#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// What the way over submaps costs against one flat optimization of all keyframes: chi2 of all
/// constraints. Zero until the map is finished.
struct DivisionCost {
  /// Each submap at its own optimum, placed by the condensed links.
  double chi2_hybrid = 0;
  /// After the joint refinement from there: the map's poses.
  double chi2_refined = 0;
  /// Of the flat optimization, which knows of no submaps.
  double chi2_flat = 0;

  bool operator==(const DivisionCost&) const = default;
};

/// The graph of submaps and links with all that it was made from, except the observations and the
/// OctoMaps, which stay in the map file.
struct HybridMap {
  Track track;
  std::vector<Constraint> constraints;
  std::vector<Sighting> sightings;      ///< of landmarks, without the outliers
  std::vector<int64_t> landmark_names;  ///< in the log, by number; kUnknownLandmark without one
  std::vector<graph::Arc> overlap;      ///< Omega, every arc once with a < b, ordered
  graph::Labels submap_of_keyframe;
  std::vector<Submap> submaps;
  std::vector<Link> links;
  std::vector<LoopCandidate> loops;
  std::vector<Pose> T_world_submap;
  std::vector<Matrix6d> covariance_world_submap;  ///< tangent of Pose, frame submap
  double information_loss = 0;                    ///< e of Eq. 22 for the whole partition
  double chi2_initial = 0;                        ///< of the submap graph
  double chi2 = 0;
  DivisionCost division;
  std::vector<PlacedLandmark> landmarks;  ///< in the world, by number; those that were seen
  /// e of Eq. 22 for the information matrix of the landmarks alone; 0 without landmarks.
  double landmark_information_loss = 0;
};

/// T_world_keyframe of a keyframe.
Pose world_pose(const HybridMap& map, int keyframe);
/// T_world_robot of every observation, in the order of the log.
std::vector<Pose> world_trajectory(const HybridMap& map);

}  // namespace hmt::submap
