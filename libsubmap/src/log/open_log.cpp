// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include "carmen_reader.hpp"
#include "cloud/cloud_folder.hpp"
#include "hmt/submap/log/log_reader.hpp"
#include "mrclam_reader.hpp"
#include "parts_reader.hpp"
#include "recording/recording.hpp"
#include "relations_reader.hpp"
#include "ros/recording_reader.hpp"
#include "text_fields.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

using Reader = std::unique_ptr<LogReader>;

/// A format of logs: how it is told by the path and the first decoded bytes (none of a folder), and
/// how it is opened.
struct Format {
  bool (*is)(const fs::path& path, std::string_view head);
  Reader (*open)(const fs::path& path, const LogOptions& options);
  bool can_be_split = false;
};

bool is_other_text(const fs::path& path, std::string_view /*head*/) {
  return !fs::is_directory(path);
}

Reader open_carmen(const fs::path& path, const LogOptions& options) {
  if (options.further_parts.empty()) return std::make_unique<CarmenReader>(path);
  std::vector<fs::path> parts = {path};
  parts.insert(parts.end(), options.further_parts.begin(), options.further_parts.end());
  return std::make_unique<PartsReader>(
      std::move(parts), [](const fs::path& part) { return std::make_unique<CarmenReader>(part); });
}

Reader open_ros(const fs::path& path, const LogOptions& options) {
  return std::make_unique<RecordingReader>(path, options);
}

/// First word of the first line that is no comment, also of a compressed file; empty of a folder.
std::string first_word(const fs::path& path) {
  if (fs::is_directory(path)) return {};
  LineSource lines(path);
  while (const auto line = lines.next()) {
    std::string_view fields = without_comment(*line);
    const std::string_view word = take_field(fields);
    if (!word.empty()) return std::string(word);
  }
  return {};
}

bool is_relations(const fs::path& path, std::string_view /*head*/) {
  const std::string word = first_word(path);
  return word == "ODOMETRY" || word == "LANDMARK";
}

bool is_pose_graph(const fs::path& path, std::string_view /*head*/) {
  const std::string word = first_word(path);
  return word.starts_with("VERTEX") || word.starts_with("EDGE") || word == "FIX";
}

Reader refuse_pose_graph(const fs::path& path, const LogOptions& /*options*/) {
  throw InputError(path.string() +
                   ": a pose graph, which holds no observations to build a map from; `hmtmap "
                   "optimize GRAPH.g2o -o OUT.g2o --method submaps` cuts it into submaps and "
                   "optimizes it by them");
}

Reader open_relations(const fs::path& path, const LogOptions& /*options*/) {
  return std::make_unique<RelationsReader>(path);
}

bool is_mrclam(const fs::path& path, std::string_view /*head*/) {
  return fs::is_directory(path) && !mrclam_robots(path).empty();
}

Reader open_mrclam(const fs::path& folder, const LogOptions& options) {
  const std::vector<int> robots = mrclam_robots(folder);
  std::string names;
  for (const int robot : robots) names += (names.empty() ? "" : ", ") + std::to_string(robot);
  if (!options.robot && robots.size() > 1)
    throw InputError(folder.string() + ": logs of the robots " + names +
                     "; choose one with --robot N");
  const int robot = options.robot.value_or(robots.front());
  if (std::ranges::find(robots, robot) == robots.end())
    throw InputError(folder.string() + ": no robot " + std::to_string(robot) + "; there is " +
                     names);
  return std::make_unique<MrclamReader>(folder, robot);
}

bool is_clouds(const fs::path& path, std::string_view /*head*/) {
  return CloudFolder::is(path);
}

Reader open_clouds(const fs::path& path, const LogOptions& options) {
  return std::make_unique<CloudFolder>(path, options);
}

/// The first that fits is taken.
constexpr std::array kFormats = {
    Format{is_recording, open_ros, true},     Format{is_mrclam, open_mrclam},
    Format{is_clouds, open_clouds},           Format{is_relations, open_relations},
    Format{is_pose_graph, refuse_pose_graph}, Format{is_other_text, open_carmen, true}};

/// Null for a folder of no known format.
const Format* format_of(const fs::path& path) {
  const std::string head = fs::is_directory(path) ? "" : first_bytes(path);
  const auto format =
      std::ranges::find_if(kFormats, [&](const Format& f) { return f.is(path, head); });
  return format == kFormats.end() ? nullptr : &*format;
}

/// What cannot be read is said before anything is.
void check_parts(const fs::path& path, const Format* format, const LogOptions& options) {
  for (const fs::path& part : options.further_parts) {
    if (!format->can_be_split)
      throw InputError(path.string() + ": goes on with " + part.string() +
                       ", but only CARMEN logs and recordings of ROS can be given in parts");
    if (format_of(part) != format)
      throw InputError(part.string() + ": not of the format of " + path.string() +
                       ", the first part");
  }
}

}  // namespace

std::unique_ptr<LogReader> open_log(const fs::path& path, const LogOptions& options) {
  const Format* format = format_of(path);
  if (format == nullptr)
    throw InputError(path.string() +
                     ": a folder without files of a known log format; it must hold bags, clouds "
                     "(pcd, ply, bin) or the files of MRCLAM itself, not in folders below");
  if (options.robot && format->open != open_mrclam)
    throw InputError(path.string() + ": holds one robot; --robot is for folders of several");
  check_parts(path, format, options);
  return format->open(path, options);
}

}  // namespace hmt::submap
