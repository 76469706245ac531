// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/submap/export/carmen_file.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/log/simulation.hpp"

namespace hmt::apps {
namespace {

struct Arguments {
  submap::SimulationOptions options;
  std::string log;
  bool force = false;
};

void refuse_existing(const std::string& path, bool force) {
  if (!force && std::filesystem::exists(path))
    throw graph::InputError(path + ": exists already; --force overwrites it");
}

int simulate(const Arguments& arguments, const Globals& globals) {
  const std::string truth_path = arguments.log + ".truth.tum";
  for (const std::string& path : {arguments.log, truth_path})
    refuse_existing(path, arguments.force);
  const submap::Run run = make_run(globals);
  submap::Simulation simulation(arguments.options);
  submap::CarmenWriter writer(arguments.log);
  std::vector<submap::StampedPose> truth;
  double path_m = 0;
  while (const auto scan = simulation.next()) {
    if (run.stop_requested()) throw submap::Interrupted{};
    const submap::Observation& observation = scan->observation;
    writer.add(scan->ranges_m,
               observation.T_odom_robot * observation.readings.front().T_robot_sensor,
               observation.T_odom_robot, observation.stamp_s);
    if (!truth.empty())
      path_m += (scan->T_world_robot.translation - truth.back().T_world_robot.translation).norm();
    truth.push_back({observation.stamp_s, scan->T_world_robot});
    run.report({"simulate", static_cast<double>(simulation.laps_begun() - 1),
                static_cast<double>(arguments.options.laps)});
  }
  writer.commit();
  submap::write_tum(truth_path, truth);

  nlohmann::ordered_json json;
  json["log"] = arguments.log;
  json["truth"] = truth_path;
  json["scans"] = truth.size();
  json["path_m"] = path_m;
  print_result(globals, json,
               fmt::format("{}: {} scans, {:.0f} m of path; truth in {}\n", arguments.log,
                           truth.size(), path_m, truth_path));
  return kDone;
}

}  // namespace

Action add_simulate(CLI::App& command) {
  const auto arguments = std::make_shared<Arguments>();  // shared by the parser and the action
  command.add_option("NAME", arguments->options.world, "World to drive through")
      ->required()
      ->check(CLI::IsMember(submap::simulated_worlds()));
  command
      .add_option("-o,--output", arguments->log,
                  "CARMEN log to write, compressed if it ends in .gz, .bz2 or .zst; the true poses "
                  "go to LOG.truth.tum")
      ->type_name("LOG")
      ->required();
  command.add_option("--seed", arguments->options.seed, "Seed of noise, drift and furniture")
      ->capture_default_str();
  command.add_option("--laps", arguments->options.laps, "Rounds through the world")
      ->capture_default_str();
  command.add_flag("--force", arguments->force, "Overwrite files that exist");
  return [arguments](const Globals& globals) { return simulate(*arguments, globals); };
}

}  // namespace hmt::apps
