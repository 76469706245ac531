// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// The way from one keyframe to the next as the tracker found it.
struct ChainStep {
  Pose odometry;  ///< by odometry alone
  /// By registration against the local map, drawn by odometry where that says little, and the
  /// information of the registration (tangent of Pose, frame of the end); zero if there was none.
  Pose estimate;
  Matrix6d information = Matrix6d::Zero();
  bool has_odometry = false;  ///< without jump or reset
};

/// A step, weighed by the noise of the whole log.
struct WeighedStep {
  Pose T_a_b;
  Matrix6d information = Matrix6d::Zero();
};

/// Weighs odometry and registration anew once the whole log is known. How noisy each is in each of
/// the six directions is told by how their difference grows with the way (separate_noise over ways
/// of 1, 2, 4 and 8 keyframes), so that an odometry that an inertial sensor holds upright counts
/// more for height and tilt than sparse clouds do, and less for the heading. What odometry always
/// does wrong per metre is taken out of it in those directions in which a registration tells more
/// of a step than it does. Where the two contradict each other, the step is known less well.
/// A step without odometry keeps its estimate and has no information here. Nothing where the log is
/// too short to learn from (100 keyframes). In space only.
std::optional<std::vector<WeighedStep>> weigh_chain(const std::vector<ChainStep>& chain);

}  // namespace hmt::submap
