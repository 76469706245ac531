// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "log_options.hpp"

#include <CLI/CLI.hpp>

namespace hmt::apps {

void add_log_options(CLI::App& command, submap::LogOptions& options) {
  command
      .add_option("--scan-topic", options.scan_topics,
                  "Of bags: topic of the scans or clouds, if there are several; may be given once "
                  "for each sensor")
      ->type_name("TOPIC")
      ->allow_extra_args(false);
  command
      .add_option("--landmark-topic", options.landmark_topics,
                  "Of bags: topic of landmarks, may be given once for each sensor; all topics of "
                  "markers without it, vision_msgs/Detection3DArray only with it, since what it "
                  "tells of may move; none takes none")
      ->type_name("TOPIC")
      ->allow_extra_args(false);
  command
      .add_option("--odom-topic", options.odometry_topic,
                  "Of bags: topic of the odometry, if there are several; /tf takes the transform "
                  "below the frame odom; none: the scans alone tell how the robot moves")
      ->type_name("TOPIC");
  command
      .add_option(
          "--odometry", options.odometry_file,
          "Of a folder of clouds: their poses by odometry, TUM or KITTI, line N for cloud N; "
          "without it the clouds alone tell the way")
      ->type_name("FILE");
  command
      .add_option("--robot", options.robot,
                  "Of an MRCLAM folder with the logs of several robots: which one")
      ->check(CLI::NonNegativeNumber);
}

}  // namespace hmt::apps
