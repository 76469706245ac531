// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "height_band.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

namespace hmt::submap {
namespace {

constexpr double kLowest_m = 0.3;   // over what uneven ground and tilt of the robot may look like
constexpr double kHighest_m = 2.0;  // of a person or a door
constexpr double kNear_m = 5;       // so near that hills do little
constexpr double kGroundShare = 0.05;
constexpr size_t kLeastPoints = 20;  // one of them is below the share
constexpr size_t kMostObservations = 100;
constexpr double kSteepest = 0.3;
// What belongs to the ground: at first also what lies as far off as it may be tilted.
constexpr double kGates_m[] = {1.0, 0.7, 0.5, 0.3, 0.2, 0.2, 0.2};

/// The value below which that share of the values lies.
double quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<long>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Points near the robot, as seen from it along the axes of the frame.
std::vector<Eigen::Vector3d> near_points(const Observation& observation,
                                         const Pose& T_frame_robot) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p_robot : points_in_robot(observation)) {
    const Eigen::Vector3d from_robot = T_frame_robot.rotation * p_robot;
    if (from_robot.head<2>().norm() < kNear_m) points.push_back(from_robot);
  }
  return points;
}

double low_height(std::span<const Eigen::Vector3d> points) {
  std::vector<double> heights;
  for (const Eigen::Vector3d& p : points) heights.push_back(p.z());
  return quantile(heights, kGroundShare);
}

/// Slopes along x and y, and the height at the origin, of the plane near that height; the level
/// plane where none is there.
Eigen::Vector3d fit_ground(std::span<const Eigen::Vector3d> points, double height) {
  Eigen::Vector3d plane(0, 0, height);
  for (const double gate_m : kGates_m) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d row(p.x(), p.y(), 1);
      if (std::abs(row.dot(plane) - p.z()) > gate_m) continue;
      normal += row * row.transpose();
      right += p.z() * row;
    }
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
    if (solver.info() != Eigen::Success || solver.rcond() < 1e-6) return {0, 0, height};
    plane = solver.solve(right);
    if (!(plane.head<2>().norm() < kSteepest)) return {0, 0, height};
  }
  return plane;
}

/// The part of the segment from a to b between two heights, as shares of its length from a; nothing
/// where it is empty.
std::optional<std::pair<double, double>> part_between(double a, double b, double min, double max) {
  if (a == b) return a >= min && a <= max ? std::optional(std::pair(0.0, 1.0)) : std::nullopt;
  const double one = (min - a) / (b - a);
  const double other = (max - a) / (b - a);
  const double begin = std::max(0.0, std::min(one, other));
  const double end = std::min(1.0, std::max(one, other));
  return begin <= end ? std::optional(std::pair(begin, end)) : std::nullopt;
}

}  // namespace

std::vector<Beam> beams_in_band(const Reading& cloud, const Pose& T_frame_robot,
                                const HeightBand& band, double resolution_m) {
  // In cells, as beams are.
  const Eigen::Vector3d robot = T_frame_robot.translation / resolution_m;
  const double min = band.min_m / resolution_m;
  const double max = band.max_m / resolution_m;
  const auto height = [&](const Eigen::Vector3d& p) {
    return p.z() - robot.z() - band.slope.dot((p - robot).head<2>());
  };
  std::vector<Beam> beams;
  for (Beam beam : beams_of(cloud, T_frame_robot, Space::se3, resolution_m)) {
    const auto part = part_between(height(beam.from), height(beam.to), min, max);
    if (!part) continue;
    const Eigen::Vector3d way = beam.to - beam.from;
    beam.hit = beam.hit && part->second == 1;
    beam.to = beam.from + part->second * way;
    beam.from += part->first * way;
    beam.from.z() = beam.to.z() = 0;
    beams.push_back(beam);
  }
  return beams;
}

HeightBand find_height_band(std::span<const PlacedObservation> observations,
                            const ObservationStore& store) {
  std::vector<double> heights;
  std::vector<Eigen::Vector3d> points;
  const size_t step = std::max<size_t>(1, observations.size() / kMostObservations);
  for (size_t k = 0; k < observations.size(); k += step) {
    const auto seen =
        near_points(*store.load(observations[k].observation), observations[k].T_frame_robot);
    if (seen.size() < kLeastPoints) continue;
    heights.push_back(low_height(seen));
    points.insert(points.end(), seen.begin(), seen.end());
  }
  if (heights.empty()) return {kLowest_m, kHighest_m, Eigen::Vector2d::Zero()};
  const Eigen::Vector3d ground = fit_ground(points, quantile(heights, 0.5));
  return {ground.z() + kLowest_m, ground.z() + kHighest_m, ground.head<2>()};
}

}  // namespace hmt::submap
