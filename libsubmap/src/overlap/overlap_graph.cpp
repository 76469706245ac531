// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <string>

#include "cell_index.hpp"
#include "common_share.hpp"
#include "count_matches.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "keyframe_points.hpp"
#include "packed_covariance.hpp"

namespace hmt::submap {
namespace {

size_t at(int i) {
  return static_cast<size_t>(i);
}

// Two blocks of consecutive keyframes are held at a time, so that memory does not grow with the
// points of the log: some 100 MB for the points and 100 MB for the pairs by these limits. Larger
// blocks would prepare keyframes less often.
constexpr int kBlockKeyframes = 1024;
constexpr int64_t kBlockPoints = 1'000'000;

struct Block {
  int begin = 0;
  int end = 0;

  int size() const { return end - begin; }
};

/// Upper bounds of the matches of one keyframe, for each sensor.
using KeyframeBounds = std::vector<std::vector<CellIndex::Bound>>;
using BlockPoints = std::vector<KeyframePoints>;

/// Two keyframes that may overlap, a < b.
struct Pair {
  int a = 0;
  int b = 0;
  PackedCovariance covariance;  ///< of T_a_b
};

/// Points of a that match one of b and of b that match one of a, for one sensor.
struct Matches {
  int of_a = 0;
  int of_b = 0;
};

class OverlapGraphBuilder {
 public:
  OverlapGraphBuilder(const KeyframePointSource& source, const PairCovariance& covariance,
                      const OverlapOptions& options, const Run& run)
      : source_(source),
        covariance_(covariance),
        options_(options),
        run_(run),
        arena_(std::max(1, run.threads)) {}

  graph::WeightedGraph build() {
    find_sensors();
    index_cells();
    std::vector<graph::Arc> arcs;
    const std::vector<Block> all = blocks();
    for (const Block& a : all) {
      const BlockPoints points_a = prepare(a);
      const std::vector<KeyframeBounds> bounds_a = bounds(a);
      for (const Block& b : all) {
        if (b.begin < a.begin || !meet(bounds_a, b)) continue;
        std::vector<Pair> pairs = candidates(a, bounds_a, b);
        if (pairs.empty()) continue;
        parallel(static_cast<int>(pairs.size()), [&](int p) {
          Pair& pair = pairs[at(p)];
          pair.covariance = PackedCovariance(covariance_(pair.a, pair.b));
        });
        add_arcs(pairs, a, points_a, b, b.begin == a.begin ? points_a : prepare(b), arcs);
      }
      run_.report({"overlap", static_cast<double>(a.end), static_cast<double>(num_keyframes())});
    }
    return {num_keyframes(), arcs};
  }

 private:
  int num_keyframes() const { return source_.num_keyframes(); }

  std::vector<Block> blocks() const {
    std::vector<Block> blocks;
    int64_t points = 0;
    for (int keyframe = 0; keyframe < num_keyframes(); ++keyframe) {
      int64_t own = 0;
      for (const CellIndex& index : index_) own += index.num_points(keyframe);
      points += own;
      if (blocks.empty() || blocks.back().size() == kBlockKeyframes || points > kBlockPoints) {
        blocks.push_back({keyframe, keyframe});
        points = own;
      }
      blocks.back().end = keyframe + 1;
    }
    return blocks;
  }

  /// Calls function(0) to function(count - 1); each writes its own slot.
  template <typename Function>
  void parallel(int count, const Function& function) {
    if (run_.stop_requested()) throw Interrupted{};
    arena_.execute([&] { tbb::parallel_for(0, count, function); });
  }

  void find_sensors() {
    std::vector<std::vector<int>> found(at(num_keyframes()));
    parallel(num_keyframes(), [&](int i) { found[at(i)] = source_.sensors(i); });
    for (const auto& sensors : found)
      sensors_.insert(sensors_.end(), sensors.begin(), sensors.end());
    std::sort(sensors_.begin(), sensors_.end());
    sensors_.erase(std::unique(sensors_.begin(), sensors_.end()), sensors_.end());
  }

