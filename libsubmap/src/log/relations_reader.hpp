// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "record_lines.hpp"

namespace hmt::submap {

/// Reads a planar log of relative poses and landmarks as text (Victoria Park as GTSAM has it):
///
///   ODOMETRY from to dx dy dyaw xx xy xt yy yt tt    motion, upper triangle of its covariance
///   LANDMARK pose landmark x y xx xy yy              position in the robot frame, the same
///
/// Poses and landmarks share one numbering; a landmark is "-" where the sensor could not tell which
/// one it saw. Every pose becomes an observation. The format has no stamps: the number of the pose
/// stands for the seconds.
class RelationsReader : public LogReader {
 public:
  /// Throws InputError for a file without a usable record.
  explicit RelationsReader(const std::filesystem::path& path);

  std::optional<Observation> next() override;
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return lines_.source().bytes_read(); }
  int64_t bytes_total() const override { return bytes_total_; }
  Space space() const override { return Space::se2; }
  bool has_landmarks_only() const override { return true; }

 private:
  struct Step {
    int64_t from = 0;
    int64_t to = 0;
    Pose T_from_to;
    Matrix6d covariance = Matrix6d::Zero();
  };

  void read_record(std::string_view fields);
  void read_odometry(std::string_view fields);
  void read_landmark(std::string_view fields);
  void begin_pose(int64_t number);
  Observation take_pose();

  LogReport report_;
  RecordLines lines_;
  int64_t bytes_total_ = 0;
  std::optional<int64_t> pose_;  ///< number of the pose that is being read
  Observation observation_;      ///< what is known of it
  std::optional<Step> step_;     ///< that leads away from it
};

}  // namespace hmt::submap
