// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "carmen_reader.hpp"
#include "cloud/cloud_folder.hpp"
#include "hmt/submap/log/log_reader.hpp"
#include "recording/recording.hpp"
#include "ros/recording_reader.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

using Reader = std::unique_ptr<LogReader>;

/// A format of logs: how it is told by the path and the first decoded bytes (none of a folder), and
/// how it is opened.
struct Format {
  bool (*is)(const fs::path& path, std::string_view head);
  Reader (*open)(const fs::path& path, const LogOptions& options);
};

bool is_other_text(const fs::path& path, std::string_view /*head*/) {
  return !fs::is_directory(path);
}

Reader open_carmen(const fs::path& path, const LogOptions& /*options*/) {
  return std::make_unique<CarmenReader>(path);
}

Reader open_ros(const fs::path& path, const LogOptions& options) {
  return std::make_unique<RecordingReader>(path, options);
}

bool is_clouds(const fs::path& path, std::string_view /*head*/) {
  return CloudFolder::is(path);
}

Reader open_clouds(const fs::path& path, const LogOptions& options) {
  return std::make_unique<CloudFolder>(path, options);
}

/// The first that fits is taken.
constexpr std::array kFormats = {Format{is_recording, open_ros}, Format{is_clouds, open_clouds},
                                 Format{is_other_text, open_carmen}};

}  // namespace

std::unique_ptr<LogReader> open_log(const fs::path& path, const LogOptions& options) {
  const std::string head = fs::is_directory(path) ? "" : first_bytes(path);
  const auto format =
      std::ranges::find_if(kFormats, [&](const Format& f) { return f.is(path, head); });
  if (format == kFormats.end())
    throw InputError(path.string() + ": a folder without files of a known log format");
  return format->open(path, options);
}

}  // namespace hmt::submap
