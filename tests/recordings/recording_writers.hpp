// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "wire_writer.hpp"

namespace hmt::test {

/// One message on its way into a recording.
struct SampleMessage {
  std::string topic;
  std::string type;  ///< as ROS 1 writes it: "nav_msgs/Odometry"
  int64_t received_ns = 0;
  std::string bytes;
};

// Recordings as their public specifications say, written without any library of ROS. Messages are
// those of the format's wire: ROS 1 for bags, CDR for the others.

/// How the chunks of a recording are written.
struct ChunkOptions {
  std::string codec = "none";  ///< none; bz2 or lz4 in bags; lz4 or zstd in MCAP
  size_t messages = 100;       ///< in a chunk; 0: no chunks at all
};

/// A ROS 1 bag without an index.
std::string ros1_bag(const std::vector<SampleMessage>& messages, const ChunkOptions& options = {});
/// An MCAP file with the checksums of its chunks; `footer` false: as of a recorder that was killed.
std::string mcap_file(const std::vector<SampleMessage>& messages, const ChunkOptions& options = {},
                      bool footer = true);
/// A ROS 2 bag in SQLite.
void write_sqlite_bag(const std::filesystem::path& path,
                      const std::vector<SampleMessage>& messages);

/// The type as ROS 2 writes it: "nav_msgs/msg/Odometry".
std::string ros2_type(const std::string& type);

void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace hmt::test