  void index_cells() {
    std::vector<std::vector<std::vector<CellCount>>> cells(
        sensors_.size(), std::vector<std::vector<CellCount>>(at(num_keyframes())));
    // Not std::vector<bool>, whose elements cannot be written by several threads.
    has_reading_.assign(sensors_.size(), std::vector<char>(at(num_keyframes()), 0));
    parallel(num_keyframes(), [&](int i) {
      const KeyframePoints points = source_.points(i, sensors_);
      for (size_t s = 0; s < sensors_.size(); ++s) {
        if (!points[s]) continue;
        has_reading_[s][at(i)] = 1;
        cells[s][at(i)] = count_cells(*points[s]);
      }
    });
    const double pose_gate = options_.max_mahalanobis * options_.max_pose_deviation_m;
    for (auto& readings : cells) index_.emplace_back(std::move(readings), pose_gate * pose_gate);
  }

  BlockPoints prepare(const Block& block) {
    BlockPoints points(at(block.size()));
    parallel(block.size(),
             [&](int i) { points[at(i)] = source_.points(block.begin + i, sensors_); });
    return points;
  }

  /// Mean over the common sensors of the overlap with the matches that matches(s) returns.
  template <typename MatchesOfSensor>
  double mean_overlap(int a, int b, const MatchesOfSensor& matches) const {
    double sum = 0;
    int common = 0;
    for (size_t s = 0; s < sensors_.size(); ++s) {
      if (!has_reading_[s][at(a)] || !has_reading_[s][at(b)]) continue;
      const Matches m = matches(s);
      sum += sensed_space_overlap(index_[s].num_points(a), index_[s].num_points(b), m.of_a, m.of_b);
      ++common;
    }
    return common > 0 ? sum / common : 0.0;
  }

  bool is_arc(double overlap) const { return overlap > 0 && overlap >= options_.min_overlap; }

  /// Upper bounds of the matches of each keyframe of the block with all others.
  std::vector<KeyframeBounds> bounds(const Block& block) {
    std::vector<KeyframeBounds> bounds(at(block.size()));
    parallel(block.size(), [&](int i) {
      for (const CellIndex& index : index_) bounds[at(i)].push_back(index.bounds(block.begin + i));
    });
    return bounds;
  }

  static bool meet(const std::vector<KeyframeBounds>& bounds, const Block& block) {
    for (const KeyframeBounds& keyframe : bounds) {
      for (const auto& sensor : keyframe) {
        for (const CellIndex::Bound& bound : sensor) {
          if (bound.begin < block.end && block.begin < bound.end) return true;
        }
      }
    }
    return false;
  }

  /// One number for each keyframe of the bounds, each sensor and each keyframe of the block.
  std::vector<int> table(const std::vector<KeyframeBounds>& bounds, const Block& block) const {
    const size_t width = at(block.size());
    std::vector<int> table(bounds.size() * sensors_.size() * width, 0);
    int* row = table.data();
    for (const KeyframeBounds& keyframe : bounds) {
      for (const auto& sensor : keyframe) {
        for (const CellIndex::Bound& bound : sensor) {
          const int begin = std::max(bound.begin, block.begin),
                    end = std::min(bound.end, block.end);
          if (begin < end)
            std::fill(row + begin - block.begin, row + end - block.begin, bound.matches);
        }
        row += width;
      }
    }
    return table;
  }

  /// Pairs a < b whose overlap can reach the least one that counts, ordered by (a, b).
  std::vector<Pair> candidates(const Block& a, const std::vector<KeyframeBounds>& bounds_a,
                               const Block& b) {
    const std::vector<int> of_a = table(bounds_a, b), of_b = table(bounds(b), a);
    std::vector<Pair> pairs;
    for (int i = a.begin; i < a.end; ++i) {
      for (int j = std::max(b.begin, i + 1); j < b.end; ++j) {
        const double bound = mean_overlap(i, j, [&](size_t s) {
          const size_t row_a = (at(i - a.begin) * sensors_.size() + s) * at(b.size());
          const size_t row_b = (at(j - b.begin) * sensors_.size() + s) * at(a.size());
          return Matches{of_a[row_a + at(j - b.begin)], of_b[row_b + at(i - a.begin)]};
        });
        if (is_arc(bound)) pairs.push_back({i, j, {}});
      }
    }
    return pairs;
  }

