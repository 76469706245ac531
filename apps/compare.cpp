// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <numbers>
#include <string>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/labels_file.hpp"
#include "hmt/graph/matrix_market.hpp"
#include "hmt/graph/normalized_cut.hpp"
#include "hmt/graph/partition_comparison.hpp"
#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/map/map_file.hpp"
#include "trajectory_input.hpp"

namespace hmt::apps {
namespace {

struct CompareArguments {
  std::string a;
  std::string b;
  std::string omega;
};

/// Labels of a labels file, or the submap of every keyframe of a map.
graph::Labels load_labels(const std::string& path) {
  return is_map_file(path) ? submap::MapFile::open(path).load_partition()
                           : graph::read_labels(path);
}

void add_partitions(const graph::Labels& a, const graph::Labels& b, const std::string& omega_path,
                    nlohmann::ordered_json& object, std::string& text) {
  const graph::PartitionComparison alike = graph::compare_partitions(a, b);
  object["nodes"] = alike.nodes;
  object["groups_a"] = alike.groups_a;
  object["groups_b"] = alike.groups_b;
  object["adjusted_rand_index"] = alike.adjusted_rand_index;
  object["variation_of_information_bits"] = alike.variation_of_information_bits;
  text += fmt::format(
      "nodes                     {}\ngroups                    {} and {}\n"
      "adjusted Rand index       {:.6f}\nvariation of information  {:.6f} bit\n",
      alike.nodes, alike.groups_a, alike.groups_b, alike.adjusted_rand_index,
      alike.variation_of_information_bits);
  if (omega_path.empty()) return;
  const graph::WeightedGraph omega = graph::read_matrix_market(omega_path);
  const double ncut_a = graph::kway_ncut(omega, a);
  const double ncut_b = graph::kway_ncut(omega, b);
  object["kway_ncut_a"] = ncut_a;
  object["kway_ncut_b"] = ncut_b;
  text += fmt::format("k-way Ncut                {:.9g} and {:.9g}\n", ncut_a, ncut_b);
}

void add_trajectories(const CompareArguments& arguments, nlohmann::ordered_json& object,
                      std::string& text) {
  const auto a = load_trajectory(arguments.a);
  const auto b = load_trajectory(arguments.b);
  const submap::TrajectoryError difference = submap::evaluate_trajectory(a, b);
  const double rpe_rot_deg = difference.rpe_rot_rmse_rad * 180 / std::numbers::pi;
  object["poses_a"] = a.size();
  object["poses_b"] = b.size();
  object["matched"] = difference.matched;
  object["ate_rmse_m"] = difference.ate_rmse_m;
  object["ate_max_m"] = difference.ate_max_m;
  object["rpe_trans_rmse_m"] = difference.rpe_trans_rmse_m;
  object["rpe_rot_rmse_deg"] = rpe_rot_deg;
  text += fmt::format(
      "poses                     {} and {}, {} of them at the same stamps\n"
      "distance after alignment  {:.4f} m rmse, {:.4f} m at most\n"
      "difference per {:g} m        {:.4f} m, {:.3f} deg rmse\n",
      a.size(), b.size(), difference.matched, difference.ate_rmse_m, difference.ate_max_m,
      submap::kRpePath, difference.rpe_trans_rmse_m, rpe_rot_deg);
}

/// Two maps: their trajectories, and their partitions where they have as many keyframes.
void add_maps(const CompareArguments& arguments, nlohmann::ordered_json& object,
              std::string& text) {
  const graph::Labels a = load_labels(arguments.a);
  const graph::Labels b = load_labels(arguments.b);
  if (a.size() == b.size()) {
    add_partitions(a, b, arguments.omega, object, text);
  } else {
    object["keyframes_a"] = a.size();
    object["keyframes_b"] = b.size();
    text += fmt::format("keyframes                 {} and {}: partitions not comparable\n",
                        a.size(), b.size());
  }
  add_trajectories(arguments, object, text);
}

// Kinds are told by content.
int run_compare(const CompareArguments& arguments, const Globals& globals) {
  nlohmann::ordered_json object;
  std::string text;
  if (graph::is_labels_file(arguments.a) || graph::is_labels_file(arguments.b)) {
    object["kind"] = "partition";
    add_partitions(load_labels(arguments.a), load_labels(arguments.b), arguments.omega, object,
                   text);
  } else if (is_map_file(arguments.a) && is_map_file(arguments.b)) {
    object["kind"] = "map";
    add_maps(arguments, object, text);
  } else {
    object["kind"] = "trajectory";
    add_trajectories(arguments, object, text);
  }
  print_result(globals, object, text);
  return kDone;
}

}  // namespace

Action add_compare(CLI::App& command) {
  const auto arguments = std::make_shared<CompareArguments>();
  command
      .add_option("A", arguments->a,
                  "Partition (labels one a line, any numbering, or a partition.csv), trajectory (a "
                  "TUM file) or map")
      ->required();
  command
      .add_option("B", arguments->b,
                  "The same kind of thing, of the same log; a map stands for either")
      ->required();
  command.add_option("--omega", arguments->omega,
                     "Weight matrix (Matrix Market) to give the k-way Ncut of each partition");
  return [arguments](const Globals& globals) { return run_compare(*arguments, globals); };
}

}  // namespace hmt::apps
