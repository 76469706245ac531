// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/trajectory.hpp"

#include <stdexcept>
#include <string>

#include "../log/line_source.hpp"
#include "../log/text_fields.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/submap/export/atomic_file.hpp"
#include "number_text.hpp"

namespace hmt::submap {
namespace {

using graph::Pose;

constexpr int kPoseDecimals = 9;

int count_fields(std::string_view fields) {
  int count = 0;
  while (!take_field(fields).empty()) ++count;
  return count;
}

StampedPose parse_tum(std::string_view fields) {
  StampedPose pose;
  pose.stamp_s = take_finite(fields, "stamp");
  if (std::string_view rest = fields; count_fields(rest) == 3) {
    const double x_m = take_finite(fields, "x");
    const double y_m = take_finite(fields, "y");
    pose.T_world_robot = Pose::planar(x_m, y_m, take_finite(fields, "heading"));
    return pose;
  }
  for (int k = 0; k < 3; ++k) pose.T_world_robot.translation[k] = take_finite(fields, "position");
  Eigen::Vector4d q;  // x y z w, as in the file
  for (int k = 0; k < 4; ++k) q[k] = take_finite(fields, "quaternion");
  if (!take_field(fields).empty()) throw std::invalid_argument("more than 8 fields");
  if (q.norm() < 1e-6) throw std::invalid_argument("quaternion of length zero");
  pose.T_world_robot.rotation = Eigen::Quaterniond(q.normalized());
  return pose;
}

}  // namespace

std::vector<StampedPose> read_tum(const std::filesystem::path& path) {
  LineSource lines(path);
  std::vector<StampedPose> trajectory;
  while (const auto line = lines.next()) {
    const std::string_view fields = without_comment(*line);
    if (fields.empty()) continue;
    try {
      trajectory.push_back(parse_tum(fields));
    } catch (const std::invalid_argument& error) {
      throw graph::InputError(
          lines.place() + ": " + error.what() +
          "; a TUM line is 'stamp x y z qx qy qz qw', or 'stamp x y heading' in "
          "the plane");
    }
  }
  if (!lines.damage().empty()) throw graph::InputError(path.string() + ": " + lines.damage());
  if (trajectory.empty()) throw graph::InputError(path.string() + ": no poses in the file");
  return trajectory;
}

void write_tum(const std::filesystem::path& path, std::span<const StampedPose> trajectory) {
  AtomicFile file(path);
  std::string line;
  for (const auto& [stamp_s, T_world_robot] : trajectory) {
    line.clear();
    append_stamp(line, stamp_s);
    for (const double value : T_world_robot.translation) append_number(line, value, kPoseDecimals);
    const Eigen::Vector4d q = T_world_robot.rotation.coeffs();
    for (const double value : q) append_number(line, value, kPoseDecimals);
    line += '\n';
    file.write(line);
  }
  file.commit();
}

std::vector<StampedPose> stamped_trajectory(const HybridMap& map) {
  const std::vector<Pose> T_world_robot = world_trajectory(map);
  std::vector<StampedPose> trajectory;
  for (size_t k = 0; k < T_world_robot.size(); ++k)
    trajectory.push_back({map.track.observations[k].stamp_s, T_world_robot[k]});
  return trajectory;
}

}  // namespace hmt::submap
