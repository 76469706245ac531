// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/submap/find_route.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::apps {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

struct Arguments {
  std::string map;
  std::vector<double> start;
  std::vector<double> goal;
};

submap::Place to_place(const std::vector<double>& numbers) {
  submap::Place place{numbers.at(0), numbers.at(1), std::nullopt};
  if (numbers.size() > 2) place.z_m = numbers[2];
  return place;
}

/// Root of the sum of the variances of a position.
double sigma_position_m(const submap::RouteStep& step) {
  return std::sqrt(step.covariance.topLeftCorner<3, 3>().trace());
}

double sigma_yaw_deg(const submap::RouteStep& step) {
  return std::sqrt(step.covariance(5, 5)) * kDegPerRad;
}

nlohmann::ordered_json to_json(const submap::Route& route) {
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (const submap::RouteStep& step : route.steps) {
    const Eigen::Vector3d& p = step.T_world_keyframe.translation;
    const Eigen::Quaterniond& q = step.T_world_keyframe.rotation;
    steps.push_back({{"keyframe", step.keyframe},
                     {"submap", step.submap},
                     {"length_m", step.length_m},
                     {"T_world_keyframe", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}},
                     {"sigma_position_m", sigma_position_m(step)},
                     {"sigma_yaw_deg", sigma_yaw_deg(step)}});
  }
  return {{"length_m", route.length_m()},
          {"start_distance_m", route.start_distance_m},
          {"goal_distance_m", route.goal_distance_m},
          {"steps", steps}};
}

/// One line for each stretch within a submap, with what holds where it ends.
std::string to_text(const submap::Route& route) {
  std::string text = fmt::format("{:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "submap",
                                 "keyframe", "length m", "x", "y", "z", "+- m", "+- deg");
  for (size_t k = 0; k < route.steps.size(); ++k) {
    const submap::RouteStep& step = route.steps[k];
    if (k + 1 < route.steps.size() && route.steps[k + 1].submap == step.submap) continue;
    const Eigen::Vector3d& p = step.T_world_keyframe.translation;
    text += fmt::format("{:>6} {:>9} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.3f} {:>9.2f}\n",
                        step.submap, step.keyframe, step.length_m, p.x(), p.y(), p.z(),
                        sigma_position_m(step), sigma_yaw_deg(step));
  }
  return text + fmt::format(
                    "{:.2f} m over {} keyframes; begins {:.2f} m from the start and ends "
                    "{:.2f} m from the goal\n",
                    route.length_m(), route.steps.size(), route.start_distance_m,
                    route.goal_distance_m);
}

int route(const Arguments& arguments, const Globals& globals) {
  const submap::HybridMap map = submap::MapFile::open(arguments.map).load_map();
  const submap::Route found =
      submap::find_route(map, to_place(arguments.start), to_place(arguments.goal), globals.threads);
  print_result(globals, to_json(found), to_text(found));
  return kDone;
}

}  // namespace

Action add_route(CLI::App& command) {
  const auto arguments = std::make_shared<Arguments>();  // shared by the parser and the action
  command.add_option("MAP", arguments->map, "Map file made by hmtmap map")->required();
  for (const auto& [name, place] :
       {std::pair{"--from", &arguments->start}, {"--to", &arguments->goal}})
    command.add_option(name, *place, "Place in the frame of trajectory.tum, metres: X,Y or X,Y,Z")
        ->delimiter(',')
        ->expected(2, 3)
        ->required();
  command.footer(
      "The route goes from keyframe to keyframe, from the one nearest to the start to the one "
      "nearest\nto the goal, where the robot drove or passed by within 1 m. One line for each "
      "submap on the way;\n+-: how well the pose is known that it ends at, seen from the first "
      "one.");
  return [arguments](const Globals& globals) { return route(*arguments, globals); };
}

}  // namespace hmt::apps
