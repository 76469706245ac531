// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "relations_reader.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>
#include <utility>

#include "text_fields.hpp"

namespace hmt::submap {
namespace {

/// Deviations of a motion of which nothing is known, because its record is damaged or missing: what
/// a robot drives and turns between two records.
constexpr double kLostMotion_m = 1;
constexpr double kLostMotion_rad = 0.5;

/// Symmetric positive definite matrix from its upper triangle, row by row.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> take_covariance(std::string_view& fields) {
  Eigen::Matrix<double, kSize, kSize> covariance;
  for (int r = 0; r < kSize; ++r)
    for (int c = r; c < kSize; ++c)
      covariance(r, c) = covariance(c, r) = take_finite(fields, "covariance");
  if (covariance.llt().info() != Eigen::Success)
    throw std::invalid_argument("covariance is not positive definite");
  return covariance;
}

void expect_end(std::string_view& fields) {
  if (!take_field(fields).empty()) throw std::invalid_argument("too many fields");
}

/// The number of a landmark, or "-" where the sensor could not tell which one it saw.
int64_t take_landmark(std::string_view& fields) {
  std::string_view rest = fields;
  if (take_field(rest) == "-") {
    fields = rest;
    return kUnknownLandmark;
  }
  return take_count(fields, "number of the landmark");
}

Matrix6d lost_motion() {
  Vector6d deviation = Vector6d::Zero();
  deviation[0] = deviation[1] = kLostMotion_m;
  deviation[5] = kLostMotion_rad;
  return deviation.cwiseAbs2().asDiagonal();
}

}  // namespace

RelationsReader::RelationsReader(const std::filesystem::path& path)
    : lines_(path, report_), bytes_total_(static_cast<int64_t>(std::filesystem::file_size(path))) {
  while (!pose_ && lines_.read("text", [this](std::string_view record) { read_record(record); })) {
  }
  if (!pose_)
    throw InputError(lines_.source().place() +
                     ": no usable ODOMETRY or LANDMARK record up to here");
}

std::optional<Observation> RelationsReader::next() {
  while (!step_ && lines_.read("text", [this](std::string_view record) { read_record(record); })) {
  }
  if (!pose_) return std::nullopt;
  return take_pose();
}

void RelationsReader::read_record(std::string_view fields) {
  const std::string_view kind = take_field(fields);
  if (kind == "ODOMETRY") return read_odometry(fields);
  if (kind == "LANDMARK") return read_landmark(fields);
  throw std::invalid_argument("neither ODOMETRY nor LANDMARK");
}

void RelationsReader::read_odometry(std::string_view fields) {
  Step step;
  step.from = take_count(fields, "number of the pose");
  step.to = take_count(fields, "number of the next pose");
  const double x_m = take_finite(fields, "dx");
  const double y_m = take_finite(fields, "dy");
  step.T_from_to = Pose::planar(x_m, y_m, take_finite(fields, "dtheta"));
  const Eigen::Matrix3d covariance = take_covariance<3>(fields);
  expect_end(fields);
  constexpr std::array<int, 3> kPlanar = {0, 1, 5};
  step.covariance(kPlanar, kPlanar) = covariance;
  if (step.from == step.to) throw std::invalid_argument("a motion from a pose to itself");
  if (!pose_) begin_pose(step.from);
  if (step.from != *pose_) {
    lose(report_, "motions missing: a record does not go on from the pose before",
         lines_.source().place());
    step.covariance += lost_motion();
  }
  ++report_.odometry_records;
  step_ = step;
}

void RelationsReader::read_landmark(std::string_view fields) {
  const int64_t pose = take_count(fields, "number of the pose");
  Landmark landmark;
  landmark.id = take_landmark(fields);
  landmark.position_sensor.x() = take_finite(fields, "x");
  landmark.position_sensor.y() = take_finite(fields, "y");
  landmark.covariance_sensor.topLeftCorner<2, 2>() = take_covariance<2>(fields);
  expect_end(fields);
  if (!pose_) begin_pose(pose);
  if (pose != *pose_)
    throw std::invalid_argument("a landmark that was not seen from the latest pose");
  auto& readings = observation_.landmark_readings;
  if (readings.empty()) readings.emplace_back();
  readings.front().landmarks.push_back(landmark);
}

void RelationsReader::begin_pose(int64_t number) {
  pose_ = number;
  observation_.stamp_s = static_cast<double>(number);
  note(report_, "stamps absent", lines_.source().place());
}

Observation RelationsReader::take_pose() {
  Observation observation = std::move(observation_);
  observation.index = report_.observations++;
  observation_ = {};
  if (!step_) {
    pose_.reset();
    return observation;
  }
  begin_pose(step_->to);
  observation_.T_odom_robot = observation.T_odom_robot * step_->T_from_to;
  observation_.motion_covariance = step_->covariance;
  step_.reset();
  return observation;
}

}  // namespace hmt::submap
