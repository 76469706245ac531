// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Growth of the partition with the graph, beside a plain recursion in the same run.
// Usage: partition_benchmark [MAX_NODES] [THREADS] [MAX_NODES_OF_THE_PLAIN_RECURSION]

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "hmt/graph/partition.hpp"
#include "plain_recursion.hpp"
#include "synthetic_graphs.hpp"

namespace hmt::benchmarks {
namespace {

constexpr double kTau = 2.0 / 3.0;

struct Timing {
  double wall_s = 0;
  double cpu_s = 0;
};

template <class Work>
Timing measure(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC};
}

graph::WeightedGraph make(const std::string& kind, int nodes) {
  if (kind == "grid") return grid(static_cast<int>(std::lround(std::sqrt(nodes))));
  return ring_or_chain(nodes, 10, kind == "ring");
}

double peak_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void run(const std::string& kind, int nodes, int threads, int max_plain) {
  const graph::WeightedGraph graph = make(kind, nodes);
  graph::PartitionOptions options;
  options.tau = kTau;
  graph::PartitionResult result;
  const Timing ours =
      measure([&] { result = graph::recursive_partition(graph, options, threads); });
  const int groups = *std::max_element(result.labels.begin(), result.labels.end()) + 1;
  std::printf("| %s | %d | %lld | %d | %.6g | %.3f | %.3f | %.0f |", kind.c_str(),
              graph.num_nodes(), static_cast<long long>(graph.num_arcs()), groups,
              result.bisections.at(0).ncut, ours.wall_s, ours.cpu_s, peak_mb());
  if (nodes <= max_plain) {
    PlainResult plain;
    const Timing theirs = measure([&] { plain = plain_recursion(graph, kTau); });
    std::printf(" %d | %.6g | %.3f | %.3f | %.1f | %.1f |\n", plain.groups, plain.top_ncut,
                theirs.wall_s, theirs.cpu_s, theirs.wall_s / ours.wall_s,
                theirs.cpu_s / ours.cpu_s);
  } else {
    std::printf(" | | | | | |\n");
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace hmt::benchmarks

int main(int argc, char** argv) {
  const int max_nodes = argc > 1 ? std::atoi(argv[1]) : 1000000;
  const int threads = argc > 2 ? std::atoi(argv[2]) : 2;
  const int max_plain = argc > 3 ? std::atoi(argv[3]) : 100000;
  std::printf(
      "| graph | nodes | arcs | groups | top Ncut | wall s | CPU s | peak MB so far "
      "| plain: groups | top Ncut | wall s | CPU s | wall ratio | CPU ratio |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const char* kind : {"ring", "chain", "grid"})
    for (int nodes = 1000; nodes <= max_nodes; nodes *= 10)
      hmt::benchmarks::run(kind, nodes, threads, max_plain);
}
