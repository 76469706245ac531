// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_file_impl.hpp"

namespace hmt::submap {

size_t size_in_memory(const Observation& observation) {
  size_t bytes = sizeof(Observation);
  for (const Reading& reading : observation.readings)
    bytes += sizeof(Reading) + sizeof(Eigen::Vector3f) *
                                   (reading.points_sensor.size() + reading.misses_sensor.size());
  for (const LandmarkReading& reading : observation.landmark_readings) {
    bytes += sizeof(LandmarkReading);
    for (const Landmark& landmark : reading.landmarks)
      bytes += sizeof(Landmark) + sizeof(float) * landmark.descriptor.size();
  }
  return bytes;
}

}  // namespace hmt::submap
