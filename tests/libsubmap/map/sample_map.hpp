// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "hmt/submap/map/map_file.hpp"

namespace hmt::test {

/// An own empty folder below the system's temporary one, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hmtmap_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Numbers that no shortcut survives: every digit of the mantissa, the sign of a zero.
inline submap::Pose odd_pose(int k) {
  return {{k / 3.0, -0.0, 1e-17 * k}, {0.6, 0.8 / 3, -0.0, k * 0.1}};
}

inline submap::Matrix6d odd_matrix(int k) {
  submap::Matrix6d matrix;
  for (int i = 0; i < 36; ++i) matrix(i) = k + i / 7.0;
  return matrix;
}

inline submap::PlacedLandmark odd_landmark(int k) {
  return {k, {k / 3.0, -0.0, 0.1 * k}, odd_matrix(k).topLeftCorner<3, 3>()};
}

/// Two keyframes and one more observation in a square room; each keyframe is a submap of its own,
/// 2 m apart, the second one turned left. All numbers are made up but fit together.
inline submap::HybridMap sample_map() {
  using namespace submap;
  HybridMap map;
  Track& track = map.track;
  track.keyframes = {{0, 0, 100.1, odd_pose(0)}, {1, 2, 100.3, odd_pose(1)}};
  track.observations = {
      {0, 100.1, 0, Pose{}}, {1, 100.2, 0, Pose::planar(1, 0, 0.1)}, {2, 100.3, 1, Pose{}}};
  track.odometry = {{0, 1, ConstraintKind::odometry, odd_pose(2), odd_matrix(1)}};
  track.log.observations = 3;
  track.log.odometry_records = 17;
  track.log.notes = {{"stamps run backwards", 4}};
  track.log.losses = {{"too few fields", 2}, {"not a number", 1}};
  map.constraints = {track.odometry[0], {0, 1, ConstraintKind::loop, odd_pose(3), odd_matrix(2)}};
  map.overlap = {{0, 1, 1.0 / 3}};
  map.submap_of_keyframe = {0, 1};
  map.submaps = {
      {0, {0}, {Pose{}}, {odd_matrix(3)}, {0, 1}, {odd_landmark(1), odd_landmark(2)}, 0.25, 3},
      {1, {1}, {Pose{}}, {odd_matrix(4)}, {}, {odd_landmark(2)}, 0.5, 6}};
  map.links = {
      {0, 1, Pose::planar(2, 0, 1.5), Matrix6d::Identity() * 0.01, {0, 1}, {2}, 0.2, 0.03}};
  map.sightings = {{0, 0, 0, 1, {1.0 / 3, -0.0, 1e-17}, odd_matrix(6).topLeftCorner<3, 3>()},
                   {2, 3, 1, 2, {2, 0.1, 0}, odd_matrix(7).topLeftCorner<3, 3>()}};
  map.landmark_names = {7, kUnknownLandmark, int64_t{1} << 60};
  map.landmarks = {odd_landmark(1), odd_landmark(2)};
  map.landmark_information_loss = 1.0 / 9;
  LoopCandidate loop;
  loop.a = 0;
  loop.b = 1;
  loop.submap_b = 1;
  loop.T_a_b = odd_pose(5);
  loop.information = odd_matrix(5);
  loop.score = 0.9;
  loop.second_score = 0.1;
  loop.verdict = LoopVerdict::ambiguous;
  loop.reason = "the second-best match is nearly as good, \"<&>\"";
  map.loops = {loop};
  map.T_world_submap = {Pose{}, Pose::planar(2, 0, 1.5707963267948966)};
  map.covariance_world_submap = {Matrix6d::Zero(), Matrix6d::Identity() * 0.01};
  map.information_loss = 1.0 / 7;
  map.chi2_initial = 12.5;
  map.chi2 = 2.5;
  return map;
}

/// What the sample map's robot saw: 8 beams, hits at 2 m in the even directions.
inline submap::Observation sample_observation(int64_t index) {
  submap::Reading reading;
  reading.max_range_m = 20;
  reading.beam_step_rad = 0.8;
  for (int k = 0; k < 8; ++k) {
    const float angle = 0.7853981634f * static_cast<float>(k);
    const Eigen::Vector3f direction(std::cos(angle), std::sin(angle), 0);
    if (k % 2 == 0)
      reading.points_sensor.push_back(2 * direction);
    else
      reading.misses_sensor.push_back(direction);
  }
  submap::LandmarkReading landmarks;
  landmarks.sensor = 1;
  landmarks.T_robot_sensor = odd_pose(3);
  landmarks.landmarks = {
      {7, {1.0 / 3, -0.0, 2}, odd_matrix(9).topLeftCorner<3, 3>(), {0.1f, -0.0f}},
      {submap::kUnknownLandmark, {1, 2, 3}, Eigen::Matrix3d::Zero(), {}}};
  return {index,
          100.1 + 0.1 * static_cast<double>(index),
          odd_pose(static_cast<int>(index)),
          odd_matrix(8),
          {reading},
          {landmarks}};
}

inline submap::MapOrigin sample_origin() {
  return {"logs/sample.clf", "0123456789abcdef", R"({"partition":{"tau":0.5}})", "0.1.0"};
}

/// Writes the sample map with all its stages.
inline void write_sample_map(const std::filesystem::path& path) {
  using namespace submap;
  const HybridMap map = sample_map();
  MapFile file = MapFile::open_for_run(path, sample_origin(), MapFile::Existing::resume);
  StageWriter track = file.begin("track");
  for (int64_t k = 0; k < 3; ++k) track.add(sample_observation(k));
  track.put_track(map.track);
  track.commit();
  StageWriter rest = file.begin("rest");
  rest.put_constraints(map.constraints);
  rest.put_sightings(map.sightings);
  rest.put_landmark_names(map.landmark_names);
  rest.put_overlap(map.overlap);
  rest.put_partition(map.submap_of_keyframe);
  for (const Submap& submap : map.submaps) rest.put_submap(submap);
  rest.put_links(map.links);
  rest.put_loops(map.loops);
  rest.put_solution({map.T_world_submap, map.covariance_world_submap, map.information_loss,
                     map.chi2_initial, map.chi2, map.division, map.landmark_information_loss,
                     map.landmarks});
  rest.commit();
}

}  // namespace hmt::test
