// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <map>
#include <string>

#include "carmen_record.hpp"
#include "hmt/submap/log/log_reader.hpp"
#include "line_source.hpp"
#include "range_limit.hpp"

namespace hmt::submap {

/// Reads a CARMEN text log. The first scans are read ahead to learn what the lines do not tell: the
/// laser's mount and the code for a miss.
///
/// The front laser (FLASER or ROBOTLASER1, whichever comes first) makes the observations; a scan of
/// the rear laser (RLASER, ROBOTLASER2) next to a front scan becomes its second reading.
class CarmenReader : public LogReader {
 public:
  explicit CarmenReader(const std::filesystem::path& path);

  std::optional<Observation> next() override;
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return lines_.bytes_read(); }
  int64_t bytes_total() const override { return bytes_total_; }
  Space space() const override { return Space::se2; }

 private:
  struct Scan {
    int sensor = 0;
    std::string place;
    CarmenScan record;
  };
  /// What is known of one laser.
  struct Laser {
    std::string message;  ///< the message it is read from
    Pose T_robot_laser;
    RangeLimit limit;
    std::optional<size_t> beams;  ///< of the last scan
  };

  bool read_scan();
  void read_record(std::string_view message, std::string_view fields);
  void keep_scan(int sensor, std::string_view message, CarmenScan record);
  void learn_mounts();
  void learn_odometry();
  Pose T_odom_robot(const Scan& scan) const;
  Pose T_odom_laser(const Scan& scan);
  Reading reading(const Scan& scan, const Pose& T_odom_robot);
  bool belongs_to(const Scan& scan, const Scan& front) const;
  void note_stamp(const Scan& scan);
  void note(const std::string& what, const std::string& place, int64_t times = 1);
  void lose(const std::string& what, const std::string& place);

  LineSource lines_;
  int64_t bytes_total_ = 0;
  LogReport report_;
  std::deque<Scan> ahead_;
  std::map<int, Laser> lasers_;
  std::optional<double> max_range_param_m_;
  std::optional<int> stamp_fields_;
  bool odometry_is_frozen_ = false;
  bool known_message_seen_ = false;
  std::optional<double> last_stamp_s_;
};

}  // namespace hmt::submap
