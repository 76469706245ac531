// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "stamped_poses_file.hpp"

#include <cmath>

#include "../line_source.hpp"
#include "../report_book.hpp"
#include "../text_fields.hpp"

namespace hmt::submap {
namespace {

constexpr size_t kTumFields = 8;
constexpr size_t kKittiFields = 12;
/// What rounding to some decimals leaves of a unit quaternion or an orthogonal matrix.
constexpr double kUnitTolerance = 0.1;
constexpr double kMaxCoordinate = 1e7;  // metres

/// All numbers of a line; empty where a field is not a finite number.
std::vector<double> numbers_of(std::string_view line) {
  std::vector<double> numbers;
  for (auto field = take_field(line); !field.empty(); field = take_field(line)) {
    const auto value = to_number(field);
    if (!value || !std::isfinite(*value) || numbers.size() > kKittiFields) return {};
    numbers.push_back(*value);
  }
  return numbers;
}

std::optional<Pose> pose_of(const Eigen::Vector3d& translation,
                            const Eigen::Quaterniond& rotation) {
  if (translation.lpNorm<Eigen::Infinity>() > kMaxCoordinate) return std::nullopt;
  if (!(std::abs(rotation.norm() - 1) <= kUnitTolerance)) return std::nullopt;
  return Pose{translation, rotation.normalized()};
}

PoseLine tum_line(const std::vector<double>& v) {
  return {v[0], pose_of({v[1], v[2], v[3]}, Eigen::Quaterniond(v[7], v[4], v[5], v[6]))};
}

PoseLine kitti_line(const std::vector<double>& v) {
  Eigen::Matrix3d R;
  R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > kUnitTolerance ||
      R.determinant() < 0)
    return {};
  return {std::nullopt, pose_of({v[3], v[7], v[11]}, Eigen::Quaterniond(R))};
}

}  // namespace

std::vector<PoseLine> read_pose_lines(const std::filesystem::path& path, LogReport& report) {
  LineSource lines(path);
  std::vector<PoseLine> poses;
  size_t fields = 0;
  while (const auto line = lines.next()) {
    const std::string_view content = without_comment(*line);
    if (content.empty()) continue;
    const std::vector<double> numbers = numbers_of(content);
    if (fields == 0) fields = numbers.size();
    if (fields != kTumFields && fields != kKittiFields)
      throw InputError(lines.place() + ": neither a pose of TUM (8 numbers) nor of KITTI (12)");
    PoseLine pose;
    if (numbers.size() == fields)
      pose = fields == kTumFields ? tum_line(numbers) : kitti_line(numbers);
    if (!pose.T) add_loss(report, "lines of the odometry file that are no pose", lines.place());
    poses.push_back(pose);
  }
  if (!lines.damage().empty()) add_loss(report, lines.damage(), lines.place());
  return poses;
}

std::vector<double> read_stamps(const std::filesystem::path& path) {
  LineSource lines(path);
  std::vector<double> stamps;
  while (const auto line = lines.next()) {
    std::string_view content = without_comment(*line);
    if (content.empty()) continue;
    const auto stamp_s = to_number(take_field(content));
    if (!stamp_s || !std::isfinite(*stamp_s)) throw InputError(lines.place() + ": no stamp");
    stamps.push_back(*stamp_s);
  }
  return stamps;
}

}  // namespace hmt::submap
