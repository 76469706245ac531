// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "hmt/graph/weighted_graph.hpp"

namespace hmt::benchmarks {

/// Weight of two observations `distance` apart: falls off with the distance, with up to 10 % of
/// noise.
inline double noisy_weight(double distance, std::mt19937& random) {
  const double noise = static_cast<double>(random()) / 4294967296.0;
  return std::exp(-distance / 4) * (1 - 0.1 * noise);
}

/// Every node joined to the `reach` next ones; closed to a ring or open (a chain).
inline graph::WeightedGraph ring_or_chain(int nodes, int reach, bool ring) {
  std::mt19937 random(1);
  std::vector<graph::Arc> arcs;
  for (int i = 0; i < nodes; ++i)
    for (int k = 1; k <= reach; ++k)
      if (ring || i + k < nodes) arcs.push_back({i, (i + k) % nodes, noisy_weight(k, random)});
  return {nodes, arcs};
}

/// A square grid in which every node is joined to the others of the 5 x 5 nodes around it.
inline graph::WeightedGraph grid(int side) {
  std::mt19937 random(1);
  std::vector<graph::Arc> arcs;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int dy = 0; dy <= 2; ++dy)
        for (int dx = dy == 0 ? 1 : -2; dx <= 2; ++dx)
          if (x + dx >= 0 && x + dx < side && y + dy < side)
            arcs.push_back(
                {y * side + x, (y + dy) * side + x + dx, noisy_weight(std::hypot(dx, dy), random)});
  return {side * side, arcs};
}

}  // namespace hmt::benchmarks
