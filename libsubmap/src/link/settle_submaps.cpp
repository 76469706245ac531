// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/settle_submaps.hpp"

#include <algorithm>
#include <set>

#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/local/optimize_submap.hpp"

namespace hmt::submap {
namespace {

// Each round leaves a few per cent of what the one before left (simulated corridors).
constexpr int kRounds = 3;

/// Each submap with those that a constraint ties to it.
std::vector<std::set<size_t>> neighborhoods(size_t submaps, std::span<const int> submap_of,
                                            std::span<const Constraint> constraints) {
  std::vector<std::set<size_t>> near(submaps);
  for (size_t s = 0; s < submaps; ++s) near[s].insert(s);
  for (const Constraint& c : constraints) {
    const auto a = static_cast<size_t>(submap_of[static_cast<size_t>(c.a)]);
    const auto b = static_cast<size_t>(submap_of[static_cast<size_t>(c.b)]);
    near[a].insert(b);
    near[b].insert(a);
  }
  return near;
}

/// Optimizes the keyframes of some submaps in place; the other ends of their constraints stay.
/// `touching`: for each submap the indices of the constraints with an end in it.
void bend(Space space, std::span<const Submap> submaps, const std::set<size_t>& members,
          std::span<const int> submap_of, std::span<const std::vector<size_t>> touching,
          std::span<const Constraint> all_constraints, std::vector<Pose>& T_world_keyframe) {
  std::set<int> all;
  std::set<size_t> used;
  for (const size_t s : members) {
    all.insert(submaps[s].keyframes.begin(), submaps[s].keyframes.end());
    used.insert(touching[s].begin(), touching[s].end());
  }
  const auto is_member = [&](int keyframe) {
    return members.contains(static_cast<size_t>(submap_of[static_cast<size_t>(keyframe)]));
  };
  std::vector<Constraint> constraints;
  for (const size_t c : used) constraints.push_back(all_constraints[c]);
  for (const Constraint& c : constraints) all.insert({c.a, c.b});
  const std::vector<int> nodes(all.begin(), all.end());
  std::vector<Pose> poses;
  for (const int k : nodes) poses.push_back(T_world_keyframe[static_cast<size_t>(k)]);
  graph::PoseGraph graph = keyframe_graph(space, nodes, poses, constraints);
  for (size_t n = 0; n < nodes.size(); ++n)
    if (!is_member(nodes[n]) || nodes[n] == 0) graph.fixed.push_back(static_cast<int>(n));
  if (graph.fixed.empty()) graph.fixed.push_back(0);
  const std::vector<Pose> bent = graph::optimize(graph, {}).poses;
  for (size_t n = 0; n < nodes.size(); ++n)
    T_world_keyframe[static_cast<size_t>(nodes[n])] = bent[n];
}

/// The constraint as one between the frames of the two submaps, its ends at their present places.
graph::PoseGraphEdge between_frames(const Constraint& c, const std::vector<int>& submap_of,
                                    std::span<const Pose> T_submap_keyframe) {
  const auto a = static_cast<size_t>(c.a);
  const auto b = static_cast<size_t>(c.b);
  const Pose to_b_frame = T_submap_keyframe[b].inverse();
  const Matrix6d Ad = graph::adjoint(to_b_frame);
  return {submap_of[a], submap_of[b], T_submap_keyframe[a] * c.T_a_b * to_b_frame,
          Ad.transpose() * c.information * Ad};
}

/// Moves the submaps as they are, rigid, to where the constraints between them agree best: what
/// passing from neighbor to neighbor would spread over a long chain only slowly.
void shift(Space space, std::span<const Submap> submaps, std::span<const Constraint> constraints,
           std::vector<Pose>& T_world_keyframe) {
  graph::PoseGraph graph;
  graph.space = space;
  std::vector<int> submap_of(T_world_keyframe.size());
  std::vector<Pose> T_submap_keyframe(T_world_keyframe.size());
  for (size_t s = 0; s < submaps.size(); ++s) {
    graph.poses.push_back(T_world_keyframe[static_cast<size_t>(submaps[s].keyframes.front())]);
    for (const int k : submaps[s].keyframes) {
      const auto i = static_cast<size_t>(k);
      submap_of[i] = static_cast<int>(s);
      T_submap_keyframe[i] = graph::relative_pose(graph.poses.back(), T_world_keyframe[i]);
    }
  }
  for (const Constraint& c : constraints)
    if (submap_of[static_cast<size_t>(c.a)] != submap_of[static_cast<size_t>(c.b)])
      graph.edges.push_back(between_frames(c, submap_of, T_submap_keyframe));
  graph.fixed = {0};
  const std::vector<Pose> shifted = graph::optimize(graph, {}).poses;
  for (size_t i = 0; i < T_world_keyframe.size(); ++i)
    T_world_keyframe[i] = shifted[static_cast<size_t>(submap_of[i])] * T_submap_keyframe[i];
}

}  // namespace

std::vector<Pose> settle_submaps(Space space, std::span<const Submap> submaps,
                                 std::span<const Pose> T_world_submap,
                                 std::span<const Constraint> constraints) {
  size_t keyframes = 0;
  for (const Submap& submap : submaps) keyframes += submap.keyframes.size();
  std::vector<Pose> T_world_keyframe(keyframes);
  for (size_t s = 0; s < submaps.size(); ++s)
    for (size_t k = 0; k < submaps[s].keyframes.size(); ++k)
      T_world_keyframe[static_cast<size_t>(submaps[s].keyframes[k])] =
          T_world_submap[s] * submaps[s].T_submap_keyframe[k];
  std::vector<int> submap_of(keyframes);
  for (size_t s = 0; s < submaps.size(); ++s)
    for (const int k : submaps[s].keyframes)
      submap_of[static_cast<size_t>(k)] = static_cast<int>(s);
  std::vector<std::vector<size_t>> touching(submaps.size());
  for (size_t c = 0; c < constraints.size(); ++c)
    for (const int k : {constraints[c].a, constraints[c].b})
      touching[static_cast<size_t>(submap_of[static_cast<size_t>(k)])].push_back(c);
  const auto near = neighborhoods(submaps.size(), submap_of, constraints);
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) shift(space, submaps, constraints, T_world_keyframe);
    for (size_t s = 0; s < submaps.size(); ++s)
      bend(space, submaps, near[s], submap_of, touching, constraints, T_world_keyframe);
  }
  return T_world_keyframe;
}

}  // namespace hmt::submap
