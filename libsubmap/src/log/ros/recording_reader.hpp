// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "../range_limit.hpp"
#include "hmt/submap/log/log_reader.hpp"
#include "landmark_sights.hpp"
#include "pose_history.hpp"
#include "recording_plan.hpp"
#include "sweep.hpp"

namespace hmt::submap {

/// Reads the scans and the odometry of a recording of ROS: each scan of the first topic, at the
/// odometry interpolated at its stamp, is an observation; a scan of another topic next to it is a
/// further reading of it.
///
/// Scans whose beams or points have times of their own are taken as seen from where the sensor was
/// at the stamp: each point is moved by what the odometry, and a gyroscope, say that the robot did
/// in between.
///
/// Landmarks are further readings of the observation that is nearest in time. Where there are no
/// scans each message of them is an observation.
///
/// A scan waits until the odometry around it has been read, but for no more than two seconds
/// of the recording. Laser scans are read ahead to learn the code for a miss, as from CARMEN logs.
class RecordingReader : public LogReader {
 public:
  RecordingReader(const std::filesystem::path& path, const LogOptions& options);

  std::optional<Observation> next() override;
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return recording_->bytes_read(); }
  int64_t bytes_total() const override { return bytes_total_; }
  Space space() const override { return plan_.space; }
  bool has_landmarks_only() const override { return plan_.scan_topics.empty(); }

 private:
  /// A scan or a cloud on its way to become a reading.
  struct Scan {
    size_t sensor = 0;
    int64_t stamp_ns = 0;     ///< by the clock of the odometry
    int64_t received_ns = 0;  ///< by the recorder's
    double own_stamp_s = 0;
    std::string place;
    Pose T_robot_sensor;
    Pose T_odom_robot;                ///< at stamp_ns
    LaserScanMessage laser;           ///< of a laser
    CloudMessage cloud;               ///< of another sensor
    std::vector<float> beam_times_s;  ///< after the stamp: of beams, or of points; may be empty
    double first_beam_s = 0;          ///< the least of them
    double last_beam_s = 0;           ///< the greatest
    std::optional<Sweep> sweep;       ///< where there are such times and the odometry around them
    bool is_laser = true;
    bool is_upside_down = false;
  };

  std::optional<Observation> next_scans();
  std::optional<Observation> next_landmarks();
  bool has_read_past(int64_t received_ns) const;
  bool read_message();
  void use_message(const RecordedMessage& message);
  void add_scan(const RecordedMessage& message, size_t sensor, const RecordedTopic& topic);
  void add_landmarks(const RecordedMessage& message, const RecordedTopic& topic);
  void join_landmarks(const Scan& scan, Observation& observation);
  void add_odometry(const MessageHeader& header, int64_t received_ns, const Pose& T_odom_robot);
  void add_imu(const RecordedMessage& message, const RecordedTopic& topic);
  void add_transforms(const RecordedMessage& message, const RecordedTopic& topic);
  int64_t clock_ns(const MessageHeader& header, int64_t received_ns);
  bool mount(const MessageHeader& header, Scan& scan);
  bool mount_in_plane(Scan& scan);
  bool place_scans();
  bool has_odometry(const Scan& scan) const;
  void find_sweep(Scan& scan);
  bool waits_too_long(const Scan& scan) const;
  Reading reading(const Scan& scan, const Pose& T_odom_robot);
  Reading laser_reading(const Scan& scan, Reading reading);
  Reading cloud_reading(const Scan& scan, Reading reading);
  void note_stamp(double stamp_s, const std::string& place);
  void note(const std::string& what, const std::string& place, int64_t times = 1);
  void lose(const std::string& what, const std::string& place, int64_t times = 1);
  std::string place(const RecordedTopic& topic) const;

  std::filesystem::path path_;
  RecordingPlan plan_;
  std::unique_ptr<Recording> recording_;
  int64_t bytes_total_ = 0;
  LogReport report_;
  PoseHistory odometry_;
  TurnRates turn_rates_;
  std::map<size_t, RangeLimit> limits_;  ///< by sensor
  std::deque<Scan> waiting_;             ///< for their odometry
  std::deque<Scan> ahead_;               ///< with their pose
  LandmarkSights sights_;
  std::map<std::string, int> landmark_sensors_;  ///< by topic, as they come up
  int64_t last_received_ns_ = 0;
  int64_t messages_ = 0;
  std::optional<double> last_stamp_s_;
  bool at_end_ = false;
};

}  // namespace hmt::submap
