// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <numbers>
#include <vector>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/submap/pipeline.hpp"
#include "log_options.hpp"

namespace hmt::apps {
namespace {

struct MapArguments {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path map;
  bool force = false;
  double keyframe_angle_deg = 0;
  submap::Options options;
};

double seconds(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

nlohmann::ordered_json summary(const submap::HybridMap& map) {
  const auto accepted = [](const submap::LoopCandidate& c) {
    return submap::is_closure(c.verdict);
  };
  return {{"observations", map.track.observations.size()},
          {"keyframes", map.track.keyframes.size()},
          {"submaps", map.submaps.size()},
          {"links", map.links.size()},
          {"loop_closures", std::count_if(map.loops.begin(), map.loops.end(), accepted)},
          {"landmarks", map.landmarks.size()},
          {"sightings", map.sightings.size()},
          {"information_loss", map.information_loss},
          {"landmark_information_loss", map.landmark_information_loss},
          {"chi2_hybrid", map.division.chi2_hybrid},
          {"chi2_refined", map.division.chi2_refined},
          {"chi2_flat", map.division.chi2_flat}};
}

/// "round2.loops" is one of the stages "loops", "octomap7" one of "octomap".
std::string kind_of_stage(const std::string& stage) {
  std::string kind = stage.substr(stage.find('.') == std::string::npos ? 0 : stage.find('.') + 1);
  kind.erase(kind.find_last_not_of("0123456789") + 1);
  return kind;
}

/// Seconds of each kind of stage, all rounds together, in the order in which they first ran.
std::vector<submap::StageTime> sum_by_kind(const std::vector<submap::StageTime>& times) {
  std::vector<submap::StageTime> sums;
  for (const submap::StageTime& time : times) {
    const std::string kind = kind_of_stage(time.stage);
    const auto same =
        std::find_if(sums.begin(), sums.end(), [&](const auto& sum) { return sum.stage == kind; });
    if (same == sums.end())
      sums.push_back({kind, time.seconds});
    else
      same->seconds += time.seconds;
  }
  return sums;
}

std::string as_text(const nlohmann::ordered_json& object,
                    const std::vector<submap::StageTime>& times, const submap::HybridMap& built,
                    const std::filesystem::path& map) {
  std::string text = map.string() + "\n";
  for (const auto& [name, value] : object.items())
    if (!value.is_object()) text += fmt::format("  {:<18} {}\n", name, value.dump());
  const auto observations = static_cast<double>(built.track.observations.size());
  for (const submap::StageTime& time : sum_by_kind(times))
    text += fmt::format("  {:<18} {:.2f} s, {:.0f} observations/s\n", "stage " + time.stage,
                        time.seconds, observations / std::max(time.seconds, 1e-3));
  return text + "next: hmtmap export " + map.string() + " -o " + map.stem().string() + "/\n";
}

/// Says what of the log could not be used; returns the exit code that tells it.
int report_losses(const submap::LogReport& log) {
  for (const auto& [note, count] : log.notes) spdlog::info("log: {} ({} times)", note, count);
  for (const auto& [loss, count] : log.losses) spdlog::warn("log: {} ({} times)", loss, count);
  return log.losses.empty() ? kDone : kDoneWithLosses;
}

int map_log(const MapArguments& arguments, const Globals& globals) {
  submap::Options options = arguments.options;
  options.track.keyframe_angle_rad = arguments.keyframe_angle_deg * std::numbers::pi / 180;
  options.log.further_parts.assign(arguments.parts.begin() + 1, arguments.parts.end());
  const auto start = std::chrono::steady_clock::now();
  const auto existing =
      arguments.force ? submap::MapFile::Existing::replace : submap::MapFile::Existing::resume;
  const submap::BuildResult result = submap::build_map(arguments.parts.front(), arguments.map,
                                                       options, existing, make_run(globals));
  const submap::HybridMap map = result.file.load_map();
  nlohmann::ordered_json object = summary(map);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  object["wall_s"] = wall.count();
  object["cpu_s"] = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  object["peak_rss_mb"] = static_cast<double>(usage.ru_maxrss) / 1024;
  object["stages"] = nlohmann::ordered_json::object();
  for (const submap::StageTime& time : result.times) object["stages"][time.stage] = time.seconds;
  print_result(globals, object, as_text(object, result.times, map, arguments.map));
  return report_losses(map.track.log);
}

}  // namespace

Action add_map(CLI::App& command) {
  auto arguments = std::make_shared<MapArguments>();  // shared by CLI11's options and the action
  submap::Options& options = arguments->options;
  arguments->keyframe_angle_deg = options.track.keyframe_angle_rad * 180 / std::numbers::pi;
  command
      .add_option(
          "LOG", arguments->parts,
          std::string("Log to map, or the parts of a split one in their order: ") + kLogFormats)
      ->required();
  command.add_option("-o,--output", arguments->map, "Map file to make, or to go on with")
      ->required();
  command.add_flag("--force", arguments->force, "Begin anew even if the map file exists");
  add_log_options(command, options.log);
  command
      .add_option("--tau", options.partition.tau,
                  "Bisect while Ncut < tau; larger gives more, smaller submaps")
      ->check(CLI::Range(1e-6, 2.0))
      ->capture_default_str();
  command
      .add_option("--min-keyframes", options.partition.min_keyframes,
                  "Groups of fewer keyframes are not cut")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_flag(
      "--sequential", options.partition.sequential,
      "Partition in one pass, as on the robot's way: areas that it has left for another "
      "are closed (-v tells when)");
  command
      .add_option("--keyframe-distance", options.track.keyframe_distance_m,
                  "A keyframe every so many metres")
      ->check(CLI::Range(0.05, 10.0))
      ->capture_default_str();
  command
      .add_option("--keyframe-angle", arguments->keyframe_angle_deg,
                  "A keyframe every so many degrees of turn")
      ->check(CLI::Range(1.0, 180.0))
      ->capture_default_str();
  command
      .add_option("--resolution", options.octree_resolution_m,
                  "Cells of the OctoMaps, metres [0.05, in space 0.2]")
      ->check(CLI::Range(0.005, 10.0))
      ->capture_default_str();
  command
      .add_option("--max-memory", options.max_memory_bytes,
                  "Memory to take, such as 500M or 2G: caches take a tenth of it [96M], and a "
                  "warning says where the map itself needs more")
      ->transform(CLI::AsSizeValue(false));
  return [arguments](const Globals& globals) { return map_log(*arguments, globals); };
}

}  // namespace hmt::apps
