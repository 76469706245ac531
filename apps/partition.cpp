// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/partition.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/group_refinement.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/labels_file.hpp"
#include "hmt/graph/matrix_market.hpp"
#include "hmt/graph/normalized_cut.hpp"
#include "hmt/submap/export/atomic_file.hpp"
#include "hmt/submap/map/map_file.hpp"
#include "partition_tables.hpp"
#include "trajectory_input.hpp"

namespace hmt::apps {
namespace {

using Clock = std::chrono::steady_clock;

struct PartitionArguments {
  std::string input;
  graph::PartitionOptions options;
  PartitionMethod method = PartitionMethod::ncut;
  bool no_refine = false;
  bool refine_groups = false;
  bool sweep_tau = false;
  bool compare = false;
  std::string labels_file;
  std::string csv_file;
  bool force = false;
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

graph::WeightedGraph read_overlap(const std::string& input) {
  if (!is_map_file(input)) return graph::read_matrix_market(input);
  const submap::MapFile map = submap::MapFile::open(input);
  return {static_cast<int>(map.load_track().keyframes.size()), map.load_overlap()};
}

// Asked before the work, so that a long run does not end in a refusal.
void refuse_to_overwrite(const std::string& path, bool force) {
  if (!force && !path.empty() && std::filesystem::exists(path))
    throw graph::InputError(path + ": exists; choose another name or give --force");
}

nlohmann::ordered_json to_json(const graph::Bisection& cut) {
  return {{"size_a", cut.size_a},
          {"size_b", cut.size_b},
          {"ncut", cut.ncut},
          {"lambda_2", cut.lambda_2},
          {"residual", cut.residual}};
}

int run_partition(const PartitionArguments& arguments, const Globals& globals) {
  const Clock::time_point start = Clock::now();
  refuse_to_overwrite(arguments.labels_file, arguments.force);
  refuse_to_overwrite(arguments.csv_file, arguments.force);
  const graph::WeightedGraph overlap = read_overlap(arguments.input);
  graph::PartitionOptions options = arguments.options;
  options.refine = !arguments.no_refine;
  const Clock::time_point read = Clock::now();
  if (arguments.sweep_tau) return print_tau_sweep(overlap, options, arguments.csv_file, globals);
  if (arguments.compare) return print_method_comparison(overlap, options, globals);
  graph::PartitionResult result = partition_by(arguments.method, overlap, options, globals.threads);
  if (arguments.refine_groups)
    result.labels = graph::refine_groups(overlap, result.labels, options.min_size);
  const double partition_s = seconds_since(read);
  if (!arguments.labels_file.empty())
    submap::write_file(arguments.labels_file, graph::labels_text(result.labels));

  const std::vector<int> sizes = group_sizes(result.labels);
  const double kway = graph::kway_ncut(overlap, result.labels);
  const double top = result.bisections.empty() ? 0 : result.bisections.front().ncut;
  nlohmann::ordered_json object = {{"nodes", overlap.num_nodes()},
                                   {"groups", sizes.size()},
                                   {"sizes", sizes},
                                   {"kway_ncut", kway},
                                   {"top_ncut", top},
                                   {"partition_s", partition_s},
                                   {"wall_s", seconds_since(start)},
                                   {"bisections", nlohmann::json::array()}};
  for (const graph::Bisection& cut : result.bisections)
    object["bisections"].push_back(to_json(cut));
  std::string text =
      fmt::format("{} nodes, {} arcs: {} groups, k-way Ncut {:.6g}, top Ncut {:.6g}, {:.3f} s\n",
                  overlap.num_nodes(), overlap.num_arcs(), sizes.size(), kway, top, partition_s);
  print_result(globals, object, text);
  return kDone;
}

void add_method_options(CLI::App& command, PartitionArguments& arguments) {
  graph::PartitionOptions& options = arguments.options;
  CLI::Option* const tau =
      command
          .add_option("--tau", options.tau,
                      "Accept a cut below this Ncut, above 0 and below 2; raising it gives more, "
                      "smaller groups")
          ->capture_default_str();
  command.add_option("--groups", options.groups, "Exactly this number of groups, best cut first")
      ->check(CLI::PositiveNumber)
      ->excludes(tau);
  const std::map<std::string, graph::Threshold> thresholds = {{"mean", graph::Threshold::mean},
                                                              {"sign", graph::Threshold::sign},
                                                              {"sweep", graph::Threshold::sweep}};
  command
      .add_option("--threshold", options.threshold,
                  "Where the Fiedler vector is cut: mean, sign or sweep (the least Ncut; default)")
      ->transform(CLI::CheckedTransformer(thresholds, CLI::ignore_case).description(""));
  command.add_option("--min-size", options.min_size, "Do not cut groups of fewer nodes than this")
      ->capture_default_str();
  command.add_flag("--no-refine", arguments.no_refine,
                   "Keep each cut as its threshold gives it, and try no others");
  command.add_flag("--refine-groups", arguments.refine_groups,
                   "Lower the k-way Ncut at the end by moving nodes between all groups; --groups "
                   "does so without being asked");
}

void add_table_options(CLI::App& command, PartitionArguments& arguments) {
  const std::map<std::string, PartitionMethod> methods = {{"ncut", PartitionMethod::ncut},
                                                          {"fixed", PartitionMethod::fixed},
                                                          {"metis", PartitionMethod::metis}};
  command
      .add_option("--method", arguments.method,
                  "ncut (default), fixed (runs of consecutive nodes) or metis; the last two need "
                  "--groups")
      ->transform(CLI::CheckedTransformer(methods, CLI::ignore_case).description(""));
  CLI::Option* const sweep =
      command.add_flag("--sweep-tau", arguments.sweep_tau,
                       "Print groups, sizes and k-way Ncut for tau = 0.05, 0.10, .. 1.50");
  command.add_option("--csv", arguments.csv_file, "Write the table of --sweep-tau to this file")
      ->needs(sweep);
  command
      .add_flag("--compare", arguments.compare,
                "Print all methods side by side, at the number of groups of ncut")
      ->excludes(sweep);
}

}  // namespace

Action add_partition(CLI::App& command) {
  const auto arguments = std::make_shared<PartitionArguments>();
  command
      .add_option("input", arguments->input,
                  "A map (.hmt), or a weight matrix Omega in Matrix Market format, plain or gzip")
      ->required();
  add_method_options(command, *arguments);
  add_table_options(command, *arguments);
  command.add_option("-o,--output", arguments->labels_file,
                     "Write the group of every node, one a line, to this file");
  command.add_flag("--force", arguments->force, "Overwrite files that exist");
  return [arguments](const Globals& globals) { return run_partition(*arguments, globals); };
}

}  // namespace hmt::apps
