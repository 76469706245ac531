// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/evaluation.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>

#include "../log/line_source.hpp"
#include "../log/text_fields.hpp"
#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

using graph::InputError;
using graph::Pose;
using graph::relative_pose;

/// Finds poses by stamp; stamps may be in any order.
class StampIndex {
 public:
  explicit StampIndex(std::span<const StampedPose> trajectory) {
    for (const StampedPose& pose : trajectory) order_.push_back(&pose);
    std::ranges::stable_sort(order_, {}, &StampedPose::stamp_s);
  }

  /// The pose whose stamp is nearest, null if it is farther than kMaxStampDifference. Of equal
  /// ones the first in the trajectory.
  const Pose* find(double stamp_s) const {
    const auto after = std::ranges::lower_bound(order_, stamp_s, {}, &StampedPose::stamp_s);
    const StampedPose* best = after == order_.end() ? nullptr : *after;
    if (after != order_.begin()) {
      const double before_s = (*(after - 1))->stamp_s;
      if (!best || stamp_s - before_s < best->stamp_s - stamp_s)
        best = *std::ranges::lower_bound(order_, before_s, {}, &StampedPose::stamp_s);
    }
    const bool close = best && std::abs(best->stamp_s - stamp_s) <= kMaxStampDifference;
    return close ? &best->T_world_robot : nullptr;
  }

 private:
  std::vector<const StampedPose*> order_;
};

