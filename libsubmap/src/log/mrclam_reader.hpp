// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "record_lines.hpp"

namespace hmt::submap {

/// Robots whose logs lie in an MRCLAM folder, by the names of its files; empty for another folder.
std::vector<int> mrclam_robots(const std::filesystem::path& folder);

/// Reads one robot of an MRCLAM folder [Leung 2011], files plain or compressed:
///   RobotN_Odometry.dat      stamp, forward velocity, angular velocity
///   RobotN_Measurement.dat   stamp, barcode, range, bearing
///   Barcodes.dat             subject, barcode
/// Velocities hold until the next record. An observation is made of the measurements of one stamp,
/// and wherever the robot has moved by kStep without any. Landmarks are named by their subject;
/// subjects 1 to 5 are the robots, which are left out. Files of the ground truth are not read.
class MrclamReader : public LogReader {
 public:
  /// Throws InputError for a missing file, a robot that is not there and a log without
  /// measurements.
  MrclamReader(const std::filesystem::path& folder, int robot);

  std::optional<Observation> next() override;
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override;
  int64_t bytes_total() const override { return bytes_total_; }
  Space space() const override { return Space::se2; }
  bool has_landmarks_only() const override { return true; }

 private:
  struct Velocity {
    double stamp_s = 0;
    double forward_m_s = 0;
    double turn_rad_s = 0;
  };
  struct Sighting {
    double stamp_s = 0;
    Landmark landmark;
  };

  void read_barcodes(const std::filesystem::path& path);
  void read_velocity();
  void read_sighting();
  void parse_velocity(std::string_view fields);
  bool parse_sighting(std::string_view fields);
  void drive_to(double stamp_s);
  bool has_moved() const;
  Observation take(double stamp_s);

  LogReport report_;
  std::map<int64_t, int64_t> subject_of_barcode_;
  RecordLines velocities_;
  RecordLines sightings_;
  int64_t bytes_total_ = 0;
  std::optional<Velocity> next_velocity_;
  std::optional<Sighting> next_sighting_;
  Velocity velocity_;  ///< that holds now; its stamp is that of the pose
  double holds_until_s_ = 0;
  Pose T_odom_robot_;
  Pose T_odom_latest_;  ///< of the latest observation
};

}  // namespace hmt::submap
