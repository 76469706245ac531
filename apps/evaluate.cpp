// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <spdlog/fmt/fmt.h>

#include <CLI/CLI.hpp>
#include <numbers>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/submap/export/evaluation.hpp"
#include "trajectory_input.hpp"

namespace hmt::apps {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

struct Arguments {
  std::string trajectory;
  std::string relations;
  std::string reference;
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
  truth->add_option("--reference", arguments->reference, "Reference trajectory, a TUM file");
  truth->require_option(1, 2);
  return [arguments](const Globals& globals) { return evaluate(*arguments, globals); };
}

}  // namespace hmt::apps
