// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <set>
#include <string>

#include "cell_index.hpp"
#include "common_share.hpp"
#include "count_matches.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "sensed_points.hpp"

namespace hmt::submap {
namespace {

/// A block of consecutive keyframes is prepared at a time, so that memory does not grow with the
/// points of the log.
constexpr int kBlockSize = 256;

struct Block {
  int begin = 0;
  int end = 0;
  int size() const { return end - begin; }
};

/// The readings of one keyframe, one slot for each sensor of the log; no points where there is no
/// reading.
struct PreparedKeyframe {
  std::vector<SensedPoints> points;
  std::vector<bool> present;
};

struct Pair {
  int a = 0;
  int b = 0;
  double overlap = 0;
};

class OverlapGraphBuilder {
 public:
  OverlapGraphBuilder(std::span<const Keyframe> keyframes, std::span<const Pose> T_world_keyframe,
                      const PairCovariance& covariance, const ObservationStore& observations,
                      const OverlapOptions& options, const Run& run)
      : keyframes_(keyframes),
        T_world_keyframe_(T_world_keyframe),
        covariance_(covariance),
        observations_(observations),
        options_(options),
        run_(run),
        arena_(std::max(1, run.threads)) {}

  graph::WeightedGraph build() {
    index_cells();
    std::vector<graph::Arc> arcs;
    const int n = static_cast<int>(keyframes_.size());
    for (int begin = 0; begin < n; begin += kBlockSize) {
      add_arcs({begin, std::min(n, begin + kBlockSize)}, arcs);
      run_.report({"overlap", static_cast<double>(std::min(n, begin + kBlockSize)),
                   static_cast<double>(n)});
    }
    return {n, arcs};
  }

 private:
  Pose T_frame_keyframe(int keyframe) const {
    // Points are held as floats, so they are taken relative to the first keyframe.
    Pose T = T_world_keyframe_[static_cast<size_t>(keyframe)];
    T.translation -= T_world_keyframe_.front().translation;
    return T;
  }

  void find_sensors() {
    std::set<int> sensors;
    for (const Keyframe& keyframe : keyframes_) {
      for (const Reading& r : observations_.load(keyframe.observation)->readings) {
        sensors.insert(r.sensor);
      }
    }
    sensors_.assign(sensors.begin(), sensors.end());
  }

  template <typename Function>
  void parallel(int count, const Function& function) {
    if (run_.stop_requested()) throw Interrupted{};
    arena_.execute([&] { tbb::parallel_for(0, count, function); });
  }

  PreparedKeyframe prepare(int keyframe) const {
    const auto observation =
        observations_.load(keyframes_[static_cast<size_t>(keyframe)].observation);
    PreparedKeyframe prepared{std::vector<SensedPoints>(sensors_.size()),
                              std::vector<bool>(sensors_.size(), false)};
    for (const Reading& reading : observation->readings) {
      const auto slot = static_cast<size_t>(
          std::lower_bound(sensors_.begin(), sensors_.end(), reading.sensor) - sensors_.begin());
      if (prepared.present[slot]) continue;
      prepared.present[slot] = true;
      prepared.points[slot] =
          SensedPoints(reading, T_frame_keyframe(keyframe), options_.max_mahalanobis);
    }
    return prepared;
  }

  std::vector<PreparedKeyframe> prepare(const Block& block) {
    std::vector<PreparedKeyframe> prepared(static_cast<size_t>(block.size()));
    parallel(block.size(),
             [&](int i) { prepared[static_cast<size_t>(i)] = prepare(block.begin + i); });
    return prepared;
  }

  void index_cells() {
    find_sensors();
    const size_t n = keyframes_.size();
    std::vector<std::vector<std::vector<CellCount>>> cells(sensors_.size(),
                                                           std::vector<std::vector<CellCount>>(n));
    parallel(static_cast<int>(n), [&](int i) {
      const PreparedKeyframe prepared = prepare(i);
      for (size_t s = 0; s < sensors_.size(); ++s) {
        cells[s][static_cast<size_t>(i)] = count_cells(prepared.points[s]);
      }
    });
    const double pose_gate = options_.max_mahalanobis * options_.max_pose_deviation_m;
    for (auto& sensor_cells : cells)
      index_.emplace_back(std::move(sensor_cells), pose_gate * pose_gate);
  }

