// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Any bytes are either read as a log of whatever format to their end, with finite numbers in every
// observation, or refused with an InputError.
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>

#include "hmt/submap/log/log_check.hpp"
#include "hmt/submap/log/recording_summary.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hmt::submap;

/// In memory, because a target is called thousands of times a second.
const fs::path& file() {
  static const fs::path path = "/dev/shm/hmtmap-fuzz-" + std::to_string(getpid());
  return path;
}

void check(const Observation& observation) {
  if (!observation.T_odom_robot.translation.allFinite()) std::abort();
  for (const Reading& reading : observation.readings) {
    if (!reading.T_robot_sensor.translation.allFinite()) std::abort();
    for (const auto& p_sensor : reading.points_sensor)
      if (!p_sensor.allFinite()) std::abort();
  }
  for (const LandmarkReading& reading : observation.landmark_readings)
    for (const Landmark& landmark : reading.landmarks)
      if (!landmark.position_sensor.allFinite() || !landmark.covariance_sensor.allFinite())
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::ofstream(file(), std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    summarize_recording(file(), Run{});
    const auto log = open_log(file());
    while (const auto observation = log->next()) check(*observation);
    if (log->report().observations == 0 && log->report().losses.empty()) std::abort();
  } catch (const InputError&) {
  }
  fs::remove(file());
  return 0;
}
