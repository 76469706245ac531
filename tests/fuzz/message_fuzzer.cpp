// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Any bytes, behind one that tells the wire, are either decoded as each kind of message or refused.
#include <cstdint>
#include <cstdlib>

#include "log/ros/markers_message.hpp"

namespace {

using namespace hmt::submap;

template <typename Decode>
void attempt(const Decode& decode) {
  try {
    decode();
  } catch (const MessageError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const Wire wire = data[0] % 2 == 0 ? Wire::ros1 : Wire::cdr;
  const std::string_view message(reinterpret_cast<const char*>(data) + 1, size - 1);
  for (const MessageKind kind : {MessageKind::laser_scan, MessageKind::multi_echo_scan})
    attempt([&] { read_laser_scan({message, wire}, kind); });
  for (const MessageKind kind : {MessageKind::april_tags, MessageKind::aruco_markers,
                                 MessageKind::aruco_detection, MessageKind::detections})
    attempt([&] {
      for (const Marker& marker : read_markers({message, wire}, kind).markers)
        if (!marker.position.allFinite() || marker.name < 0 ||
            (marker.covariance.diagonal().minCoeff() <= 0 && !marker.covariance.isZero(0)))
          std::abort();
    });
  attempt([&] { read_odometry({message, wire}); });
  attempt([&] { read_transforms({message, wire}); });
  attempt([&] { read_imu({message, wire}); });
  attempt([&] {
    for (const auto& p : read_cloud({message, wire}).cloud.points)
      if (!p.allFinite()) std::abort();
  });
  return 0;
}