  std::vector<Pair> candidates(const Block& a, const Block& b) {
    std::vector<Pair> pairs;
    for (int i = a.begin; i < a.end; ++i) {
      std::set<int> others;
      for (const CellIndex& index : index_) {
        for (const CellIndex::Bound& bound : index.bounds(i)) {
          for (int j = std::max({bound.begin, b.begin, i + 1}); j < std::min(bound.end, b.end);
               ++j) {
            others.insert(j);
          }
        }
      }
      for (const int j : others) pairs.push_back({i, j, 0.0});
    }
    return pairs;
  }

  double overlap(const PreparedKeyframe& a, const PreparedKeyframe& b,
                 const PoseSpread& spread) const {
    double sum = 0;
    int sensors = 0;
    for (size_t s = 0; s < sensors_.size(); ++s) {
      if (!a.present[s] || !b.present[s]) continue;
      ++sensors;
      sum += sensed_space_overlap(a.points[s].size(), b.points[s].size(),
                                  count_matches(a.points[s], b.points[s], spread, options_),
                                  count_matches(b.points[s], a.points[s], spread, options_));
    }
    return sensors > 0 ? sum / sensors : 0.0;
  }

  void add_arcs(const Block& a, std::vector<graph::Arc>& arcs) {
    const std::vector<PreparedKeyframe> prepared_a = prepare(a);
    for (int begin = a.begin; begin < static_cast<int>(keyframes_.size()); begin += kBlockSize) {
      const Block b{begin, std::min(static_cast<int>(keyframes_.size()), begin + kBlockSize)};
      std::vector<Pair> pairs = candidates(a, b);
      if (pairs.empty()) continue;
      const std::vector<PreparedKeyframe> prepared_b = prepare(b);
      parallel(static_cast<int>(pairs.size()), [&](int p) {
        Pair& pair = pairs[static_cast<size_t>(p)];
        const std::optional<Matrix6d> covariance = covariance_(pair.a, pair.b);
        if (!covariance) return;
        pair.overlap = overlap(prepared_a[static_cast<size_t>(pair.a - a.begin)],
                               prepared_b[static_cast<size_t>(pair.b - b.begin)],
                               PoseSpread(T_frame_keyframe(pair.b), *covariance));
      });
      for (const Pair& pair : pairs) {
        if (pair.overlap > 0 && pair.overlap >= options_.min_overlap) {
          arcs.push_back({pair.a, pair.b, pair.overlap});
        }
      }
    }
  }

  std::span<const Keyframe> keyframes_;
  std::span<const Pose> T_world_keyframe_;
  const PairCovariance& covariance_;
  const ObservationStore& observations_;
  const OverlapOptions& options_;
  const Run& run_;
  tbb::task_arena arena_;
  std::vector<int> sensors_;
  std::vector<CellIndex> index_;
};

}  // namespace

graph::WeightedGraph overlap_graph(std::span<const Keyframe> keyframes,
                                   std::span<const Pose> T_world_keyframe,
                                   const PairCovariance& covariance,
                                   const ObservationStore& observations,
                                   const OverlapOptions& options, const Run& run) {
  check(options);
  if (keyframes.size() != T_world_keyframe.size()) {
    throw InputError("overlap_graph: " + std::to_string(keyframes.size()) + " keyframes, but " +
                     std::to_string(T_world_keyframe.size()) + " poses");
  }
  for (const Pose& pose : T_world_keyframe) check_finite(pose);
  return OverlapGraphBuilder(keyframes, T_world_keyframe, covariance, observations, options, run)
      .build();
}

}  // namespace hmt::submap
