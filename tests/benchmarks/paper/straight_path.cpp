// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "straight_path.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ekf_slam.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "log/simulation/random.hpp"

namespace hmt::paper {
namespace {

using submap::Matrix6d;
using submap::Pose;
using submap::Random;

std::vector<Eigen::Vector2d> place_landmarks(const StraightPathParameters& p, Random& random) {
  std::vector<Eigen::Vector2d> landmarks;
  for (int i = 0; i < p.landmarks; ++i) {
    const double x = random.uniform(0, p.length_m);
    landmarks.emplace_back(x, random.uniform(-p.half_width_m, p.half_width_m));
  }
  return landmarks;
}

std::vector<RangeBearing> observe(const StraightPathParameters& p, double x_m,
                                  const std::vector<Eigen::Vector2d>& landmarks, Random& random) {
  std::vector<RangeBearing> seen;
  for (size_t i = 0; i < landmarks.size(); ++i) {
    const Eigen::Vector2d d = landmarks[i] - Eigen::Vector2d(x_m, 0);
    const double bearing_rad = std::atan2(d.y(), d.x());
    if (d.norm() > p.max_range_m || std::abs(bearing_rad) > p.field_of_view_rad / 2) continue;
    const double range_m = std::max(1e-3, d.norm() + random.normal(p.sigma_range_m));
    seen.push_back(
        {static_cast<int>(i), range_m, bearing_rad + random.normal(p.sigma_bearing_rad)});
  }
  return seen;
}

submap::Observation as_observation(const StraightPathParameters& p, int64_t index,
                                   const std::vector<RangeBearing>& seen) {
  submap::LandmarkReading reading;
  for (const RangeBearing& z : seen) {
    submap::Landmark landmark;
    if (p.known_landmarks) landmark.id = z.landmark;
    const Eigen::Vector3d along(std::cos(z.bearing_rad), std::sin(z.bearing_rad), 0);
    const Eigen::Vector3d across(-along.y(), along.x(), 0);
    landmark.position_sensor = z.range_m * along;
    landmark.covariance_sensor =
        std::pow(p.sigma_range_m, 2) * along * along.transpose() +
        std::pow(z.range_m * p.sigma_bearing_rad, 2) * across * across.transpose();
    reading.landmarks.push_back(std::move(landmark));
  }
  submap::Observation observation;
  observation.index = index;
  observation.stamp_s = static_cast<double>(index);
  observation.landmark_readings.push_back(std::move(reading));
  return observation;
}

/// Of the relative pose of two observations that lie so many steps apart, by the odometry alone:
/// what a turn at one step moves at the end grows with the steps that follow.
Matrix6d odometry_covariance(const StraightPathParameters& p, int steps) {
  const double n = steps;
  const double distance_m = n * p.step_m;
  const double turn = std::pow(p.sigma_odometry_rad, 2) * p.step_m;
  Matrix6d covariance = Matrix6d::Zero();
  covariance(0, 0) = covariance(1, 1) = std::pow(p.sigma_odometry_m, 2) * distance_m;
  covariance(1, 1) += turn * p.step_m * p.step_m * (n - 1) * n * (2 * n - 1) / 6;
  covariance(5, 5) = turn * n;
  covariance(1, 5) = covariance(5, 1) = turn * p.step_m * n * (n - 1) / 2;
  return covariance;
}

graph::WeightedGraph overlap_of(const StraightPathParameters& p,
                                const std::vector<Eigen::Vector3d>& poses,
                                std::vector<submap::Observation> observations) {
  std::vector<submap::Keyframe> keyframes;
  std::vector<Pose> T_world_keyframe;
  for (size_t k = 0; k < poses.size(); ++k) {
    keyframes.push_back(
        {static_cast<int>(k), static_cast<int64_t>(k), observations[k].stamp_s, {}});
    T_world_keyframe.push_back(Pose::planar(poses[k].x(), poses[k].y(), poses[k].z()));
  }
  submap::OverlapOptions options;
  options.min_overlap = 0;
  return submap::overlap_graph(
      keyframes, T_world_keyframe,
      [&p](int a, int b) { return std::optional(odometry_covariance(p, b - a)); },
      submap::ObservationVector(std::move(observations)), options, {});
}

/// Norms of the 2x2 blocks of the information matrix that belong to landmarks.
Eigen::MatrixXd landmark_blocks(const EkfSlam& filter, bool marginalize_pose) {
  const Eigen::Index skip = marginalize_pose ? 3 : 0;
  const Eigen::Index rest = filter.covariance().rows() - skip;
  const Eigen::MatrixXd H = filter.covariance()
                                .bottomRightCorner(rest, rest)
                                .llt()
                                .solve(Eigen::MatrixXd::Identity(rest, rest));
  const auto n = static_cast<Eigen::Index>(filter.landmarks().size());
  Eigen::MatrixXd norms(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      norms(i, j) = H.block<2, 2>(3 - skip + 2 * i, 3 - skip + 2 * j).norm();
  return norms;
}

}  // namespace

StraightPathRun run_straight_path(const StraightPathParameters& p, uint64_t seed) {
  Random random(seed);
  const std::vector<Eigen::Vector2d> landmarks = place_landmarks(p, random);
  EkfSlam filter(p.sigma_range_m, p.sigma_bearing_rad);
  const Eigen::Vector3d sigma =
      std::sqrt(p.step_m) *
      Eigen::Vector3d(p.sigma_odometry_m, p.sigma_odometry_m, p.sigma_odometry_rad);
  const Eigen::Matrix3d covariance = sigma.cwiseAbs2().asDiagonal();
  const int steps = static_cast<int>(std::lround(p.length_m / p.step_m));
  StraightPathRun run;
  std::vector<submap::Observation> observations;
  for (int k = 0; k <= steps; ++k) {
    if (k > 0) {
      Eigen::Vector3d motion(p.step_m, 0, 0);
      for (Eigen::Index i = 0; i < 3; ++i) motion[i] += random.normal(sigma[i]);
      filter.predict(motion, covariance);
    }
    const auto z = observe(p, k * p.step_m, landmarks, random);
    filter.update(z);
    run.poses.push_back(filter.pose());
    observations.push_back(as_observation(p, k, z));
    run.seen.emplace_back();
    for (const RangeBearing& one : z) run.seen.back().push_back(one.landmark);
  }
  run.state_landmarks = filter.landmarks();
  run.state = filter.mean();
  run.covariance = filter.covariance();
  run.information = landmark_blocks(filter, p.marginalize_pose);
  run.overlap = overlap_of(p, run.poses, std::move(observations));
  return run;
}

double landmark_information_loss(const StraightPathRun& run, const graph::Labels& labels) {
  std::map<int, std::set<int>> submaps;
  for (size_t k = 0; k < run.seen.size(); ++k)
    for (const int landmark : run.seen[k]) submaps[landmark].insert(labels[k]);
  const auto apart = [&](int i, int j) {
    const std::set<int>& b = submaps.at(j);
    return std::none_of(submaps.at(i).begin(), submaps.at(i).end(),
                        [&](int label) { return b.contains(label); });
  };
  double lost = 0;
  for (Eigen::Index i = 0; i < run.information.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (apart(run.state_landmarks[static_cast<size_t>(i)],
                run.state_landmarks[static_cast<size_t>(j)]))
        lost += 2 * run.information(i, j);
  const double all = run.information.sum();
  return all > 0 ? lost / all : 0;
}

}  // namespace hmt::paper
