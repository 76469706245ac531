// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "hmt/graph/pose.hpp"
#include "hmt/submap/export/trajectory.hpp"

namespace hmt::submap {

/// How poses of two sources are brought together: each stamp is paired with the nearest one of the
/// evaluated trajectory, at most this far away. Well below the period of a scanner and above the
/// rounding of stamps in files.
constexpr double kMaxStampDifference = 0.005;  // seconds

/// A true relative pose between two stamps.
struct Relation {
  double stamp_from_s = 0;
  double stamp_to_s = 0;
  graph::Pose T_from_to;

  bool operator==(const Relation&) const = default;
};

/// Reads relations: `stamp1 stamp2 x y z roll pitch yaw` a line, metres and radians, the rotation
/// is Rz(yaw) Ry(pitch) Rx(roll). Throws InputError naming file and line.
std::vector<Relation> read_relations(const std::filesystem::path& path);

/// Error of the relative poses of a trajectory.
struct RelationsError {
  int64_t relations = 0;
  int64_t relations_used = 0;  ///< those with both stamps in the trajectory
  double trans_mean_m = 0;
  double trans_std_m = 0;
  double rot_mean_rad = 0;
  double rot_std_rad = 0;

  bool operator==(const RelationsError&) const = default;
};

/// [Kuemmerle 2009, Eq. 4, with absolute instead of squared errors]: for every relation the
/// difference (true T_1_2)^-1 (estimated T_1_2), the length of its translation and the angle of its
/// rotation; mean and standard deviation (of the population) over all relations used. Local, so it
/// needs no alignment. O((n + r) log n). Throws InputError if no relation can be used.
RelationsError evaluate_relations(std::span<const StampedPose> trajectory,
                                  std::span<const Relation> relations);

/// Error of a trajectory against a reference.
struct TrajectoryError {
  int64_t reference_poses = 0;
  int64_t matched = 0;    ///< reference poses with a stamp of the trajectory
  double ate_rmse_m = 0;  ///< absolute: of positions, after the best rigid alignment
  double ate_mean_m = 0;
  double ate_max_m = 0;
  int64_t rpe_pairs = 0;
  double rpe_trans_rmse_m = 0;  ///< relative: over pieces of kRpePath of the reference's path
  double rpe_rot_rmse_rad = 0;

  bool operator==(const TrajectoryError&) const = default;
};

/// Length of the pieces of path for the relative error; sparse references use each step.
constexpr double kRpePath = 1;  // metres

/// Absolute error after rigid alignment without scale [Umeyama 1991], in the plane if both
/// trajectories lie in it, and relative error. Poses are taken in the order of the reference.
/// Throws InputError with fewer than two matches.
TrajectoryError evaluate_trajectory(std::span<const StampedPose> trajectory,
                                    std::span<const StampedPose> reference);

}  // namespace hmt::submap