double angle_rad(const Pose& T) {
  return 2 * std::atan2(T.rotation.vec().norm(), std::abs(T.rotation.w()));
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double rms(const std::vector<double>& values, double center) {
  double sum = 0;
  for (const double value : values) sum += (value - center) * (value - center);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

Relation parse_relation(std::string_view fields) {
  Relation relation;
  relation.stamp_from_s = take_finite(fields, "first stamp");
  relation.stamp_to_s = take_finite(fields, "second stamp");
  for (int k = 0; k < 3; ++k)
    relation.T_from_to.translation[k] = take_finite(fields, "translation");
  const double roll_rad = take_finite(fields, "roll");
  const double pitch_rad = take_finite(fields, "pitch");
  const double yaw_rad = take_finite(fields, "yaw");
  if (!take_field(fields).empty()) throw std::invalid_argument("more than 8 fields");
  relation.T_from_to.rotation = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
  return relation;
}

struct Match {
  Pose T_ref_robot;
  Pose T_world_robot;
};

std::vector<Match> match(std::span<const StampedPose> trajectory,
                         std::span<const StampedPose> reference) {
  const StampIndex index(trajectory);
  std::vector<Match> matches;
  for (const StampedPose& pose : reference)
    if (const Pose* T_world_robot = index.find(pose.stamp_s))
      matches.push_back({pose.T_world_robot, *T_world_robot});
  return matches;
}

bool is_planar(const Pose& T) {
  return T.translation.z() == 0 && T.rotation.x() == 0 && T.rotation.y() == 0;
}

/// Distances of the aligned positions: R = U S V^T of the SVD of the cross covariance, S turning
/// the last axis where R would mirror [Umeyama 1991, Eq. 39 and 40]. A planar trajectory is aligned
/// in the plane: turned over in space, its mirror image would fit.
template <int kDim>
std::vector<double> aligned_distances(const std::vector<Match>& matches) {
  using Vector = Eigen::Matrix<double, kDim, 1>;
  using Matrix = Eigen::Matrix<double, kDim, kDim>;
  const auto p_ref = [](const Match& pair) -> Vector {
    return pair.T_ref_robot.translation.template head<kDim>();
  };
  const auto p_world = [](const Match& pair) -> Vector {
    return pair.T_world_robot.translation.template head<kDim>();
  };
  Vector ref_mean = Vector::Zero();
  Vector world_mean = Vector::Zero();
  for (const Match& pair : matches) {
    ref_mean += p_ref(pair) / static_cast<double>(matches.size());
    world_mean += p_world(pair) / static_cast<double>(matches.size());
  }
  Matrix cross = Matrix::Zero();
  for (const Match& pair : matches)
    cross += (p_ref(pair) - ref_mean) * (p_world(pair) - world_mean).transpose();
  const Eigen::JacobiSVD<Matrix> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector signs = Vector::Ones();
  signs[kDim - 1] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Matrix R_ref_world = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  std::vector<double> distances_m;
  for (const Match& pair : matches)
    distances_m.push_back(
        (R_ref_world * (p_world(pair) - world_mean) - (p_ref(pair) - ref_mean)).norm());
  return distances_m;
}

void add_relative_error(const std::vector<Match>& matches, TrajectoryError& error) {
  std::vector<double> trans_m;
  std::vector<double> rot_rad;
  size_t from = 0;
  double path_m = 0;
  for (size_t i = 1; i < matches.size(); ++i) {
    path_m += (matches[i].T_ref_robot.translation - matches[i - 1].T_ref_robot.translation).norm();
    if (path_m < kRpePath && i + 1 < matches.size()) continue;
    const Pose truth = relative_pose(matches[from].T_ref_robot, matches[i].T_ref_robot);
    const Pose estimate = relative_pose(matches[from].T_world_robot, matches[i].T_world_robot);
    const Pose difference = relative_pose(truth, estimate);
    trans_m.push_back(difference.translation.norm());
    rot_rad.push_back(angle_rad(difference));
    from = i;
    path_m = 0;
  }
  error.rpe_pairs = static_cast<int64_t>(trans_m.size());
  error.rpe_trans_rmse_m = rms(trans_m, 0);
  error.rpe_rot_rmse_rad = rms(rot_rad, 0);
}

}  // namespace

std::vector<Relation> read_relations(const std::filesystem::path& path) {
  LineSource lines(path);
  std::vector<Relation> relations;
  while (const auto line = lines.next()) {
    const std::string_view fields = without_comment(*line);
    if (fields.empty()) continue;
    try {
      relations.push_back(parse_relation(fields));
    } catch (const std::invalid_argument& error) {
      throw InputError(lines.place() + ": " + error.what() +
                       "; a line of relations is 'stamp1 stamp2 x y z roll pitch yaw'");
    }
  }
  if (!lines.damage().empty()) throw InputError(path.string() + ": " + lines.damage());
  if (relations.empty()) throw InputError(path.string() + ": no relations in the file");
  return relations;
}

RelationsError evaluate_relations(std::span<const StampedPose> trajectory,
                                  std::span<const Relation> relations) {
  const StampIndex index(trajectory);
  std::vector<double> trans_m;
  std::vector<double> rot_rad;
  for (const Relation& relation : relations) {
    const Pose* T_world_from = index.find(relation.stamp_from_s);
    const Pose* T_world_to = index.find(relation.stamp_to_s);
    if (!T_world_from || !T_world_to) continue;
    const Pose difference =
        relative_pose(relation.T_from_to, relative_pose(*T_world_from, *T_world_to));
    trans_m.push_back(difference.translation.norm());
    rot_rad.push_back(angle_rad(difference));
  }
  if (trans_m.empty())
    throw InputError("none of the " + std::to_string(relations.size()) +
                     " relations has both its stamps in the trajectory; are they of one log?");
  RelationsError error;
  error.relations = static_cast<int64_t>(relations.size());
  error.relations_used = static_cast<int64_t>(trans_m.size());
  error.trans_mean_m = mean(trans_m);
  error.trans_std_m = rms(trans_m, error.trans_mean_m);
  error.rot_mean_rad = mean(rot_rad);
  error.rot_std_rad = rms(rot_rad, error.rot_mean_rad);
  return error;
}

TrajectoryError evaluate_trajectory(std::span<const StampedPose> trajectory,
                                    std::span<const StampedPose> reference) {
  const std::vector<Match> matches = match(trajectory, reference);
  if (matches.size() < 2)
    throw InputError(std::to_string(matches.size()) + " of the " +
                     std::to_string(reference.size()) +
                     " stamps of the reference are in the trajectory, two are needed; are they of "
                     "one log?");
  const bool planar = std::ranges::all_of(matches, [](const Match& pair) {
    return is_planar(pair.T_ref_robot) && is_planar(pair.T_world_robot);
  });
  const std::vector<double> distances_m =
      planar ? aligned_distances<2>(matches) : aligned_distances<3>(matches);
  TrajectoryError error;
  error.reference_poses = static_cast<int64_t>(reference.size());
  error.matched = static_cast<int64_t>(matches.size());
  error.ate_rmse_m = rms(distances_m, 0);
  error.ate_mean_m = mean(distances_m);
  error.ate_max_m = *std::ranges::max_element(distances_m);
  add_relative_error(matches, error);
  return error;
}

}  // namespace hmt::submap
