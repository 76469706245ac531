// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../ros/messages.hpp"
#include "hmt/submap/log/log_reader.hpp"

namespace hmt::submap {

/// A topic of a recording.
struct RecordedTopic {
  std::string name;
  std::string type;  ///< as it was recorded: "sensor_msgs/LaserScan", "sensor_msgs/msg/LaserScan"
  /// Of its messages; nothing where it is neither ROS 1 serialization nor CDR.
  std::optional<Wire> wire;

  MessageKind kind() const { return wire ? message_kind(type) : MessageKind::other; }
  bool operator==(const RecordedTopic&) const = default;
};

/// A message as it was recorded.
struct RecordedMessage {
  size_t topic = 0;         ///< index into Recording::topics
  int64_t received_ns = 0;  ///< by the clock of the recorder
  std::string_view data;    ///< valid until the next call of Recording::next
};

/// A file of messages on topics: one forward pass in the order of the file, without its index.
class Recording {
 public:
  virtual ~Recording() = default;
  /// Nothing at the end, or where the file cannot be read any further; report() tells which.
  virtual std::optional<RecordedMessage> next() = 0;
  /// The topics met so far; their order never changes.
  virtual const std::vector<RecordedTopic>& topics() const = 0;
  /// Notes and losses so far.
  virtual const LogReport& report() const = 0;
  virtual int64_t bytes_read() const = 0;
};

/// Whether a file that begins with `head`, or a folder, is a recording that open_recording reads or
/// refuses with the reason.
bool is_recording(const std::filesystem::path& path, std::string_view head);

/// Opens a ROS 1 bag, an MCAP file, a ROS 2 sqlite3 bag, or a folder of such files, which are read
/// one after the other in natural order, and after them `further_parts`. Throws InputError with the
/// reason for what is none.
std::unique_ptr<Recording> open_recording(
    const std::filesystem::path& path,
    const std::vector<std::filesystem::path>& further_parts = {});

}  // namespace hmt::submap
