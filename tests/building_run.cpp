// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "building_run.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "hmt/submap/export/carmen_file.hpp"
#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/pipeline.hpp"
#include "temporary_folder.hpp"

namespace hmt::test {
namespace {

using namespace submap;

std::vector<StampedPose> write_log(const SimulationOptions& options,
                                   const std::filesystem::path& path) {
  std::vector<StampedPose> truth;
  Simulation simulation(options);
  CarmenWriter writer(path);
  while (const auto scan = simulation.next()) {
    const Observation& o = scan->observation;
    writer.add(scan->ranges_m, o.T_odom_robot * o.readings.at(0).T_robot_sensor, o.T_odom_robot,
               o.stamp_s);
    truth.push_back({o.stamp_s, scan->T_world_robot});
  }
  writer.commit();
  return truth;
}

std::vector<Pose> true_keyframes(const HybridMap& map, const std::vector<StampedPose>& truth) {
  std::vector<Pose> poses;
  for (const Keyframe& keyframe : map.track.keyframes)
    poses.push_back(truth.at(static_cast<size_t>(keyframe.observation)).T_world_robot);
  return poses;
}

Pose between(const std::vector<Pose>& poses, int a, int b) {
  return graph::relative_pose(poses.at(static_cast<size_t>(a)), poses.at(static_cast<size_t>(b)));
}

void count_closures(const HybridMap& map, const std::vector<Pose>& truth,
                    BuildingFigures& figures) {
  for (const Constraint& c : map.constraints) {
    if (is_within_visit(c)) continue;
    ++figures.closures;
    const Vector6d error = graph::boxminus(c.T_a_b, between(truth, c.a, c.b));
    if (error.head<3>().norm() > 0.3 || error.tail<3>().norm() > 0.1) ++figures.false_closures;
  }
}

void count_revisits(const HybridMap& map, const std::vector<Pose>& truth,
                    BuildingFigures& figures) {
  constexpr int kNear = 5;
  std::vector<double> path_m(truth.size(), 0);
  for (size_t k = 1; k < truth.size(); ++k)
    path_m[k] = path_m[k - 1] + (truth[k].translation - truth[k - 1].translation).norm();
  for (int b = 0; b < static_cast<int>(truth.size()); ++b) {
    bool revisit = false;
    bool closed = false;
    for (int a = 0; a < b; ++a) {
      if (path_m[static_cast<size_t>(b)] - path_m[static_cast<size_t>(a)] < 20) break;
      const Pose T = between(truth, a, b);
      if (T.translation.norm() > 0.5 || std::abs(T.yaw_rad()) > 0.3) continue;
      revisit = true;
      closed =
          closed ||
          std::any_of(map.constraints.begin(), map.constraints.end(), [&](const Constraint& c) {
            return !is_within_visit(c) && std::abs(c.a - a) <= kNear && std::abs(c.b - b) <= kNear;
          });
    }
    figures.revisits += revisit ? 1 : 0;
    figures.closed += closed ? 1 : 0;
  }
}

double nees(const Pose& is, const Pose& should, const Matrix6d& covariance) {
  const Eigen::Array3i plane(0, 1, 5);
  const Eigen::Vector3d error = graph::boxminus(is, should)(plane);
  const Eigen::Matrix3d planar = covariance(plane, plane);
  return error.dot(planar.inverse() * error);
}

void rate_covariances(const HybridMap& map, const std::vector<Pose>& truth,
                      BuildingFigures& figures) {
  const auto frame = [&](int submap) {
    return map.submaps.at(static_cast<size_t>(submap)).keyframes.front();
  };
  figures.submaps = static_cast<int>(map.submaps.size());
  figures.links = static_cast<int>(map.links.size());
  for (int s = 1; s < figures.submaps; ++s) {
    const auto i = static_cast<size_t>(s);
    figures.submap_nees +=
        nees(graph::relative_pose(map.T_world_submap[0], map.T_world_submap[i]),
             between(truth, frame(0), frame(s)), map.covariance_world_submap[i]) /
        (figures.submaps - 1);
  }
  for (const Link& link : map.links)
    figures.link_nees +=
        nees(link.T_a_b, between(truth, frame(link.a), frame(link.b)), link.covariance) /
        figures.links;
}

}  // namespace

BuildingFigures run_building(const SimulationOptions& options, int threads) {
  const TemporaryFolder folder;
  const std::vector<StampedPose> truth = write_log(options, folder.path() / "log");
  Run run;
  run.threads = threads;
  const HybridMap map = build_map(folder.path() / "log", folder.path() / "map.hmt", {},
                                  MapFile::Existing::resume, run)
                            .file.load_map();
  const std::vector<Pose> keyframes = true_keyframes(map, truth);
  BuildingFigures figures;
  count_closures(map, keyframes, figures);
  count_revisits(map, keyframes, figures);
  rate_covariances(map, keyframes, figures);
  figures.ate_rmse_m = evaluate_trajectory(stamped_trajectory(map), truth).ate_rmse_m;
  return figures;
}

}  // namespace hmt::test
