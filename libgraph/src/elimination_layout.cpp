// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "elimination_layout.hpp"

#include <utility>

#include "elimination_order.hpp"
#include "pose_factor.hpp"

namespace hmt::graph {
namespace {

/// The unknowns by number: free nodes, then points that are measured.
struct Unknowns {
  std::vector<int> node;
  std::vector<int> point;
  std::vector<int> rows;  ///< of each unknown

  Unknowns(const PoseGraph& graph, const std::vector<bool>& held)
      : node(graph.poses.size(), -1), point(graph.points.size(), -1) {
    const auto [node_rows, point_rows] = with_chart(graph.space, [](auto chart) {
      return std::pair{decltype(chart)::kTangent, decltype(chart)::kPoint};
    });
    for (size_t k = 0; k < held.size(); ++k)
      if (!held[k]) node[k] = add(node_rows);
    std::vector<bool> measured(graph.points.size(), false);
    for (const PointEdge& edge : graph.point_edges)
      measured[static_cast<size_t>(edge.point)] = true;
    for (size_t k = 0; k < measured.size(); ++k)
      if (measured[k]) point[k] = add(point_rows);
  }

 private:
  int add(int unknown_rows) {
    rows.push_back(unknown_rows);
    return static_cast<int>(rows.size()) - 1;
  }
};

std::vector<std::pair<int, int>> couplings_of(const PoseGraph& graph, const Unknowns& unknowns) {
  std::vector<std::pair<int, int>> couplings;
  couplings.reserve(graph.edges.size() + graph.point_edges.size());
  for (const PoseGraphEdge& edge : graph.edges)
    couplings.emplace_back(unknowns.node[static_cast<size_t>(edge.from)],
                           unknowns.node[static_cast<size_t>(edge.to)]);
  for (const PointEdge& edge : graph.point_edges)
    couplings.emplace_back(unknowns.node[static_cast<size_t>(edge.node)],
                           unknowns.point[static_cast<size_t>(edge.point)]);
  return couplings;
}

}  // namespace

EliminationLayout elimination_layout(const PoseGraph& graph, const std::vector<bool>& held) {
  const Unknowns unknowns(graph, held);
  EliminationLayout layout;
  std::vector<int> first_row(unknowns.rows.size());
  const auto count = static_cast<int>(unknowns.rows.size());
  for (const int unknown : elimination_order(count, couplings_of(graph, unknowns))) {
    first_row[static_cast<size_t>(unknown)] = layout.size;
    layout.size += unknowns.rows[static_cast<size_t>(unknown)];
  }
  const auto to_rows = [&first_row](std::vector<int> numbers) {
    for (int& number : numbers)
      if (number >= 0) number = first_row[static_cast<size_t>(number)];
    return numbers;
  };
  layout.node = to_rows(unknowns.node);
  layout.point = to_rows(unknowns.point);
  return layout;
}

}  // namespace hmt::graph
