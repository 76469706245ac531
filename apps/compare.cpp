// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.hpp"
#include "console.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/labels_file.hpp"
#include "hmt/graph/matrix_market.hpp"
#include "hmt/graph/normalized_cut.hpp"
#include "hmt/graph/partition_comparison.hpp"

namespace hmt::apps {
namespace {

struct CompareArguments {
  std::string a;
  std::string b;
  std::string omega;
};

int compare_partition_files(const CompareArguments& arguments, const Globals& globals) {
  const graph::Labels a = graph::read_labels(arguments.a);
  const graph::Labels b = graph::read_labels(arguments.b);
  const graph::PartitionComparison alike = graph::compare_partitions(a, b);
  nlohmann::ordered_json object = {
      {"kind", "partition"},
      {"nodes", alike.nodes},
      {"groups_a", alike.groups_a},
      {"groups_b", alike.groups_b},
      {"adjusted_rand_index", alike.adjusted_rand_index},
      {"variation_of_information_bits", alike.variation_of_information_bits}};
  std::string text = fmt::format(
      "nodes                     {}\ngroups                    {} and {}\n"
      "adjusted Rand index       {:.6f}\nvariation of information  {:.6f} bit\n",
      alike.nodes, alike.groups_a, alike.groups_b, alike.adjusted_rand_index,
      alike.variation_of_information_bits);
  if (!arguments.omega.empty()) {
    const graph::WeightedGraph omega = graph::read_matrix_market(arguments.omega);
    const double ncut_a = graph::kway_ncut(omega, a);
    const double ncut_b = graph::kway_ncut(omega, b);
    object["kway_ncut_a"] = ncut_a;
    object["kway_ncut_b"] = ncut_b;
    text += fmt::format("k-way Ncut                {:.9g} and {:.9g}\n", ncut_a, ncut_b);
  }
  print_result(globals, object, text);
  return kDone;
}

// Both files must be of one kind; the kind is told by their first lines.
int run_compare(const CompareArguments& arguments, const Globals& globals) {
  if (graph::is_labels_file(arguments.a) || graph::is_labels_file(arguments.b))
    return compare_partition_files(arguments, globals);
  throw graph::InputError(arguments.a +
                          ": is no labels file (the number of one node's group a line) and no "
                          "partition.csv");
}

}  // namespace

Action add_compare(CLI::App& command) {
  const auto arguments = std::make_shared<CompareArguments>();
  command
      .add_option("A", arguments->a,
                  "Partition: labels one a line (any numbering), or a partition.csv")
      ->required();
  command.add_option("B", arguments->b, "The same kind of file, of the same nodes")->required();
  command.add_option("--omega", arguments->omega,
                     "Weight matrix (Matrix Market) to give the k-way Ncut of each partition");
  return [arguments](const Globals& globals) { return run_compare(*arguments, globals); };
}

}  // namespace hmt::apps
