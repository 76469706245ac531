// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/submap/decide_loops.hpp"
#include "hmt/submap/export/map_summary.hpp"
#include "hmt/submap/export/topology.hpp"

namespace hmt::apps {
namespace {

struct Arguments {
  std::string map;
  submap::LoopDecisions decisions;
  bool closures_only = false;
};

/// The same objects as in loops.jsonl.
nlohmann::ordered_json to_json(const submap::HybridMap& map) {
  nlohmann::ordered_json loops = nlohmann::ordered_json::array();
  std::istringstream lines(submap::loops_jsonl(map));
  for (std::string line; std::getline(lines, line);)
    loops.push_back(nlohmann::ordered_json::parse(line));
  return loops;
}

std::string to_text(const submap::HybridMap& map, bool closures_only) {
  std::string text =
      fmt::format("{:>5} {:>6} {:>6} {:>9} {:>9} {:>6} {:>6} {:>6} {:>6} {:>9}  {}\n", "id", "a",
                  "b", "distance", "+- m", "score", "second", "free", "sigma", "chi2", "verdict");
  for (size_t id = 0; id < map.loops.size(); ++id) {
    const submap::LoopCandidate& c = map.loops[id];
    if (closures_only && !submap::is_closure(c.verdict)) continue;
    text += fmt::format(
        "{:>5} {:>6} {:>6} {:>9.2f} {:>9.2f} {:>6.2f} {:>6.2f} {:>6.2f} {:>6.1f} {:>9.3g}  {}: "
        "{}\n",
        id, c.a, c.b, c.predicted_distance_m, c.predicted_sigma_m, c.score, c.second_score,
        c.free_space_conflict, c.mahalanobis, c.chi2_rise, submap::verdict_name(c.verdict),
        c.reason);
  }
  for (const auto& [verdict, count] : submap::count_verdicts(map))
    if (count > 0) text += fmt::format("{:<13}{}\n", verdict, count);
  return text;
}

int list_or_decide(const Arguments& arguments, const Globals& globals) {
  const bool decides = !arguments.decisions.accept.empty() || !arguments.decisions.reject.empty();
  const submap::HybridMap map =
      decides ? submap::decide_loops(arguments.map, arguments.decisions, make_run(globals))
                    .file.load_map()
              : submap::MapFile::open(arguments.map).load_map();
  nlohmann::ordered_json json;
  json["map"] = arguments.map;
  json["verdicts"] = submap::count_verdicts(map);
  json["loops"] = to_json(map);
  print_result(globals, json, to_text(map, arguments.closures_only));
  return kDone;
}

}  // namespace

Action add_loops(CLI::App& command) {
  const auto arguments = std::make_shared<Arguments>();  // shared by the parser and the action
  command.add_option("MAP", arguments->map, "Map file made by hmtmap map")->required();
  command
      .add_option("--accept", arguments->decisions.accept,
                  "Ids of candidates that are right whatever speaks against them; optimizes again")
      ->delimiter(',');
  command
      .add_option("--reject", arguments->decisions.reject,
                  "Ids of candidates that are wrong; optimizes again without them")
      ->delimiter(',');
  command.add_flag("--closures", arguments->closures_only,
                   "Show only those that hold the map together (text output)");
  command.footer(
      "a, b: keyframes. distance +- m: how far apart the map predicted them, and how well it knew "
      "it,\nwhen they were compared. score, second: shares of what b saw that meet a's "
      "surroundings at the best\nand at the next best place. free: share that lies where the other "
      "looked through. sigma: distance\nof the match from the prediction. chi2: by how much the "
      "candidate raises chi2 of the map, taken or\nnot. Decisions are recorded in the map file; "
      "ids stay.");
  return [arguments](const Globals& globals) { return list_or_decide(*arguments, globals); };
}

}  // namespace hmt::apps
