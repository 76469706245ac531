// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/topology.hpp"

#include <nlohmann/json.hpp>

#include "hmt/graph/g2o_file.hpp"
#include "hmt/submap/export/map_summary.hpp"
#include "hmt/submap/link/condense_links.hpp"
#include "number_text.hpp"

namespace hmt::submap {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Pose& pose) {
  Json numbers = Json::array();
  for (const double value : pose.translation) numbers.push_back(value);
  for (const double value : pose.rotation.coeffs()) numbers.push_back(value);
  return numbers;
}

Json to_json(const Matrix6d& matrix) {
  Json numbers = Json::array();
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) numbers.push_back(matrix(row, column));
  return numbers;
}

Json submap_json(const HybridMap& map, const SubmapSummary& submap) {
  const auto id = static_cast<size_t>(submap.id);
  return {{"id", submap.id},
          {"keyframes", submap.keyframes},
          {"observations", submap.observations},
          {"first_stamp_s", submap.first_stamp_s},
          {"last_stamp_s", submap.last_stamp_s},
          {"T_world_submap", to_json(map.T_world_submap[id])},
          {"covariance", to_json(map.covariance_world_submap[id])}};
}

Json link_json(const HybridMap& map, const Link& link) {
  const EvidenceCount evidence = count_evidence(map, link);
  return {{"a", link.a},
          {"b", link.b},
          {"T_a_b", to_json(link.T_a_b)},
          {"covariance", to_json(link.covariance)},
          {"evidence",
           {{"odometry", evidence.odometry},
            {"registration", evidence.registration},
            {"loop", evidence.loop}}},
          {"ncut", link.ncut},
          {"information_loss", link.information_loss}};
}

std::string data(const char* key, const std::string& value) {
  return "<data key=\"" + std::string(key) + "\">" + value + "</data>";
}

}  // namespace

std::string topology_json(const HybridMap& map) {
  Json json;
  json["space"] = map.track.space == Space::se2 ? "se2" : "se3";
  json["information_loss"] = map.information_loss;
  json["submaps"] = Json::array();
  for (const SubmapSummary& submap : summarize_submaps(map))
    json["submaps"].push_back(submap_json(map, submap));
  json["links"] = Json::array();
  for (const Link& link : map.links) json["links"].push_back(link_json(map, link));
  return json.dump(1) + "\n";
}

std::string topology_graphml(const HybridMap& map) {
  std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n";
  for (const char* name : {"keyframes", "observations"})
    xml += std::string("<key id=\"") + name + "\" for=\"node\" attr.name=\"" + name +
           "\" attr.type=\"long\"/>\n";
  for (const char* name : {"x", "y", "z", "yaw"})
    xml += std::string("<key id=\"") + name + "\" for=\"node\" attr.name=\"" + name +
           "\" attr.type=\"double\"/>\n";
  for (const char* name : {"dx", "dy", "dz", "dyaw", "ncut", "information_loss"})
    xml += std::string("<key id=\"") + name + "\" for=\"edge\" attr.name=\"" + name +
           "\" attr.type=\"double\"/>\n";
  xml += "<graph id=\"topology\" edgedefault=\"undirected\">\n";
  for (const SubmapSummary& submap : summarize_submaps(map)) {
    const Pose& pose = map.T_world_submap[static_cast<size_t>(submap.id)];
    xml += "<node id=\"s" + std::to_string(submap.id) + "\">" +
           data("keyframes", std::to_string(submap.keyframes)) +
           data("observations", std::to_string(submap.observations)) +
           data("x", number_text(pose.translation.x())) +
           data("y", number_text(pose.translation.y())) +
           data("z", number_text(pose.translation.z())) + data("yaw", number_text(pose.yaw_rad())) +
           "</node>\n";
  }
  for (const Link& link : map.links) {
    const Pose& step = link.T_a_b;
    xml += "<edge source=\"s" + std::to_string(link.a) + "\" target=\"s" + std::to_string(link.b) +
           "\">" + data("dx", number_text(step.translation.x())) +
           data("dy", number_text(step.translation.y())) +
           data("dz", number_text(step.translation.z())) +
           data("dyaw", number_text(step.yaw_rad())) + data("ncut", number_text(link.ncut)) +
           data("information_loss", number_text(link.information_loss)) + "</edge>\n";
  }
  return xml + "</graph>\n</graphml>\n";
}

std::string topology_dot(const HybridMap& map) {
  std::string dot = "graph topology {\n  node [shape=circle];\n";
  for (const SubmapSummary& submap : summarize_submaps(map)) {
    const Eigen::Vector3d& at = map.T_world_submap[static_cast<size_t>(submap.id)].translation;
    const std::string id = std::to_string(submap.id);
    dot += "  s" + id + " [label=\"" + id + "\\n" + std::to_string(submap.keyframes) +
           " keyframes\", pos=\"" + fixed_text(at.x(), 3) + "," + fixed_text(at.y(), 3) + "!\"];\n";
  }
  for (const Link& link : map.links)
    dot += "  s" + std::to_string(link.a) + " -- s" + std::to_string(link.b) + " [label=\"" +
           fixed_text(link.ncut, 3) + "\"" +
           (count_evidence(map, link).loop > 0 ? ", color=red" : "") + "];\n";
  return dot + "}\n";
}

std::string partition_csv(const HybridMap& map) {
  std::string csv = "keyframe,stamp_s,submap\n";
  for (const Keyframe& keyframe : map.track.keyframes)
    csv += std::to_string(keyframe.id) + "," + number_text(keyframe.stamp_s) + "," +
           std::to_string(map.submap_of_keyframe[static_cast<size_t>(keyframe.id)]) + "\n";
  return csv;
}

std::string loops_jsonl(const HybridMap& map) {
  std::string lines;
  for (size_t k = 0; k < map.loops.size(); ++k) {
    const LoopCandidate& loop = map.loops[k];
    const Json json = {{"id", k},
                       {"a", loop.a},
                       {"b", loop.b},
                       {"submap_a", loop.submap_a},
                       {"submap_b", loop.submap_b},
                       {"predicted_distance_m", loop.predicted_distance_m},
                       {"predicted_sigma_m", loop.predicted_sigma_m},
                       {"verdict", verdict_name(loop.verdict)},
                       {"reason", loop.reason},
                       {"score", loop.score},
                       {"second_score", loop.second_score},
                       {"inlier_fraction", loop.inlier_fraction},
                       {"rmse_m", loop.rmse_m},
                       {"free_space_conflict", loop.free_space_conflict},
                       {"mahalanobis", loop.mahalanobis},
                       {"chi2_rise", loop.chi2_rise},
                       {"T_a_b", to_json(loop.T_a_b)},
                       {"information", to_json(loop.information)}};
    lines += json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  return lines;
}

std::string pose_graph_g2o(const HybridMap& map) {
  graph::G2oFile file;
  file.graph = submap_graph(map.track.space, map.T_world_submap, map.links);
  for (size_t k = 0; k < file.graph.poses.size(); ++k) file.ids.push_back(static_cast<int64_t>(k));
  return graph::format_g2o(file);
}

}  // namespace hmt::submap
