// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "map_info.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include "console.hpp"
#include "hmt/submap/export/map_summary.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::apps {
namespace {

using Json = nlohmann::ordered_json;

Json submaps_json(const submap::HybridMap& map) {
  Json submaps = Json::array();
  for (const submap::SubmapSummary& s : submap::summarize_submaps(map))
    submaps.push_back({{"id", s.id},
                       {"keyframes", s.keyframes},
                       {"observations", s.observations},
                       {"first_stamp_s", s.first_stamp_s},
                       {"last_stamp_s", s.last_stamp_s},
                       {"extent_m", {s.extent_m.x(), s.extent_m.y(), s.extent_m.z()}}});
  return submaps;
}

Json links_json(const submap::HybridMap& map) {
  Json links = Json::array();
  for (const submap::Link& link : map.links) {
    const submap::EvidenceCount n = submap::count_evidence(map, link);
    links.push_back({{"a", link.a},
                     {"b", link.b},
                     {"odometry", n.odometry},
                     {"registration", n.registration},
                     {"loop", n.loop},
                     {"ncut", link.ncut},
                     {"information_loss", link.information_loss}});
  }
  return links;
}

void add_map(const submap::HybridMap& map, Json& json) {
  json["space"] = map.track.space == submap::Space::se2 ? "se2" : "se3";
  json["observations"] = map.track.observations.size();
  json["keyframes"] = map.track.keyframes.size();
  json["constraints"] = map.constraints.size();
  json["overlap_arcs"] = map.overlap.size();
  json["landmarks"] = map.landmarks.size();
  json["sightings"] = map.sightings.size();
  json["information_loss"] = map.information_loss;
  json["landmark_information_loss"] = map.landmark_information_loss;
  json["chi2_initial"] = map.chi2_initial;
  json["chi2"] = map.chi2;
  json["chi2_hybrid"] = map.division.chi2_hybrid;
  json["chi2_refined"] = map.division.chi2_refined;
  json["chi2_flat"] = map.division.chi2_flat;
  json["loop_candidates"] = submap::count_verdicts(map);
  json["submaps"] = submaps_json(map);
  json["links"] = links_json(map);
}

std::string map_text(const submap::HybridMap& map) {
  std::string text = fmt::format(
      "observations       {}\nkeyframes          {}\nconstraints        {}\nsubmaps            {}\n"
      "links              {}\ninformation loss   {:.4f}\n"
      "chi2               {:.3f} by submaps, {:.3f} refined together, {:.3f} flat\n",
      map.track.observations.size(), map.track.keyframes.size(), map.constraints.size(),
      map.submaps.size(), map.links.size(), map.information_loss, map.division.chi2_hybrid,
      map.division.chi2_refined, map.division.chi2_flat);
  if (!map.landmarks.empty())
    text += fmt::format("landmarks          {}\nsightings          {}\n  their loss       {:.4f}\n",
                        map.landmarks.size(), map.sightings.size(), map.landmark_information_loss);
  for (const auto& [verdict, count] : submap::count_verdicts(map))
    text += fmt::format("loops {:<13}{}\n", verdict, count);
  text += "submap  keyframes  observations  first stamp      extent\n";
  for (const submap::SubmapSummary& s : submap::summarize_submaps(map))
    text += fmt::format("{:>6}  {:>9}  {:>12}  {:<15.2f}  {:.1f} x {:.1f} x {:.1f} m\n", s.id,
                        s.keyframes, s.observations, s.first_stamp_s, s.extent_m.x(),
                        s.extent_m.y(), s.extent_m.z());
  text += "link          odometry  registrations  loops  Ncut    information loss\n";
  for (const submap::Link& link : map.links) {
    const submap::EvidenceCount n = submap::count_evidence(map, link);
    text += fmt::format("{:>4} - {:<5}  {:>8}  {:>13}  {:>5}  {:.4f}  {:.4f}\n", link.a, link.b,
                        n.odometry, n.registration, n.loop, link.ncut, link.information_loss);
  }
  return text;
}

}  // namespace

int map_info(const std::string& path, const Globals& globals) {
  const submap::MapFile file = submap::MapFile::open(path);
  const submap::MapOrigin origin = file.origin();
  const bool complete = file.complete();
  Json json = {{"map", path},
               {"log", origin.log_path},
               {"program_version", origin.program_version},
               {"complete", complete},
               {"stages", file.stages()}};
  std::string text = fmt::format("{}: {}, made from {} by hmtmap {}\nstages             {}\n", path,
                                 complete ? "map" : "unfinished map", origin.log_path,
                                 origin.program_version, fmt::join(file.stages(), ", "));
  if (complete) {
    const submap::HybridMap map = file.load_map();
    add_map(map, json);
    text += map_text(map);
  } else {
    text += "Run the same hmtmap map command again to finish it.\n";
  }
  const Json options = Json::parse(origin.options_json, nullptr, false);
  json["options"] = options.is_discarded() ? Json(nullptr) : options;
  text += fmt::format("options            {}\n", origin.options_json);
  print_result(globals, json, text);
  return kDone;
}

}  // namespace hmt::apps
