// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/find_route.hpp"

#include <algorithm>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/dijkstra_shortest_paths.hpp>
#include <cmath>
#include <utility>

#include "hmt/graph/pose_covariance.hpp"
#include "whole_map.hpp"

namespace hmt::submap {
namespace {

using WayGraph =
    boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS, boost::no_property,
                          boost::property<boost::edge_weight_t, double>>;

double distance(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm();
}

double distance(const Place& place, const Pose& T_world_keyframe) {
  const Eigen::Vector3d& p = T_world_keyframe.translation;
  return std::hypot(place.x_m - p.x(), place.y_m - p.y(), place.z_m ? *place.z_m - p.z() : 0);
}

/// The nearest keyframe to a place, and how far it is.
std::pair<int, double> nearest(const Place& place, const std::vector<Pose>& T_world_keyframe) {
  if (!std::isfinite(place.x_m) || !std::isfinite(place.y_m) ||
      !std::isfinite(place.z_m.value_or(0)))
    throw InputError("route: a place is not finite");
  std::pair<int, double> best = {0, distance(place, T_world_keyframe.front())};
  for (size_t k = 1; k < T_world_keyframe.size(); ++k)
    if (const double d = distance(place, T_world_keyframe[k]); d < best.second)
      best = {static_cast<int>(k), d};
  return best;
}

WayGraph ways(const HybridMap& map, const std::vector<Pose>& T_world_keyframe) {
  WayGraph graph(T_world_keyframe.size());
  for (size_t k = 0; k + 1 < T_world_keyframe.size(); ++k)
    boost::add_edge(k, k + 1, distance(T_world_keyframe[k], T_world_keyframe[k + 1]), graph);
  for (const Constraint& c : map.constraints) {
    const auto a = static_cast<size_t>(c.a);
    const auto b = static_cast<size_t>(c.b);
    if (const double d = distance(T_world_keyframe[a], T_world_keyframe[b]); d <= kPassable_m)
      boost::add_edge(a, b, d, graph);
  }
  return graph;
}

/// The keyframes of the shortest way; consecutive keyframes are joined, so there is one.
std::vector<int> shortest_way(const WayGraph& graph, int start, int goal) {
  // From the goal, so that the predecessors lead from the start on.
  std::vector<size_t> next(boost::num_vertices(graph));
  boost::dijkstra_shortest_paths(graph, static_cast<size_t>(goal),
                                 boost::predecessor_map(next.data()));
  std::vector<int> way = {start};
  while (way.back() != goal) way.push_back(static_cast<int>(next[static_cast<size_t>(way.back())]));
  return way;
}

void add_covariances(const HybridMap& map, const std::vector<Pose>& T_world_keyframe, int threads,
                     Route& route) {
  const graph::PoseCovariance covariance(
      graph_of_all(map.track, T_world_keyframe, map.constraints, map.sightings));
  std::vector<std::pair<int, int>> pairs;
  for (const RouteStep& step : route.steps)
    pairs.emplace_back(route.steps.front().keyframe, step.keyframe);
  const auto relative = covariance.relative(pairs, threads);
  for (size_t k = 1; k < route.steps.size(); ++k) {
    if (!relative[k])
      throw InputError("route: the constraints of the map do not tie keyframes " +
                       std::to_string(pairs[k].first) + " and " + std::to_string(pairs[k].second));
    route.steps[k].covariance = *relative[k];
  }
}

}  // namespace

Route find_route(const HybridMap& map, const Place& start, const Place& goal, int threads) {
  const std::vector<Pose> T_world_keyframe = keyframe_poses(map);
  const auto [first, start_distance_m] = nearest(start, T_world_keyframe);
  const auto [last, goal_distance_m] = nearest(goal, T_world_keyframe);
  Route route{{}, start_distance_m, goal_distance_m};
  for (const int keyframe : shortest_way(ways(map, T_world_keyframe), first, last)) {
    const auto k = static_cast<size_t>(keyframe);
    RouteStep step{keyframe, map.submap_of_keyframe[k], T_world_keyframe[k], 0, Matrix6d::Zero()};
    if (!route.steps.empty())
      step.length_m = route.steps.back().length_m +
                      distance(route.steps.back().T_world_keyframe, step.T_world_keyframe);
    route.steps.push_back(step);
  }
  add_covariances(map, T_world_keyframe, threads, route);
  return route;
}

}  // namespace hmt::submap
