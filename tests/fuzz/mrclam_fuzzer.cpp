// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Any bytes, cut at zeros into the files of an MRCLAM folder, are either read to their end, with
// finite numbers in every observation, or refused with an InputError.
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "hmt/submap/log/log_reader.hpp"

namespace {

namespace fs = std::filesystem;
using namespace hmt::submap;

/// In memory, because a target is called thousands of times a second.
const fs::path& folder() {
  static const fs::path path = "/dev/shm/hmtmap-fuzz-" + std::to_string(getpid());
  return path;
}

void check(const Observation& observation) {
  if (!observation.T_odom_robot.translation.allFinite()) std::abort();
  for (const LandmarkReading& reading : observation.landmark_readings)
    for (const Landmark& landmark : reading.landmarks)
      if (!landmark.position_sensor.allFinite()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  fs::create_directory(folder());
  const uint8_t* const end = data + size;
  for (const char* name : {"Barcodes.dat", "Robot1_Odometry.dat", "Robot1_Measurement.dat"}) {
    const uint8_t* const cut = std::find(data, end, 0);
    std::ofstream(folder() / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), cut - data);
    data = cut == end ? end : cut + 1;
  }
  try {
    const auto log = open_log(folder());
    while (const auto observation = log->next()) check(*observation);
  } catch (const InputError&) {
  }
  return 0;
}
