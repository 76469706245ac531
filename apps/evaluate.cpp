// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <numbers>
#include <set>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/export/landmarks_file.hpp"
#include "hmt/submap/export/map_quality.hpp"
#include "hmt/submap/map/map_file.hpp"
#include "trajectory_input.hpp"

namespace hmt::apps {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

struct Arguments {
  std::string trajectory;
  std::string relations;
  std::string reference;
  bool map_quality = false;
  std::string landmarks;
};

void add_relations(const submap::RelationsError& error, nlohmann::ordered_json& json,
                   std::string& text) {
  json["relations"] = error.relations;
  json["relations_used"] = error.relations_used;
  json["trans_mean_m"] = error.trans_mean_m;
  json["trans_std_m"] = error.trans_std_m;
  json["rot_mean_deg"] = error.rot_mean_rad * kDegPerRad;
  json["rot_std_deg"] = error.rot_std_rad * kDegPerRad;
  text += fmt::format(
      "relations    {} of {} used\n"
      "translation  {:.4f} m mean, {:.4f} m std\n"
      "rotation     {:.3f} deg mean, {:.3f} deg std\n",
      error.relations_used, error.relations, error.trans_mean_m, error.trans_std_m,
      error.rot_mean_rad * kDegPerRad, error.rot_std_rad * kDegPerRad);
}

void add_reference(const submap::TrajectoryError& error, nlohmann::ordered_json& json,
                   std::string& text) {
  json["reference_poses"] = error.reference_poses;
  json["matched"] = error.matched;
  json["ate_rmse_m"] = error.ate_rmse_m;
  json["ate_mean_m"] = error.ate_mean_m;
  json["ate_max_m"] = error.ate_max_m;
  json["rpe_pairs"] = error.rpe_pairs;
  json["rpe_path_m"] = submap::kRpePath;
  json["rpe_trans_rmse_m"] = error.rpe_trans_rmse_m;
  json["rpe_rot_rmse_deg"] = error.rpe_rot_rmse_rad * kDegPerRad;
  text += fmt::format(
      "reference    {} of {} poses matched by their stamps\n"
      "ATE          {:.4f} m rmse, {:.4f} m mean, {:.4f} m max\n"
      "RPE          {:.4f} m, {:.3f} deg rmse over {:g} m of path\n",
      error.matched, error.reference_poses, error.ate_rmse_m, error.ate_mean_m, error.ate_max_m,
      error.rpe_trans_rmse_m, error.rpe_rot_rmse_rad * kDegPerRad, submap::kRpePath);
}

nlohmann::ordered_json to_json(const submap::MapQuality& quality) {
  return {{"scans", quality.scans},
          {"beams", quality.beams},
          {"occupied_cells", quality.occupied_cells},
          {"cells_per_1000_beams", quality.cells_per_1000_beams},
          {"mean_wall_thickness_m", quality.mean_wall_thickness_m},
          {"wall_patches", quality.wall_patches}};
}

std::string to_text(const char* of, const submap::MapQuality& quality) {
  return fmt::format("{:<13}walls {:.4f} m thick, {:.2f} cells of 5 cm per 1000 beams ({} scans)\n",
                     of, quality.mean_wall_thickness_m, quality.cells_per_1000_beams,
                     quality.scans);
}

/// Of the map, and of the same scans at the poses of the reference if there is one.
void add_map_quality(const Arguments& arguments, nlohmann::ordered_json& json, std::string& text) {
  if (!is_map_file(arguments.trajectory))
    throw graph::InputError(arguments.trajectory +
                            ": --map-quality needs a map, which has the scans");
  const submap::MapFile file = submap::MapFile::open(arguments.trajectory);
  const submap::HybridMap map = file.load_map();
  std::vector<submap::PosedObservation> own =
      submap::observations_along(map.track, submap::stamped_trajectory(map));
  if (!arguments.reference.empty()) {
    const auto reference =
        submap::observations_along(map.track, submap::read_tum(arguments.reference));
    std::set<int64_t> common;
    for (const submap::PosedObservation& posed : reference) common.insert(posed.observation);
    std::erase_if(own, [&](const auto& posed) { return !common.contains(posed.observation); });
    const submap::MapQuality quality = submap::map_quality(file, reference);
    json["reference_map_quality"] = to_json(quality);
    text += to_text("by reference", quality);
  }
  const submap::MapQuality quality = submap::map_quality(file, own);
  if (quality.beams == 0)
    throw graph::InputError(arguments.trajectory +
                            ": --map-quality needs scans or clouds, and the map has none");
  json["map_quality"] = to_json(quality);
  text += to_text("by map", quality);
}

void add_landmarks(const submap::LandmarkError& error, nlohmann::ordered_json& json,
                   std::string& text) {
  json["true_landmarks"] = error.true_landmarks;
  json["landmarks_matched"] = error.matched;
  json["landmark_rmse_m"] = error.rmse_m;
  json["landmark_max_m"] = error.max_m;
  text += fmt::format("landmarks    {} of {} matched by name, {:.4f} m rmse, {:.4f} m max\n",
                      error.matched, error.true_landmarks, error.rmse_m, error.max_m);
}

submap::HybridMap load_landmark_map(const std::string& path) {
  if (!is_map_file(path)) throw graph::InputError(path + ": only a map has landmarks");
  return submap::MapFile::open(path).load_map();
}

int evaluate(const Arguments& arguments, const Globals& globals) {
  const auto trajectory = load_trajectory(arguments.trajectory);
  nlohmann::ordered_json json;
  std::string text;
  json["poses"] = trajectory.size();
  if (!arguments.relations.empty())
    add_relations(
        submap::evaluate_relations(trajectory, submap::read_relations(arguments.relations)), json,
        text);
  if (!arguments.reference.empty())
    add_reference(submap::evaluate_trajectory(trajectory, submap::read_tum(arguments.reference)),
                  json, text);
  if (arguments.map_quality) add_map_quality(arguments, json, text);
  if (!arguments.landmarks.empty())
    add_landmarks(submap::evaluate_landmarks(load_landmark_map(arguments.trajectory),
                                             submap::read_true_landmarks(arguments.landmarks)),
                  json, text);
  print_result(globals, json, text);
  return kDone;
}

}  // namespace

Action add_evaluate(CLI::App& command) {
  const auto arguments = std::make_shared<Arguments>();  // shared by the parser and the action
  command.add_option("MAP|TRAJ.tum", arguments->trajectory, "Map or trajectory to evaluate")
      ->required();
  CLI::App* truth = command.add_option_group("truth");
  truth->add_option("--relations", arguments->relations,
                    "True relative poses: stamp1 stamp2 x y z roll pitch yaw [Kuemmerle 2009]");
  truth->add_option("--reference", arguments->reference,
                    "Reference trajectory: a TUM file, or lines of stamp x y heading");
  truth->add_option("--landmarks", arguments->landmarks,
                    "True landmarks of a planar map: lines of name x y");
  truth->add_flag("--map-quality", arguments->map_quality,
                  "How thick the walls of the map are and how many cells its beams fill; with "
                  "--reference also what the same scans make at the reference's poses");
  truth->require_option(1, 4);
  return [arguments](const Globals& globals) { return evaluate(*arguments, globals); };
}

}  // namespace hmt::apps
