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
#include <utility>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/group_refinement.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/labels_file.hpp"
#include "hmt/graph/normalized_cut.hpp"
#include "hmt/graph/tau_search.hpp"
#include "hmt/submap/export/atomic_file.hpp"
#include "partition_input.hpp"
#include "partition_tables.hpp"

namespace hmt::apps {
namespace {

using Clock = std::chrono::steady_clock;

struct PartitionArguments {
  std::string input;
  graph::PartitionOptions options;
  MethodChoice choice;
  std::optional<double> max_loss;
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

/// The partition by the largest tau that --max-loss allows; sets options.tau to it.
graph::PartitionResult cut_within_loss(const PartitionInput& input, double max_loss,
                                       graph::PartitionOptions& options, int threads) {
  if (!input.information)
    throw graph::InputError("a matrix has no information to lose: --max-loss needs a map or a log");
  const auto loss = [&input](const graph::Labels& labels) {
    return *input.information_loss(labels);
  };
  auto found = graph::largest_tau(input.overlap, options, loss, max_loss, threads);
  if (!found)
    throw graph::InputError(
        fmt::format("even tau = 0.01 loses {:g} of the information or more", max_loss));
  options.tau = found->tau;
  return std::move(found->partition);
}

nlohmann::ordered_json summary(const PartitionInput& input, const graph::PartitionResult& result) {
  const std::vector<int> sizes = group_sizes(result.labels);
  nlohmann::ordered_json object = {
      {"nodes", input.overlap.num_nodes()},
      {"groups", sizes.size()},
      {"sizes", sizes},
      {"kway_ncut", graph::kway_ncut(input.overlap, result.labels)},
      {"top_ncut", result.bisections.empty() ? 0 : result.bisections.front().ncut}};
  if (const auto loss = input.information_loss(result.labels)) object["information_loss"] = *loss;
  return object;
}

std::string as_text(const nlohmann::ordered_json& object, const PartitionInput& input) {
  std::string text =
      fmt::format("{} nodes, {} arcs: {} groups, k-way Ncut {:.6g}, top Ncut {:.6g}, {:.3f} s\n",
                  input.overlap.num_nodes(), input.overlap.num_arcs(),
                  object["groups"].get<size_t>(), object["kway_ncut"].get<double>(),
                  object["top_ncut"].get<double>(), object["partition_s"].get<double>());
  if (object.contains("information_loss"))
    text += fmt::format("information loss {:.6g}\n", object["information_loss"].get<double>());
  if (object.contains("tau")) text += fmt::format("tau {:.2f}\n", object["tau"].get<double>());
  return text;
}

int run_partition(const PartitionArguments& arguments, const Globals& globals) {
  const Clock::time_point start = Clock::now();
  refuse_to_overwrite(arguments.labels_file, arguments.force);
  refuse_to_overwrite(arguments.csv_file, arguments.force);
  const PartitionInput input = read_partition_input(arguments.input, globals);
  graph::PartitionOptions options = arguments.options;
  options.refine = !arguments.no_refine;
  const Clock::time_point read = Clock::now();
  if (arguments.sweep_tau) return print_tau_sweep(input, options, arguments.csv_file, globals);
  if (arguments.compare) return print_method_comparison(input, options, globals);
  graph::PartitionResult result =
      arguments.max_loss ? cut_within_loss(input, *arguments.max_loss, options, globals.threads)
                         : partition_by(arguments.choice, input, options, globals.threads);
  if (arguments.refine_groups)
    result.labels = graph::refine_groups(input.overlap, result.labels, options.min_size);
  const double partition_s = seconds_since(read);
  if (!arguments.labels_file.empty())
    submap::write_file(arguments.labels_file, graph::labels_text(result.labels));

  nlohmann::ordered_json object = summary(input, result);
  if (arguments.max_loss) object["tau"] = options.tau;
  object["partition_s"] = partition_s;
  object["wall_s"] = seconds_since(start);
  object["bisections"] = nlohmann::json::array();
  for (const graph::Bisection& cut : result.bisections)
    object["bisections"].push_back(to_json(cut));
  print_result(globals, object, as_text(object, input));
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
  command
      .add_option("--max-loss", arguments.max_loss,
                  "The largest tau (to 0.01) whose information loss e [Blanco 2009, Eq. 22] stays "
                  "below this share; for maps and logs")
      ->check(CLI::Range(1e-12, 1.0))
      ->excludes(tau)
      ->excludes("--groups");
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
                                                          {"distance", PartitionMethod::distance},
                                                          {"time", PartitionMethod::time},
                                                          {"metis", PartitionMethod::metis}};
  command
      .add_option("--method", arguments.choice.method,
                  "ncut (default); fixed, distance or time: cut every so many keyframes, metres or "
                  "seconds; metis: about equal groups. All but ncut to compare with")
      ->transform(CLI::CheckedTransformer(methods, CLI::ignore_case).description(""))
      ->excludes("--max-loss");
  command
      .add_option("--every", arguments.choice.every,
                  "Keyframes, metres or seconds of a group for --method fixed, distance, time")
      ->check(CLI::PositiveNumber)
      ->excludes("--groups");
  CLI::Option* const sweep =
      command.add_flag("--sweep-tau", arguments.sweep_tau,
                       "Print groups, sizes, k-way Ncut and, of a map, information loss for "
                       "tau = 0.05, 0.10, .. 1.50");
  for (const char* fixed : {"--tau", "--groups", "--max-loss", "--method", "--every"})
    sweep->excludes(command.get_option(fixed));
  command.add_option("--csv", arguments.csv_file, "Write the table of --sweep-tau to this file")
      ->needs(sweep);
  command
      .add_flag("--compare", arguments.compare,
                "Print all methods side by side, at the number of groups of ncut")
      ->excludes(sweep)
      ->excludes("--max-loss")
      ->excludes("--method")
      ->excludes("--every");
}

}  // namespace

Action add_partition(CLI::App& command) {
  const auto arguments = std::make_shared<PartitionArguments>();
  command
      .add_option(
          "input", arguments->input,
          "A map (.hmt), a weight matrix Omega in Matrix Market format, plain or gzip, or a "
          "log, which is mapped first")
      ->required();
  add_method_options(command, *arguments);
  add_table_options(command, *arguments);
  command
      .add_option("-o,--output", arguments->labels_file,
                  "Write the group of every node, one a line, to this file")
      ->excludes("--sweep-tau")
      ->excludes("--compare");
  command.add_flag("--force", arguments->force, "Overwrite files that exist");
  return [arguments](const Globals& globals) { return run_partition(*arguments, globals); };
}

}  // namespace hmt::apps
