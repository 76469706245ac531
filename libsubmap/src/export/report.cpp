// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/report.hpp"

#include <cmath>
#include <numbers>

#include "hmt/submap/export/map_summary.hpp"
#include "number_text.hpp"

namespace hmt::submap {
namespace {

std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

/// A table under a heading, filled row by row.
class HtmlTable {
 public:
  HtmlTable(const std::string& title, const std::vector<std::string>& columns)
      : html_("<h2>" + title + "</h2>\n<table><tr>") {
    for (const std::string& column : columns) html_ += "<th>" + column + "</th>";
    html_ += "</tr>\n";
  }
  void add(const std::vector<std::string>& cells) {
    html_ += "<tr>";
    for (const std::string& cell : cells) html_ += "<td>" + escape(cell) + "</td>";
    html_ += "</tr>\n";
  }
  std::string end() const { return html_ + "</table>\n"; }

 private:
  std::string html_;
};

std::string degrees(double angle_rad) {
  return fixed_text(angle_rad * 180 / std::numbers::pi, 2);
}

std::string figures_table(const HybridMap& map, const MapOrigin& origin) {
  HtmlTable table("Figures", {"", ""});
  table.add({"log", origin.log_path});
  table.add({"made by", "hmtmap " + origin.program_version});
  table.add({"observations", std::to_string(map.track.observations.size())});
  table.add({"keyframes", std::to_string(map.track.keyframes.size())});
  table.add({"constraints", std::to_string(map.constraints.size())});
  table.add({"submaps", std::to_string(map.submaps.size())});
  table.add({"links", std::to_string(map.links.size())});
  table.add({"information loss of the partition (Eq. 22)", fixed_text(map.information_loss, 4)});
  if (!map.landmarks.empty()) {
    table.add({"landmarks", std::to_string(map.landmarks.size())});
    table.add({"sightings of landmarks", std::to_string(map.sightings.size())});
    table.add({"information loss of the landmarks (Eq. 22)",
               fixed_text(map.landmark_information_loss, 4)});
  }
  table.add({"chi2 of the submap graph, first and last",
             fixed_text(map.chi2_initial, 3) + ", " + fixed_text(map.chi2, 3)});
  table.add({"chi2 of all constraints by submaps, after joint refinement, flat",
             fixed_text(map.division.chi2_hybrid, 3) + ", " +
                 fixed_text(map.division.chi2_refined, 3) + ", " +
                 fixed_text(map.division.chi2_flat, 3)});
  for (const auto& [reason, count] : map.track.log.notes)
    table.add({"log: " + reason, std::to_string(count)});
  for (const auto& [reason, count] : map.track.log.losses)
    table.add({"log, left out: " + reason, std::to_string(count)});
  return table.end();
}

std::string submap_table(const HybridMap& map) {
  HtmlTable table("Submaps",
                  {"id", "keyframes", "observations", "first stamp [s]", "last stamp [s]", "x [m]",
                   "y [m]", "z [m]", "heading [deg]", "extent [m]", "chi2", "dof"});
  for (const SubmapSummary& s : summarize_submaps(map)) {
    const auto id = static_cast<size_t>(s.id);
    const Pose& pose = map.T_world_submap[id];
    table.add({std::to_string(s.id), std::to_string(s.keyframes), std::to_string(s.observations),
               fixed_text(s.first_stamp_s, 2), fixed_text(s.last_stamp_s, 2),
               fixed_text(pose.translation.x(), 3), fixed_text(pose.translation.y(), 3),
               fixed_text(pose.translation.z(), 3), degrees(pose.yaw_rad()),
               fixed_text(s.extent_m.x(), 1) + " x " + fixed_text(s.extent_m.y(), 1) + " x " +
                   fixed_text(s.extent_m.z(), 1),
               fixed_text(map.submaps[id].chi2, 2),
               std::to_string(map.submaps[id].degrees_of_freedom)});
  }
  return table.end();
}

std::string link_table(const HybridMap& map) {
  HtmlTable table("Links", {"a", "b", "x [m]", "y [m]", "z [m]", "heading [deg]", "sigma x, y [m]",
                            "sigma heading [deg]", "odometry, registrations, loops", "Ncut",
                            "information loss"});
  for (const Link& link : map.links) {
    const EvidenceCount n = count_evidence(map, link);
    const auto sigma = [&](int k) { return std::sqrt(std::max(0.0, link.covariance(k, k))); };
    table.add({std::to_string(link.a), std::to_string(link.b),
               fixed_text(link.T_a_b.translation.x(), 3), fixed_text(link.T_a_b.translation.y(), 3),
               fixed_text(link.T_a_b.translation.z(), 3), degrees(link.T_a_b.yaw_rad()),
               fixed_text(sigma(0), 4) + ", " + fixed_text(sigma(1), 4), degrees(sigma(5)),
               std::to_string(n.odometry) + ", " + std::to_string(n.registration) + ", " +
                   std::to_string(n.loop),
               fixed_text(link.ncut, 4), fixed_text(link.information_loss, 4)});
  }
  return table.end();
}

std::string loop_tables(const HybridMap& map) {
  HtmlTable counts("Loop-closure candidates", {"verdict", "count"});
  for (const auto& [verdict, count] : count_verdicts(map))
    counts.add({verdict, std::to_string(count)});
  HtmlTable accepted("Accepted loop closures", {"keyframes", "submaps", "score", "second score",
                                                "rmse [m]", "Mahalanobis", "chi2", "reason"});
  for (const LoopCandidate& loop : map.loops)
    if (is_closure(loop.verdict))
      accepted.add({std::to_string(loop.a) + ", " + std::to_string(loop.b),
                    std::to_string(loop.submap_a) + ", " + std::to_string(loop.submap_b),
                    fixed_text(loop.score, 3), fixed_text(loop.second_score, 3),
                    fixed_text(loop.rmse_m, 4), fixed_text(loop.mahalanobis, 2),
                    fixed_text(loop.chi2_rise, 2), loop.reason});
  return counts.end() + accepted.end();
}

}  // namespace

std::string report_html(const HybridMap& map, const MapOrigin& origin,
                        const OccupancyImage* walls) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Hybrid map</title>\n"
      "<style>body{font-family:sans-serif;margin:2em}table{border-collapse:collapse}"
      "td,th{border:1px solid #ccc;padding:2px 8px;text-align:left;font-size:85%}"
      "svg{width:100%;max-width:1200px;border:1px solid #ccc}pre{font-size:85%}</style>"
      "</head><body>\n<h1>Hybrid map</h1>\n";
  html += map_svg(map, walls);
  html +=
      "<p>Colors and numbers: submaps; dashed: links; gray: occupied cells; triangles: "
      "landmarks.</p>\n";
  html += figures_table(map, origin) + submap_table(map) + link_table(map) + loop_tables(map);
  html += "<h2>Options</h2>\n<pre>" + escape(origin.options_json) + "</pre>\n";
  return html + "</body></html>\n";
}

}  // namespace hmt::submap