  void add_arcs(const std::vector<Pair>& pairs, const Block& a, const BlockPoints& points_a,
                const Block& b, const BlockPoints& points_b, std::vector<graph::Arc>& arcs) {
    std::vector<std::vector<size_t>> pairs_of_a(at(a.size())), pairs_of_b(at(b.size()));
    for (size_t p = 0; p < pairs.size(); ++p) {
      pairs_of_a[at(pairs[p].a - a.begin)].push_back(p);
      pairs_of_b[at(pairs[p].b - b.begin)].push_back(p);
    }
    std::vector<Matches> matches(pairs.size() * sensors_.size());
    parallel(b.size(), [&](int i) {
      const auto queries = [&](size_t p) -> const KeyframePoints& {
        return points_a[at(pairs[p].a - a.begin)];
      };
      count(pairs, pairs_of_b[at(i)], queries, points_b[at(i)], &Matches::of_a, matches);
    });
    parallel(a.size(), [&](int i) {
      const auto queries = [&](size_t p) -> const KeyframePoints& {
        return points_b[at(pairs[p].b - b.begin)];
      };
      count(pairs, pairs_of_a[at(i)], queries, points_a[at(i)], &Matches::of_b, matches);
    });
    for (size_t p = 0; p < pairs.size(); ++p) {
      const double overlap = mean_overlap(
          pairs[p].a, pairs[p].b, [&](size_t s) { return matches[p * sensors_.size() + s]; });
      if (is_arc(overlap)) arcs.push_back({pairs[p].a, pairs[p].b, overlap});
    }
  }

  /// Counts the matches of all pairs with one keyframe, the targets, so that its grids are made
  /// once. queries_of(p): the points of the other keyframe of pair p.
  template <typename QueriesOf>
  void count(const std::vector<Pair>& pairs, const std::vector<size_t>& own_pairs,
             const QueriesOf& queries_of, const KeyframePoints& targets, int Matches::*result,
             std::vector<Matches>& matches) {
    if (own_pairs.empty()) return;
    std::vector<NearestGrid>& grids = grids_.local();
    grids.resize(sensors_.size());
    for (size_t s = 0; s < sensors_.size(); ++s) {
      if (targets[s]) grids[s].rebuild(*targets[s]);
    }
    for (const size_t p : own_pairs) {
      if (!pairs[p].covariance.known()) continue;
      const PoseSpread spread(source_.T_frame_keyframe(pairs[p].b), pairs[p].covariance.matrix());
      const KeyframePoints& queries = queries_of(p);
      for (size_t s = 0; s < sensors_.size(); ++s) {
        if (!targets[s] || !queries[s]) continue;
        matches[p * sensors_.size() + s].*result =
            count_matches(*queries[s], *targets[s], spread, options_, &grids[s]);
      }
    }
  }

  const KeyframePointSource& source_;
  const PairCovariance& covariance_;
  const OverlapOptions& options_;
  const Run& run_;
  tbb::task_arena arena_;
  tbb::enumerable_thread_specific<std::vector<NearestGrid>> grids_;  ///< one a sensor
  std::vector<int> sensors_;                                         ///< by increasing number
  std::vector<CellIndex> index_;                                     ///< one a sensor
  std::vector<std::vector<char>> has_reading_;  ///< for each sensor, whether a keyframe has it
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
  const KeyframePointSource source(keyframes, T_world_keyframe, observations, options);
  return OverlapGraphBuilder(source, covariance, options, run).build();
}

}  // namespace hmt::submap
