// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>
#include <string>

#include "hmt/submap/pipeline.hpp"

namespace hmt::submap {

OctreeOptions octree_options(const Options& options, Space space) {
  return {options.octree_resolution_m.value_or(space == Space::se2 ? 0.05 : 0.2)};
}

std::string to_json(const Options& options) {
  nlohmann::ordered_json json;
  json["log"] = {{"scan_topics", options.log.scan_topics},
                 {"landmark_topics", options.log.landmark_topics},
                 {"odometry_topic", options.log.odometry_topic},
                 {"odometry_file", options.log.odometry_file}};
  if (options.log.robot) json["log"]["robot"] = *options.log.robot;
  json["track"] = {{"keyframe_distance_m", options.track.keyframe_distance_m},
                   {"keyframe_angle_rad", options.track.keyframe_angle_rad}};
  json["overlap"] = {{"max_mahalanobis", options.overlap.max_mahalanobis},
                     {"min_overlap", options.overlap.min_overlap}};
  json["local"] = {{"min_overlap", options.local.min_overlap}};
  json["sections"] = {{"keyframes", options.sections.keyframes}};
  json["partition"] = {{"tau", options.partition.tau},
                       {"min_keyframes", options.partition.min_keyframes},
                       {"sequential", options.partition.sequential},
                       {"max_window", options.partition.max_window}};
  json["octree"] = nlohmann::ordered_json::object();
  if (options.octree_resolution_m) json["octree"]["resolution_m"] = *options.octree_resolution_m;
  return json.dump();
}

Options options_from_json(const std::string& text) {
  Options options;
  try {
    const auto json = nlohmann::json::parse(text);
    const auto get = [&json](const char* stage, const char* name, auto& value) {
      json.at(stage).at(name).get_to(value);
    };
    get("log", "scan_topics", options.log.scan_topics);
    get("log", "landmark_topics", options.log.landmark_topics);
    get("log", "odometry_topic", options.log.odometry_topic);
    get("log", "odometry_file", options.log.odometry_file);
    if (json.at("log").contains("robot")) options.log.robot = json["log"]["robot"].get<int>();
    get("track", "keyframe_distance_m", options.track.keyframe_distance_m);
    get("track", "keyframe_angle_rad", options.track.keyframe_angle_rad);
    get("overlap", "max_mahalanobis", options.overlap.max_mahalanobis);
    get("overlap", "min_overlap", options.overlap.min_overlap);
    get("local", "min_overlap", options.local.min_overlap);
    get("sections", "keyframes", options.sections.keyframes);
    get("partition", "tau", options.partition.tau);
    get("partition", "min_keyframes", options.partition.min_keyframes);
    get("partition", "sequential", options.partition.sequential);
    get("partition", "max_window", options.partition.max_window);
    if (json.at("octree").contains("resolution_m"))
      options.octree_resolution_m = json["octree"]["resolution_m"].get<double>();
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("the options of the map cannot be read: ") + error.what());
  }
  return options;
}

}  // namespace hmt::submap
