// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_file_impl.hpp"

namespace hmt::submap {
namespace {

// Holds a whole log of a few thousand planar scans, or some dozen large clouds.
constexpr size_t kCacheBytes = size_t{64} << 20;

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

}  // namespace

std::shared_ptr<const Observation> ObservationCache::find(int64_t index) {
  const std::lock_guard lock(mutex_);
  const auto found = by_index_.find(index);
  if (found == by_index_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return entries_.front().observation;
}

void ObservationCache::insert(std::shared_ptr<const Observation> observation) {
  const std::lock_guard lock(mutex_);
  // Two threads may have read the same one.
  if (by_index_.contains(observation->index)) return;
  const size_t bytes = size_in_memory(*observation);
  entries_.push_front({std::move(observation), bytes});
  by_index_[entries_.front().observation->index] = entries_.begin();
  bytes_ += bytes;
  while (bytes_ > kCacheBytes && entries_.size() > 1) {
    bytes_ -= entries_.back().bytes;
    by_index_.erase(entries_.back().observation->index);
    entries_.pop_back();
  }
}

}  // namespace hmt::submap
