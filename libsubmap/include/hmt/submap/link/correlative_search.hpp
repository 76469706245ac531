// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "hmt/submap/link/correlative_grid.hpp"
#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// Planar poses of the query frame in the map frame that are looked at: a box around a guess.
struct CorrelativeWindow {
  Pose T_map_query;  ///< center of the window
  double half_x_m = 0;
  double half_y_m = 0;
  double half_yaw_rad = 0;
};

/// A pose and the mean grid value of the query points there, in [0, 1].
struct CorrelativeMatch {
  Pose T_map_query;
  double score = 0;
};

/// Poses that count as the same match: nearer than both to `T_map_query`.
struct CorrelativeExclusion {
  Pose T_map_query;
  double radius_m = 0;
  double angle_rad = 0;
};

/// The pose of the window with the highest score, exactly, by branch and bound over x and y for
/// every heading [Olson 2009; Hess 2016, Alg. 3]. Steps: one cell; the heading at which the
/// farthest point moves by one cell. Poses inside `excluded` are left out. Nothing where no pose
/// has a score above `floor_score`, or without points. Ties: the heading nearest to the guess,
/// then the lowest x, y. Planar: for poses in space it can only give the start.
std::optional<CorrelativeMatch> correlative_search(
    const CorrelativeGrid& map, std::span<const Eigen::Vector2f> points_query,
    const CorrelativeWindow& window, double floor_score,
    const std::optional<CorrelativeExclusion>& excluded = std::nullopt);

}  // namespace hmt::submap
