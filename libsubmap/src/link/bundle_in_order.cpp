// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/bundle_in_order.hpp"

#include <algorithm>
#include <numeric>

#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/local/optimize_submap.hpp"

namespace hmt::submap {
namespace {

/// Keyframes that are added before the next optimization: a few, and a share of those there are.
constexpr size_t kLeastGrowth = 10;
constexpr size_t kGrowthShare = 20;
/// Of one optimization; the next one goes on from where it ended.
constexpr int kIterations = 10;

}  // namespace

std::vector<Pose> bundle_in_order(const Track& track, std::span<const Sighting> sightings,
                                  const Run& run) {
  const size_t all = track.keyframes.size();
  std::vector<int> keyframes(all);
  std::iota(keyframes.begin(), keyframes.end(), 0);
  graph::PoseOptimizerOptions options;
  options.robust = graph::RobustMethod::huber;
  options.threads = run.threads;
  options.max_iterations = kIterations;
  std::vector<Pose> T_world_keyframe = {track.keyframes.front().T_track_robot};
  for (size_t done = 1; done < all;) {
    if (run.stop_requested()) throw Interrupted{};
    done = std::min(all, done + std::max(kLeastGrowth, done / kGrowthShare));
    for (size_t k = T_world_keyframe.size(); k < done; ++k)
      T_world_keyframe.push_back(T_world_keyframe.back() * track.odometry[k - 1].T_a_b);
    graph::PoseGraph graph =
        keyframe_graph(track.space, std::span<const int>(keyframes).first(done), T_world_keyframe,
                       track.odometry, sightings);
    graph.fixed = {0};
    T_world_keyframe = graph::optimize(graph, options).poses;
    run.report({"bundle", static_cast<double>(done), static_cast<double>(all)});
  }
  return T_world_keyframe;
}

}  // namespace hmt::submap
