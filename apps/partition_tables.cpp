// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "partition_tables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "console.hpp"
#include "hmt/graph/baseline_partition.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/normalized_cut.hpp"
#include "hmt/graph/partition_comparison.hpp"
#include "hmt/submap/export/atomic_file.hpp"

namespace hmt::apps {
namespace {

struct Summary {
  size_t groups = 0;
  int smallest = 0;
  int median = 0;
  int largest = 0;
  double kway_ncut = 0;
};

Summary summarize(const graph::WeightedGraph& overlap, const graph::Labels& labels) {
  std::vector<int> sizes = group_sizes(labels);
  if (sizes.empty()) return {};
  std::sort(sizes.begin(), sizes.end());
  return {sizes.size(), sizes.front(), sizes[sizes.size() / 2], sizes.back(),
          graph::kway_ncut(overlap, labels)};
}

nlohmann::ordered_json to_json(const Summary& s) {
  return {{"groups", s.groups},
          {"smallest", s.smallest},
          {"median", s.median},
          {"largest", s.largest},
          {"kway_ncut", s.kway_ncut}};
}

}  // namespace

graph::PartitionResult partition_by(PartitionMethod method, const graph::WeightedGraph& overlap,
                                    const graph::PartitionOptions& options, int threads) {
  if (method == PartitionMethod::ncut) return graph::recursive_partition(overlap, options, threads);
  if (!options.groups) throw graph::InputError("--method fixed and --method metis need --groups");
  if (method == PartitionMethod::fixed)
    return {graph::consecutive_partition(overlap.num_nodes(), *options.groups), {}};
  return {graph::metis_partition(overlap, *options.groups), {}};
}

std::vector<int> group_sizes(const graph::Labels& labels) {
  std::vector<int> sizes;
  for (const int label : labels) {
    if (static_cast<size_t>(label) >= sizes.size()) sizes.resize(static_cast<size_t>(label) + 1);
    ++sizes[static_cast<size_t>(label)];
  }
  return sizes;
}

int print_tau_sweep(const graph::WeightedGraph& overlap, graph::PartitionOptions options,
                    const std::string& csv_file, const Globals& globals) {
  std::string text = "  tau  groups  smallest  median  largest  k-way Ncut\n";
  std::string csv = "tau,groups,smallest,median,largest,kway_ncut\n";
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int step = 1; step <= 30; ++step) {
    options.tau = 0.05 * step;
    const auto labels = graph::recursive_partition(overlap, options, globals.threads).labels;
    const Summary s = summarize(overlap, labels);
    text += fmt::format("{:5.2f} {:7} {:9} {:7} {:8} {:11.4f}\n", options.tau, s.groups, s.smallest,
                        s.median, s.largest, s.kway_ncut);
    csv += fmt::format("{:.2f},{},{},{},{},{}\n", options.tau, s.groups, s.smallest, s.median,
                       s.largest, s.kway_ncut);
    rows.push_back(to_json(s));
    rows.back()["tau"] = options.tau;
  }
  if (!csv_file.empty()) submap::write_file(csv_file, csv);
  print_result(globals, {{"nodes", overlap.num_nodes()}, {"sweep", rows}}, text);
  return kDone;
}

int print_method_comparison(const graph::WeightedGraph& overlap, graph::PartitionOptions options,
                            const Globals& globals) {
  const graph::Labels ncut = graph::recursive_partition(overlap, options, globals.threads).labels;
  options.groups = static_cast<int>(group_sizes(ncut).size());
  std::string text =
      "method  groups  smallest  median  largest  k-way Ncut  adjusted Rand index to ncut\n";
  nlohmann::ordered_json methods = nlohmann::ordered_json::object();
  const auto add = [&](const char* name, const graph::Labels& labels) {
    const Summary s = summarize(overlap, labels);
    const double alike = graph::compare_partitions(ncut, labels).adjusted_rand_index;
    text += fmt::format("{:6} {:7} {:9} {:7} {:8} {:11.4f} {:28.4f}\n", name, s.groups, s.smallest,
                        s.median, s.largest, s.kway_ncut, alike);
    methods[name] = to_json(s);
    methods[name]["adjusted_rand_index"] = alike;
  };
  add("ncut", ncut);
  if (overlap.num_nodes() > 0) {
    add("fixed", partition_by(PartitionMethod::fixed, overlap, options, globals.threads).labels);
    add("metis", partition_by(PartitionMethod::metis, overlap, options, globals.threads).labels);
  }
  print_result(globals, {{"nodes", overlap.num_nodes()}, {"methods", methods}}, text);
  return kDone;
}

}  // namespace hmt::apps
