// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hmt/submap/overlap/overlap.hpp"
#include "svg.hpp"

namespace hmt::paper {
namespace {

using submap::Matrix6d;
using submap::Observation;
using submap::Pose;

Matrix6d planar_covariance(const PoseSigma& sigma) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(0, 0) = covariance(1, 1) = sigma.m * sigma.m;
  covariance(5, 5) = sigma.rad * sigma.rad;
  return covariance;
}

graph::Labels cut_at(const graph::WeightedGraph& overlap, double tau) {
  graph::PartitionOptions options;
  options.tau = tau;
  return graph::recursive_partition(overlap, options).labels;
}

int groups(const graph::Labels& labels) {
  return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
}

}  // namespace

bool is_next_keyframe(const Pose& last, const Pose& now) {
  const Pose move = graph::relative_pose(last, now);
  return move.translation.norm() >= kKeyframeDistance_m ||
         std::abs(move.yaw_rad()) >= kKeyframeAngle_rad;
}

int SensorAreas::areas() const {
  return groups(labels);
}

SensorAreas divide(const std::string& name, const Drive& drive,
                   const std::function<Observation(const Observation&)>& keep,
                   const PoseSigma& sigma, double tau, int threads) {
  std::vector<Observation> kept;
  std::vector<submap::Keyframe> keyframes;
  for (const Observation& observation : drive.observations) {
    const auto id = static_cast<int>(kept.size());
    keyframes.push_back({id, id, observation.stamp_s, {}});
    kept.push_back(keep(observation));
  }
  submap::Run run;
  run.threads = threads;
  SensorAreas result;
  result.name = name;
  result.overlap = submap::overlap_graph(
      keyframes, drive.T_world_robot,
      [&sigma](int, int) { return std::optional(planar_covariance(sigma)); },
      submap::ObservationVector(std::move(kept)), {}, run);
  result.labels = cut_at(result.overlap, tau);
  return result;
}

int areas_at(const SensorAreas& sensors, double tau) {
  return groups(cut_at(sensors.overlap, tau));
}

std::vector<Eigen::Vector2d> wall_points(const Drive& drive) {
  std::vector<Eigen::Vector2d> walls;
  for (size_t k = 0; k < drive.observations.size(); k += 3)
    for (const Eigen::Vector3d& p : submap::points_in_robot(drive.observations[k]))
      walls.emplace_back((drive.T_world_robot[k] * p).head<2>());
  return walls;
}

std::string sensors_svg(const std::string& title, const Drive& drive,
                        const std::vector<Eigen::Vector2d>& walls,
                        const std::vector<SensorAreas>& rows) {
  const double side = 300;
  const double row_height = side + 30;
  Eigen::Vector2d low = drive.T_world_robot.front().translation.head<2>();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& wall : walls) {
    low = low.cwiseMin(wall);
    high = high.cwiseMax(wall);
  }
  Svg svg(3 * side + 40, static_cast<double>(rows.size()) * row_height + 35);
  svg.text({10, 20}, title, "start", 14);
  std::vector<int> in_time(drive.observations.size());
  std::iota(in_time.begin(), in_time.end(), 0);
  const MapView origin(low, high, {0, 0}, {side, side});
  svg.add(R"(<defs><path id="walls" stroke="#aaa" fill="none" d=")" + dots(origin, walls) +
          R"("/></defs>)");
  double top = 30;
  for (const SensorAreas& row : rows) {
    svg.text({10, top + 16}, fmt::format("{}: {} areas", row.name, row.areas()));
    svg.add(fmt::format(R"(<use href="#walls" x="10" y="{}"/>)", px(top + 22)));
    const MapView view(low, high, {10, top + 22}, {side, side});
    for (size_t k = 0; k < row.labels.size(); ++k)
      svg.circle(view(drive.T_world_robot[k].translation.head<2>()), 2.5,
                 group_color(row.labels[k]));
    draw_matrix(svg, {side + 20, top + 22}, side, row.overlap, in_time);
    draw_matrix(svg, {2 * side + 30, top + 22}, side, row.overlap, order_by_group(row.labels),
                row.labels);
    top += row_height;
  }
  return svg.str();
}

}  // namespace hmt::paper
