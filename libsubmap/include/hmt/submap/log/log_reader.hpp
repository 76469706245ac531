// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// What happened while a log was read. Losses are what could not be used.
struct LogReport {
  int64_t observations = 0;
  int64_t odometry_records = 0;
  /// Harmless peculiarities and how often: "stamps run backwards", ...
  std::map<std::string, int64_t> notes;
  /// Records that were left out and how often, by reason.
  std::map<std::string, int64_t> losses;
  /// Where the first of each note and loss was: "file:line".
  std::map<std::string, std::string> first_places;

  bool operator==(const LogReport&) const = default;
};

/// One forward pass over a log, with bounded memory.
class LogReader {
 public:
  virtual ~LogReader() = default;
  /// The next observation; nothing at the end. Throws InputError naming file and line (or byte)
  /// where the file cannot be read any further.
  virtual std::optional<Observation> next() = 0;
  /// What was read so far.
  virtual const LogReport& report() const = 0;
  /// Bytes of the file consumed so far and in all, for progress.
  virtual int64_t bytes_read() const = 0;
  virtual int64_t bytes_total() const = 0;
  /// Whether the log's poses lie in a plane.
  virtual Space space() const = 0;
  /// Whether all that the robot senses are landmarks.
  virtual bool has_landmarks_only() const { return false; }
};

/// What of a log is wanted, where it holds more than one thing. Recordings of ROS have topics,
/// other logs have none.
struct LogOptions {
  /// Topics of the range sensors, sensor 0 first; empty: the only one.
  std::vector<std::string> scan_topics;
  /// Topic of the odometry, nav_msgs/Odometry or /tf; empty: the only one; "none": the scans alone
  /// tell how the robot moves, and the poses of the observations are identities.
  std::string odometry_topic;
  /// File with the poses of a folder of clouds; empty: there is none.
  std::string odometry_file;
  /// Robot of a folder with the logs of several, >= 0; must be given for such a folder.
  std::optional<int> robot = std::nullopt;
  /// Topics of landmarks; empty: all that carry markers; the one name "none": no landmarks.
  std::vector<std::string> landmark_topics = {};
  /// What goes on where the log ends: the further parts of a split recording, in their order. Of
  /// CARMEN logs and recordings of ROS, all parts of one format.
  std::vector<std::filesystem::path> further_parts = {};

  bool operator==(const LogOptions&) const = default;
};

/// Opens a log by its content:
///   CARMEN text, or relative poses and landmarks as text (Victoria Park), plain or compressed (gz,
///   bz2, zst);
///   ROS 1 bags, MCAP files, ROS 2 sqlite3 bags, or a folder of these;
///   a folder of clouds (PCD, PLY or KITTI's bin), LogOptions::odometry_file beside it;
///   a folder of MRCLAM files.
/// Throws InputError for a missing, unreadable, empty or unknown file, for topics and robots that
/// are not there or not obvious, and for parts that do not go together.
std::unique_ptr<LogReader> open_log(const std::filesystem::path& path,
                                    const LogOptions& options = {});

}  // namespace hmt::submap
