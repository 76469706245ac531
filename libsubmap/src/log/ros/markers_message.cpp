// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "markers_message.hpp"

#include <Eigen/Eigenvalues>
#include <charconv>
#include <optional>

namespace hmt::submap {
namespace {

/// No camera sees further; larger numbers break what is computed from them.
constexpr double kMaxDistance_m = 1000;
/// No one measures better or worse than these deviations; what claims to is set to the first, or is
/// none.
constexpr double kFinest_m = 1e-3;
constexpr double kCoarsest_m = 1000;
// Bytes of the shortest element of a sequence.
constexpr size_t kPose = 7 * 8;
constexpr size_t kPoseWithCovariance = kPose + 36 * 8;
constexpr size_t kLeastHeader = 12;
constexpr size_t kLeastTag = 4 + 4 + kLeastHeader + kPoseWithCovariance;
constexpr size_t kMarkerPose = 2 + kPose;
constexpr size_t kLeastDetection = kLeastHeader + 4 + kPose + 3 * 8 + 4;
constexpr size_t kLeastHypothesis = 4 + 8 + kPoseWithCovariance;

Eigen::Vector3d read_position(WireReader& in) {
  Eigen::Vector3d position;
  for (double& v : position) v = in.number<double>();
  in.skip<double>(4);  // orientation
  return position;
}

/// Position and its part of the covariance of geometry_msgs/PoseWithCovariance.
Marker read_place(WireReader& in) {
  Marker marker;
  marker.position = read_position(in);
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> covariance;
  for (Eigen::Index k = 0; k < 36; ++k) covariance.data()[k] = in.number<double>();
  marker.covariance = covariance.topLeftCorner<3, 3>();
  return marker;
}

/// The covariance, or a slightly larger one that can be inverted; nothing for what is none.
std::optional<Eigen::Matrix3d> usable(const Eigen::Matrix3d& covariance) {
  if (covariance.isZero(0)) return covariance;
  if (!covariance.allFinite()) return std::nullopt;
  const Eigen::Matrix3d symmetric = (covariance + covariance.transpose()) / 2;
  if (!(symmetric.cwiseAbs().maxCoeff() <= kCoarsest_m * kCoarsest_m) ||
      !(covariance - symmetric).isZero(1e-6 * symmetric.cwiseAbs().maxCoeff()))
    return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(symmetric);
  const Eigen::Vector3d& variances = eigen.eigenvalues();
  if (!(variances[0] >= -1e-9 * variances[2])) return std::nullopt;
  if (variances[0] >= kFinest_m * kFinest_m) return symmetric;
  return eigen.eigenvectors() * variances.cwiseMax(kFinest_m * kFinest_m).asDiagonal() *
         eigen.eigenvectors().transpose();
}

void add(const std::optional<int64_t>& name, Marker marker, MarkersMessage& message) {
  const auto covariance = usable(marker.covariance);
  // The greatest of some numbers may skip what is none.
  if (!covariance || !marker.position.allFinite() ||
      marker.position.cwiseAbs().maxCoeff() > kMaxDistance_m) {
    ++message.refused;
  } else if (!name || *name < 0) {
    ++message.unnamed;
  } else {
    marker.name = *name;
    marker.covariance = *covariance;
    message.markers.push_back(marker);
  }
}

/// apriltag_ros/AprilTagDetectionArray.
void read_april_tags(WireReader& in, MarkersMessage& message) {
  const size_t tags = in.count(kLeastTag);
  for (size_t k = 0; k < tags; ++k) {
    const size_t ids = in.count(sizeof(int32_t));
    // A bundle of tags has the ids of all its tags, which may be seen alone elsewhere.
    std::optional<int64_t> name;
    if (ids == 1) name = in.number<int32_t>();
    if (ids != 1) in.skip<int32_t>(ids);
    in.skip<double>(in.count(sizeof(double)));  // sizes
    const MessageHeader header = read_header(in);
    if (message.header.frame.empty()) message.header.frame = header.frame;
    add(name, read_place(in), message);
  }
}

/// ros2_aruco_interfaces/ArucoMarkers.
void read_aruco_markers(WireReader& in, MarkersMessage& message) {
  std::vector<int64_t> names(in.count(sizeof(int64_t)));
  for (int64_t& name : names) name = in.number<int64_t>();
  const size_t poses = in.count(kPose);
  if (poses != names.size()) throw MessageError("as many poses as ids are needed");
  for (const int64_t name : names) add(name, {0, read_position(in)}, message);
}

/// aruco_opencv_msgs/ArucoDetection, but for its boards.
void read_aruco_detection(WireReader& in, MarkersMessage& message) {
  const size_t markers = in.count(kMarkerPose);
  for (size_t k = 0; k < markers; ++k) {
    const auto name = int64_t{in.number<uint16_t>()};
    add(name, {0, read_position(in)}, message);
  }
}

/// Nothing for a text that is not one whole number.
std::optional<int64_t> number_in(std::string_view text) {
  int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

/// The place of the hypothesis with the greatest score, else of the bounding box.
Marker read_hypotheses(WireReader& in) {
  std::optional<Marker> best;
  double greatest = 0;
  const size_t hypotheses = in.count(kLeastHypothesis);
  for (size_t k = 0; k < hypotheses; ++k) {
    in.text();  // class
    const auto score = in.number<double>();
    const Marker marker = read_place(in);
    if (best && !(score > greatest)) continue;
    best = marker;
    greatest = score;
  }
  const Eigen::Vector3d middle = read_position(in);
  in.skip<double>(3);  // size
  return best.value_or(Marker{0, middle});
}

/// vision_msgs/msg/Detection3DArray of version 4.
void read_detections(WireReader& in, MarkersMessage& message) {
  const size_t detections = in.count(kLeastDetection);
  for (size_t k = 0; k < detections; ++k) {
    const MessageHeader header = read_header(in);
    if (message.header.frame.empty()) message.header.frame = header.frame;
    const Marker marker = read_hypotheses(in);
    add(number_in(in.text()), marker, message);
  }
}

}  // namespace

MarkersMessage read_markers(WireReader in, MessageKind kind) {
  MarkersMessage message;
  message.header = read_header(in);
  if (kind == MessageKind::april_tags) read_april_tags(in, message);
  if (kind == MessageKind::aruco_markers) read_aruco_markers(in, message);
  if (kind == MessageKind::aruco_detection) read_aruco_detection(in, message);
  if (kind == MessageKind::detections) read_detections(in, message);
  return message;
}

}  // namespace hmt::submap
