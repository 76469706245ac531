// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "partition_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

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
  std::optional<double> information_loss;
  std::optional<PartitionInput::LandmarkLoss> landmarks;
};

Summary summarize(const PartitionInput& input, const graph::Labels& labels) {
  std::vector<int> sizes = group_sizes(labels);
  if (sizes.empty()) return {};
  std::sort(sizes.begin(), sizes.end());
  return {sizes.size(),
          sizes.front(),
          sizes[sizes.size() / 2],
          sizes.back(),
          graph::kway_ncut(input.overlap, labels),
          input.information_loss(labels),
          input.landmark_loss(labels)};
}

nlohmann::ordered_json to_json(const Summary& s) {
  nlohmann::ordered_json json = {{"groups", s.groups},
                                 {"smallest", s.smallest},
                                 {"median", s.median},
                                 {"largest", s.largest},
                                 {"kway_ncut", s.kway_ncut}};
  if (s.information_loss) json["information_loss"] = *s.information_loss;
  if (s.landmarks) {
    json["landmark_information_loss"] = s.landmarks->information_loss;
    json["landmark_copies"] = s.landmarks->copies;
  }
  return json;
}

const char* const kColumns = "  groups  smallest  median  largest  k-way Ncut";

std::string columns(const PartitionInput& input) {
  std::string text = kColumns;
  if (input.information) text += "  information loss";
  if (input.landmark_information) text += "  of landmarks  copies of each";
  return text;
}

std::string row(const Summary& s) {
  std::string text = fmt::format("{:8} {:9} {:7} {:8} {:11.4f}", s.groups, s.smallest, s.median,
                                 s.largest, s.kway_ncut);
  if (s.information_loss) text += fmt::format(" {:17.6f}", *s.information_loss);
  if (s.landmarks)
    text += fmt::format(" {:13.6f} {:15.2f}", s.landmarks->information_loss, s.landmarks->copies);
  return text;
}

std::string csv_row(const Summary& s) {
  std::string text =
      fmt::format("{},{},{},{},{}", s.groups, s.smallest, s.median, s.largest, s.kway_ncut);
  if (s.information_loss) text += fmt::format(",{}", *s.information_loss);
  if (s.landmarks)
    text += fmt::format(",{},{}", s.landmarks->information_loss, s.landmarks->copies);
  return text;
}

/// What grows from keyframe to keyframe by the method.
std::vector<double> along(PartitionMethod method, const PartitionInput& input) {
  if (method == PartitionMethod::fixed) {
    std::vector<double> index(static_cast<size_t>(input.overlap.num_nodes()));
    std::iota(index.begin(), index.end(), 0.0);
    return index;
  }
  if (!input.information)
    throw graph::InputError(
        "a matrix has neither poses nor stamps: --method distance and --method "
        "time need a map or a log");
  return method == PartitionMethod::distance ? input.metres : input.seconds;
}

graph::Labels cut_into_runs(const MethodChoice& choice, const PartitionInput& input,
                            const std::optional<int>& groups) {
  const std::vector<double> grown = along(choice.method, input);
  if (choice.every) return graph::runs_of_length(grown, *choice.every);
  if (!groups)
    throw graph::InputError(
        "--method fixed, distance and time need --groups or --every, the length of a group");
  if (choice.method == PartitionMethod::fixed)
    return graph::consecutive_partition(input.overlap.num_nodes(), *groups);
  return graph::runs_of_equal_length(grown, *groups);
}

}  // namespace

graph::PartitionResult partition_by(const MethodChoice& choice, const PartitionInput& input,
                                    const graph::PartitionOptions& options, int threads) {
  const bool in_runs =
      choice.method != PartitionMethod::ncut && choice.method != PartitionMethod::metis;
  if (in_runs) return {cut_into_runs(choice, input, options.groups), {}};
  if (choice.every)
    throw graph::InputError("--every goes with --method fixed, distance and time only");
  if (choice.method == PartitionMethod::ncut)
    return graph::recursive_partition(input.overlap, options, threads);
  if (!options.groups) throw graph::InputError("--method metis needs --groups");
  return {graph::metis_partition(input.overlap, *options.groups), {}};
}

std::vector<int> group_sizes(const graph::Labels& labels) {
  std::vector<int> sizes;
  for (const int label : labels) {
    if (static_cast<size_t>(label) >= sizes.size()) sizes.resize(static_cast<size_t>(label) + 1);
    ++sizes[static_cast<size_t>(label)];
  }
  return sizes;
}

int print_tau_sweep(const PartitionInput& input, graph::PartitionOptions options,
                    const std::string& csv_file, const Globals& globals) {
  std::string text = "  tau" + columns(input) + "\n";
  std::string csv = "tau,groups,smallest,median,largest,kway_ncut";
  if (input.information) csv += ",information_loss";
  if (input.landmark_information) csv += ",landmark_information_loss,landmark_copies";
  csv += "\n";
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int step = 1; step <= 30; ++step) {
    options.tau = 0.05 * step;
    const auto labels = graph::recursive_partition(input.overlap, options, globals.threads).labels;
    const Summary s = summarize(input, labels);
    text += fmt::format("{:5.2f}{}\n", options.tau, row(s));
    csv += fmt::format("{:.2f},{}\n", options.tau, csv_row(s));
    rows.push_back(to_json(s));
    rows.back()["tau"] = options.tau;
  }
  if (!csv_file.empty()) submap::write_file(csv_file, csv);
  print_result(globals, {{"nodes", input.overlap.num_nodes()}, {"sweep", rows}}, text);
  return kDone;
}

int print_method_comparison(const PartitionInput& input, graph::PartitionOptions options,
                            const Globals& globals) {
  const graph::Labels ncut =
      graph::recursive_partition(input.overlap, options, globals.threads).labels;
  options.groups = static_cast<int>(group_sizes(ncut).size());
  std::string text = "method  " + columns(input) + "  adjusted Rand index to ncut\n";
  nlohmann::ordered_json methods = nlohmann::ordered_json::object();
  const auto add = [&](const char* name, const graph::Labels& labels) {
    const Summary s = summarize(input, labels);
    const double alike = graph::compare_partitions(ncut, labels).adjusted_rand_index;
    text += fmt::format("{:8}{} {:28.4f}\n", name, row(s), alike);
    methods[name] = to_json(s);
    methods[name]["adjusted_rand_index"] = alike;
  };
  const auto add_method = [&](const char* name, PartitionMethod method) {
    add(name, partition_by({method, {}}, input, options, globals.threads).labels);
  };
  add("ncut", ncut);
  if (input.overlap.num_nodes() > 0) {
    add_method("fixed", PartitionMethod::fixed);
    if (input.information) {
      add_method("distance", PartitionMethod::distance);
      add_method("time", PartitionMethod::time);
    }
    add_method("metis", PartitionMethod::metis);
  }
  print_result(globals, {{"nodes", input.overlap.num_nodes()}, {"methods", methods}}, text);
  return kDone;
}

}  // namespace hmt::apps
