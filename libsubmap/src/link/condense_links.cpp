// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/condense_links.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "hmt/graph/normalized_cut.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/local/optimize_submap.hpp"

namespace hmt::submap {
namespace {

using Pair = std::pair<int, int>;

/// What joins two submaps.
struct Evidence {
  std::vector<int> constraints;  ///< across the cut
  std::vector<int> landmarks;    ///< that both saw
};

std::map<Pair, Evidence> evidence_by_pair(const graph::Labels& submap_of_keyframe,
                                          std::span<const Constraint> constraints,
                                          std::span<const Submap> submaps) {
  std::map<Pair, Evidence> evidence;
  for (size_t c = 0; c < constraints.size(); ++c) {
    const int a = submap_of_keyframe[static_cast<size_t>(constraints[c].a)];
    const int b = submap_of_keyframe[static_cast<size_t>(constraints[c].b)];
    if (a != b) evidence[std::minmax(a, b)].constraints.push_back(static_cast<int>(c));
  }
  std::map<int, std::vector<int>> submaps_of;  // by landmark
  for (const Submap& submap : submaps)
    for (const PlacedLandmark& l : submap.landmarks) submaps_of[l.landmark].push_back(submap.id);
  for (const auto& [landmark, by] : submaps_of)
    for (size_t i = 0; i < by.size(); ++i)
      for (size_t j = i + 1; j < by.size(); ++j)
        evidence[std::minmax(by[i], by[j])].landmarks.push_back(landmark);
  return evidence;
}

/// T_a_b by one constraint alone, from the poses of its two keyframes in their submaps.
Pose frames_by_constraint(const Submap& a, const Submap& b, const Constraint& c) {
  const auto pose_in = [](const Submap& submap, int keyframe) -> std::optional<Pose> {
    const auto at = std::lower_bound(submap.keyframes.begin(), submap.keyframes.end(), keyframe);
    if (at == submap.keyframes.end() || *at != keyframe) return std::nullopt;
    return submap.T_submap_keyframe[static_cast<size_t>(at - submap.keyframes.begin())];
  };
  if (const auto T_a_i = pose_in(a, c.a)) return *T_a_i * c.T_a_b * pose_in(b, c.b)->inverse();
  return *pose_in(a, c.b) * c.T_a_b.inverse() * pose_in(b, c.a)->inverse();
}

/// The constraint that leaves the least unknown.
const Constraint& firmest(std::span<const Constraint> constraints, const std::vector<int>& evidence,
                          Space space) {
  const auto best = std::max_element(evidence.begin(), evidence.end(), [&](int l, int r) {
    return firmness(constraints[static_cast<size_t>(l)], space) <
           firmness(constraints[static_cast<size_t>(r)], space);
  });
  return constraints[static_cast<size_t>(*best)];
}

/// T_a_b that brings the landmarks of both submaps together; nothing where they are too few.
std::optional<Pose> frames_by_landmarks(Space space, const Submap& a, const Submap& b,
                                        const std::vector<int>& landmarks) {
  const auto size = static_cast<Eigen::Index>(landmarks.size());
  const Eigen::Index dimension = space == Space::se2 ? 2 : 3;
  if (size < dimension) return std::nullopt;
  const auto positions = [&](const Submap& submap) {
    Eigen::MatrixXd points(dimension, size);
    Eigen::Index column = 0;
    for (const PlacedLandmark& l : submap.landmarks)
      if (std::binary_search(landmarks.begin(), landmarks.end(), l.landmark))
        points.col(column++) = l.position.head(dimension);
    return points;
  };
  const Eigen::MatrixXd T = Eigen::umeyama(positions(b), positions(a), false);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner(dimension, dimension) = T.topLeftCorner(dimension, dimension);
  Pose T_a_b;
  T_a_b.rotation = Eigen::Quaterniond(R).normalized();
  T_a_b.translation.head(dimension) = T.topRightCorner(dimension, 1);
  return T_a_b;
}

/// The pose graph of two submaps in the frame of the first: nodes of a, then nodes of b.
graph::PoseGraph joint_graph(Space space, const Submap& a, const Submap& b, const Pose& T_a_b,
                             std::span<const Constraint> constraints,
                             const std::vector<int>& evidence,
                             std::span<const std::vector<Sighting>> sightings) {
  std::vector<std::pair<int, Pose>> nodes;
  for (size_t k = 0; k < a.keyframes.size(); ++k)
    nodes.emplace_back(a.keyframes[k], a.T_submap_keyframe[k]);
  for (size_t k = 0; k < b.keyframes.size(); ++k)
    nodes.emplace_back(b.keyframes[k], T_a_b * b.T_submap_keyframe[k]);
  std::sort(nodes.begin(), nodes.end(),
            [](const auto& l, const auto& r) { return l.first < r.first; });
  std::vector<int> keyframes;
  std::vector<Pose> poses;
  for (const auto& [keyframe, pose] : nodes) {
    keyframes.push_back(keyframe);
    poses.push_back(pose);
  }
  std::vector<Constraint> used;
  for (const std::vector<int>* ids : {&a.constraints, &b.constraints, &evidence})
    for (const int c : *ids) used.push_back(constraints[static_cast<size_t>(c)]);
  std::vector<Sighting> seen = sightings[static_cast<size_t>(a.id)];
  const std::vector<Sighting>& seen_from_b = sightings[static_cast<size_t>(b.id)];
  seen.insert(seen.end(), seen_from_b.begin(), seen_from_b.end());
  return keyframe_graph(space, keyframes, poses, used, seen);
}

int node_of(const Submap& a, const Submap& b, int keyframe) {
  const auto before = [keyframe](const Submap& s) {
    return std::lower_bound(s.keyframes.begin(), s.keyframes.end(), keyframe) - s.keyframes.begin();
  };
  return static_cast<int>(before(a) + before(b));
}

/// Nothing if what joins the submaps does not fix the relative pose of the two frames.
std::optional<Link> condense(Space space, const Submap& a, const Submap& b,
                             std::span<const Constraint> constraints, const Evidence& evidence,
                             std::span<const std::vector<Sighting>> sightings) {
  const std::optional<Pose> start =
      evidence.constraints.empty()
          ? frames_by_landmarks(space, a, b, evidence.landmarks)
          : frames_by_constraint(a, b, firmest(constraints, evidence.constraints, space));
  if (!start) return std::nullopt;
  graph::PoseGraph graph =
      joint_graph(space, a, b, *start, constraints, evidence.constraints, sightings);
  const int frame_a = node_of(a, b, a.keyframes.front());
  const int frame_b = node_of(a, b, b.keyframes.front());
  graph.fixed = {frame_a};
  const graph::PoseOptimizerResult optimized = graph::optimize(graph, {});
  graph.poses = optimized.poses;
  graph.points = optimized.points;
  const auto covariance = graph::PoseCovariance(graph).marginal(frame_b);
  if (!covariance) return std::nullopt;
  Link link;
  link.a = a.id;
  link.b = b.id;
  link.T_a_b = relative_pose(graph.poses[static_cast<size_t>(frame_a)],
                             graph.poses[static_cast<size_t>(frame_b)]);
  link.covariance = *covariance;
  link.evidence = evidence.constraints;
  link.landmarks = evidence.landmarks;
  return link;
}

/// Ncut of every pair of groups that arcs join, in one pass over Omega; see graph::Cut.
std::map<Pair, double> ncut_by_pair(const graph::WeightedGraph& overlap,
                                    const graph::Labels& labels, size_t groups) {
  std::vector<double> inside(groups, 0);
  std::map<Pair, double> cut;
  for (const graph::Arc& arc : overlap.arcs()) {
    const int a = labels[static_cast<size_t>(arc.a)];
    const int b = labels[static_cast<size_t>(arc.b)];
    if (a == b) inside[static_cast<size_t>(a)] += 2 * arc.weight;
    if (a != b) cut[std::minmax(a, b)] += arc.weight;
  }
  for (auto& [pair, weight] : cut)
    weight = graph::Cut{weight, weight + inside[static_cast<size_t>(pair.first)],
                        weight + inside[static_cast<size_t>(pair.second)]}
                 .ncut();
  return cut;
}

}  // namespace

std::vector<Link> condense_links(Space space, std::span<const Submap> submaps,
                                 const graph::Labels& submap_of_keyframe,
                                 std::span<const Constraint> constraints,
                                 std::span<const Sighting> sightings,
                                 const graph::WeightedGraph& overlap, const Run& run) {
  const auto by_pair = evidence_by_pair(submap_of_keyframe, constraints, submaps);
  const std::vector<std::pair<Pair, Evidence>> pairs(by_pair.begin(), by_pair.end());
  std::vector<std::vector<Sighting>> from_submap(submaps.size());
  for (const Sighting& s : sightings)
    from_submap[static_cast<size_t>(submap_of_keyframe[static_cast<size_t>(s.keyframe)])].push_back(
        s);
  std::vector<std::optional<Link>> slots(pairs.size());
  tbb::task_arena arena(run.threads);
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, pairs.size(), [&](size_t k) {
      const auto& [pair, evidence] = pairs[k];
      slots[k] =
          condense(space, submaps[static_cast<size_t>(pair.first)],
                   submaps[static_cast<size_t>(pair.second)], constraints, evidence, from_submap);
    });
  });
  const auto ncut = ncut_by_pair(overlap, submap_of_keyframe, submaps.size());
  std::vector<Link> links;
  for (const auto& slot : slots) {
    if (!slot) continue;
    links.push_back(*slot);
    const auto at = ncut.find({slot->a, slot->b});
    if (at != ncut.end()) links.back().ncut = at->second;
  }
  return links;
}

graph::PoseGraph submap_graph(Space space, std::span<const Pose> T_world_submap,
                              std::span<const Link> links) {
  graph::PoseGraph graph;
  graph.space = space;
  graph.poses.assign(T_world_submap.begin(), T_world_submap.end());
  for (const Link& link : links) {
    Matrix6d covariance = link.covariance;
    // Directions that the plane does not have are zero; one keeps the inverse finite and is not
    // used.
    if (space == Space::se2) covariance.diagonal().segment<3>(2).setOnes();
    const Matrix6d information = covariance.inverse();
    graph.edges.push_back(
        {link.a, link.b, link.T_a_b, (information + information.transpose()) / 2});
  }
  if (!graph.poses.empty()) graph.fixed = {0};
  return graph;
}

}  // namespace hmt::submap
