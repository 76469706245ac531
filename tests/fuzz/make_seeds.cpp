// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Writes the seed corpora of the fuzzers by our own writers: make_seeds FOLDER makes FOLDER/log,
// FOLDER/mrclam, FOLDER/cloud and FOLDER/message. Small files: a fuzzer gets further with them.
#include <lzf.h>

#include <cstdio>

#include "hmt/submap/export/carmen_file.hpp"
#include "recordings/marker_messages.hpp"
#include "recordings/simulated_messages.hpp"

namespace hmt::test {
namespace {

namespace fs = std::filesystem;
using submap::Wire;

constexpr size_t kScans = 3;

/// Adds two rates of a gyroscope and a cloud whose points were seen between them.
std::vector<SampleMessage> with_cloud(std::vector<SampleMessage> messages, Wire wire) {
  const int64_t stamp_ns = messages.back().received_ns;
  for (const int64_t before_ns : {50'000'000, 0})
    messages.push_back({"/imu", "sensor_msgs/Imu", stamp_ns,
                        imu(WireWriter(wire), stamp_ns - before_ns, "base_link", {0.1, 0.2, 0.3})});
  messages.push_back({"/points", "sensor_msgs/PointCloud2", stamp_ns,
                      timed_cloud(WireWriter(wire), stamp_ns, "laser", {{1, 2, 3}, {4, 5, 6}},
                                  {"time", 7, {-0.01, 0}})});
  return messages;
}

/// Adds a message of each kind that has markers.
std::vector<SampleMessage> with_markers(std::vector<SampleMessage> messages, Wire wire) {
  const int64_t stamp_ns = messages.back().received_ns;
  const std::vector<SampleMarker> markers = {{3, {0.5, 0, 2}, 0.01 * Eigen::Matrix3d::Identity()},
                                             {4, {-1, 0, 3}}};
  const WireWriter out(wire);
  messages.push_back({"/tags", "apriltag_ros/AprilTagDetectionArray", stamp_ns,
                      april_tags(out, stamp_ns, "laser", markers)});
  messages.push_back({"/aruco", "ros2_aruco_interfaces/ArucoMarkers", stamp_ns,
                      aruco_markers(out, stamp_ns, "laser", markers)});
  messages.push_back({"/more_aruco", "aruco_opencv_msgs/ArucoDetection", stamp_ns,
                      aruco_detection(out, stamp_ns, "laser", markers)});
  messages.push_back({"/objects", "vision_msgs/Detection3DArray", stamp_ns,
                      detections(out, stamp_ns, "laser", markers)});
  return messages;
}

void write_logs(const fs::path& folder) {
  const submap::SimulationOptions rooms{"rooms", 1, 1};
  for (const bool clouds : {false, true}) {
    const std::string name = clouds ? "clouds" : "scans";
    auto ros1 = simulated_messages(rooms, Wire::ros1, kScans);
    auto ros2 = simulated_messages(rooms, Wire::cdr, kScans);
    if (clouds) {
      std::erase_if(ros1, [](const auto& m) { return m.topic == "/scan"; });
      std::erase_if(ros2, [](const auto& m) { return m.topic == "/scan"; });
      ros1 = with_cloud(ros1, Wire::ros1);
      ros2 = with_cloud(ros2, Wire::cdr);
    } else {
      ros1 = with_markers(ros1, Wire::ros1);
      ros2 = with_markers(ros2, Wire::cdr);
    }
    for (const char* codec : {"none", "lz4", "bz2"})
      write_file(folder / (name + codec + ".bag"), ros1_bag(ros1, {codec, 4}));
    for (const char* codec : {"none", "lz4", "zstd"})
      write_file(folder / (name + codec + ".mcap"), mcap_file(ros2, {codec, 4}));
    write_file(folder / (name + ".mcap"), mcap_file(ros2, {"none", 0}));
    write_sqlite_bag(folder / (name + ".db3"), ros2);
  }
  write_file(folder / "landmarks.txt",
             "ODOMETRY 0 1 1 0 0.5 0.04 0 0 0.04 0 0.01\nLANDMARK 1 7 2 0.5 0.4 0.1 0.3\n"
             "ODOMETRY 1 2 1 0 -0.5 0.04 0 0 0.04 0 0.01\nLANDMARK 2 7 1 0.5 0.4 0 0.3\n");
  submap::Simulation simulation(rooms);
  submap::CarmenWriter carmen(folder / "log.carmen");
  for (size_t k = 0; k < kScans; ++k) {
    const auto scan = simulation.next();
    const submap::Observation& observation = scan->observation;
    carmen.add(scan->ranges_m,
               observation.T_odom_robot * observation.readings.front().T_robot_sensor,
               observation.T_odom_robot, observation.stamp_s);
  }
  carmen.commit();
}

/// The files of an MRCLAM folder, each ended by a zero.
void write_mrclam(const fs::path& folder) {
  const std::string barcodes = "# Subject Barcode\n 1 5\n 6 63\n 7 81\n";
  const std::string odometry = "10 0.5 0.1\n11 0.5 -0.1\n12 0 0\n";
  const std::string measurements = "11 63 2 0\n11 81 1 1.5\n11.5 5 1 0\n12 63 2 0.1\n";
  write_file(folder / "folder", barcodes + '\0' + odometry + '\0' + measurements);
}

void write_clouds(const fs::path& folder) {
  const std::string head =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
      "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";
  const std::string ply =
      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  WireWriter numbers(Wire::ros1);
  for (int k = 0; k < 6; ++k) numbers.number(1.F);
  std::string packed(100, '\0');
  packed.resize(lzf_compress(numbers.bytes().data(), static_cast<unsigned>(numbers.bytes().size()),
                             packed.data(), static_cast<unsigned>(packed.size())));
  WireWriter sizes(Wire::ros1);
  sizes.number(static_cast<uint32_t>(packed.size())).number(uint32_t{24});
  write_file(folder / "ascii.pcd", head + "ascii\n1 2 3\n4 5 6\n");
  write_file(folder / "binary.pcd", head + "binary\n" + numbers.bytes());
  write_file(folder / "compressed.pcd", head + "binary_compressed\n" + sizes.bytes() + packed);
  write_file(folder / "ascii.ply", "ply\nformat ascii 1.0\n" + ply + "1 2 3\n4 5 6\n");
  write_file(folder / "binary.ply",
             "ply\nformat binary_little_endian 1.0\n" + ply + numbers.bytes());
  write_file(folder / "kitti.bin", numbers.bytes());
}

void write_messages(const fs::path& folder) {
  for (const Wire wire : {Wire::ros1, Wire::cdr}) {
    const std::string lead(1, wire == Wire::ros1 ? '\0' : '\1');
    const auto messages =
        with_markers(with_cloud(simulated_messages({"rooms", 1, 1}, wire, 1), wire), wire);
    for (size_t k = 0; k < messages.size(); ++k)
      write_file(folder / ((wire == Wire::ros1 ? "ros1_" : "cdr_") + std::to_string(k)),
                 lead + messages[k].bytes);
  }
}

}  // namespace
}  // namespace hmt::test

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("make_seeds FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  for (const char* name : {"log", "mrclam", "cloud", "message"})
    std::filesystem::create_directories(folder / name);
  hmt::test::write_logs(folder / "log");
  hmt::test::write_mrclam(folder / "mrclam");
  hmt::test::write_clouds(folder / "cloud");
  hmt::test::write_messages(folder / "message");
}
