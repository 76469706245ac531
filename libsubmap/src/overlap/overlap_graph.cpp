// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <span>
#include <string>

#include "common_share.hpp"
#include "count_matches.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "keyframe_blocks.hpp"
#include "keyframe_space.hpp"
#include "match_landmarks.hpp"
#include "packed_covariance.hpp"
#include "references.hpp"
#include "sensor_index.hpp"

namespace hmt::submap {
namespace {

size_t at(int i) {
  return static_cast<size_t>(i);
}

using BlockSpace = std::vector<KeyframeSpace>;

/// Two keyframes that may overlap, a < b.
struct Pair {
  int a = 0;
  int b = 0;
  PackedCovariance covariance;  ///< of T_a_b
};

class OverlapGraphBuilder {
 public:
  OverlapGraphBuilder(const KeyframeSpaceSource& source, int first,
                      const PairCovariance& covariance, const OverlapOptions& options,
                      const Run& run)
      : source_(source),
        first_(first),
        covariance_(covariance),
        options_(options),
        run_(run),
        arena_(std::max(1, run.threads)),
        references_(source.num_keyframes()) {}

  SectionOverlap build() {
    find_sensors();
    index_sensors();
    std::vector<graph::Arc> arcs;
    const std::vector<Block> all = blocks_of(index_, num_keyframes(), first_);
    for (const Block& b : all) {
      if (b.begin < first_) continue;
      const size_t before = arcs.size();
      const BlockSpace space_b = prepare(b, b);
      const std::vector<KeyframeBounds> bounds_b = bounds(b, b);
      for (const Block& a : all) {
        if (a.begin > b.begin) break;
        if (is_compared(a, b) && meet(bounds_b, a)) add_arcs(a, b, bounds_b, space_b, arcs);
      }
      references_.thin(b.begin, b.end, std::span(arcs).subspan(before));
      run_.report({"overlap", static_cast<double>(b.end), static_cast<double>(num_keyframes())});
    }
    return {{num_keyframes(), arcs}, std::move(references_).take()};
  }

 private:
  int num_keyframes() const { return source_.num_keyframes(); }

  /// Calls function(0) to function(count - 1); each writes its own slot.
  template <typename Function>
  void parallel(int count, const Function& function) {
    if (run_.stop_requested()) throw Interrupted{};
    arena_.execute([&] { tbb::parallel_for(0, count, function); });
  }

  void find_sensors() {
    std::vector<std::vector<Sight>> sights(at(num_keyframes()));
    parallel(num_keyframes(), [&](int i) { sights[at(i)] = source_.sights(i); });
    sensors_ = sensors_of(sights);
  }

  void index_sensors() {
    std::vector<std::vector<SensorIndex::Entry>> entries(
        sensors_.size(), std::vector<SensorIndex::Entry>(at(num_keyframes())));
    parallel(num_keyframes(), [&](int i) {
      const KeyframeSpace space = source_.space(i, sensors_);
      for (size_t s = 0; s < sensors_.size(); ++s) {
        entries[s][at(i)] = SensorIndex::entry(space[s], options_);
      }
    });
    for (auto& of_sensor : entries) index_.emplace_back(std::move(of_sensor), options_);
  }

  /// Whether a keyframe is compared with any of a later block, or of its own.
  bool is_compared(int keyframe, const Block& later) const {
    return references_.is_compared(keyframe, std::max(keyframe, later.begin));
  }
  bool is_compared(const Block& block, const Block& later) const {
    for (int i = block.begin; i < block.end; ++i)
      if (is_compared(i, later)) return true;
    return false;
  }

  /// What the keyframes of a block saw that are compared with a later one; the others stay empty.
  BlockSpace prepare(const Block& block, const Block& later) {
    BlockSpace space(at(block.size()));
    parallel(block.size(), [&](int i) {
      if (is_compared(block.begin + i, later))
        space[at(i)] = source_.space(block.begin + i, sensors_);
    });
    return space;
  }

  /// Mean over the common sensors of the overlap with the matches that matches(s) returns.
  template <typename MatchesOfSensor>
  double mean_overlap(int a, int b, const MatchesOfSensor& matches) const {
    MeanOverlap overlap;
    for (size_t s = 0; s < sensors_.size(); ++s) {
      const std::optional<double> size_a = index_[s].size(a), size_b = index_[s].size(b);
      if (size_a && size_b) overlap.add(*size_a, *size_b, matches(s));
    }
    return overlap.mean();
  }

  bool is_arc(double overlap) const { return overlap > 0 && overlap >= options_.min_overlap; }

  /// Upper bounds of the matches with all others of each keyframe of the block that is compared
  /// with a later one.
  std::vector<KeyframeBounds> bounds(const Block& block, const Block& later) {
    std::vector<KeyframeBounds> bounds(at(block.size()), KeyframeBounds(index_.size()));
    parallel(block.size(), [&](int i) {
      if (!is_compared(block.begin + i, later)) return;
      for (size_t s = 0; s < index_.size(); ++s)
        bounds[at(i)][s] = index_[s].bounds(block.begin + i);
    });
    return bounds;
  }

  /// Pairs a < b whose overlap can reach the least one that counts, ordered by (a, b).
  std::vector<Pair> candidates(const Block& a, const Block& b,
                               const std::vector<KeyframeBounds>& bounds_b) {
    const std::vector<int> of_a = table(bounds(a, b), sensors_.size(), b),
                           of_b = table(bounds_b, sensors_.size(), a);
    std::vector<Pair> pairs;
    for (int i = a.begin; i < a.end; ++i) {
      if (!is_compared(i, b)) continue;
      for (int j = std::max(b.begin, i + 1); j < b.end; ++j) {
        if (!references_.is_compared(i, j)) break;
        const double bound = mean_overlap(i, j, [&](size_t s) {
          const size_t row_a = (at(i - a.begin) * sensors_.size() + s) * at(b.size());
          const size_t row_b = (at(j - b.begin) * sensors_.size() + s) * at(a.size());
          return Matches{1.0 * of_a[row_a + at(j - b.begin)], 1.0 * of_b[row_b + at(i - a.begin)]};
        });
        if (is_arc(bound)) pairs.push_back({i, j, {}});
      }
    }
    return pairs;
  }

  /// The arcs between two blocks, or within one.
  void add_arcs(const Block& a, const Block& b, const std::vector<KeyframeBounds>& bounds_b,
                const BlockSpace& space_b, std::vector<graph::Arc>& arcs) {
    std::vector<Pair> pairs = candidates(a, b, bounds_b);
    if (pairs.empty()) return;
    parallel(static_cast<int>(pairs.size()), [&](int p) {
      Pair& pair = pairs[at(p)];
      pair.covariance = PackedCovariance(covariance_(pair.a, pair.b));
    });
    add_arcs(pairs, a, a.begin == b.begin ? space_b : prepare(a, b), b, space_b, arcs);
  }

  void add_arcs(const std::vector<Pair>& pairs, const Block& a, const BlockSpace& space_a,
                const Block& b, const BlockSpace& space_b, std::vector<graph::Arc>& arcs) {
    std::vector<std::vector<size_t>> pairs_of_a(at(a.size())), pairs_of_b(at(b.size()));
    for (size_t p = 0; p < pairs.size(); ++p) {
      pairs_of_a[at(pairs[p].a - a.begin)].push_back(p);
      pairs_of_b[at(pairs[p].b - b.begin)].push_back(p);
    }
    std::vector<Matches> matches(pairs.size() * sensors_.size());
    parallel(b.size(), [&](int i) {
      const auto queries = [&](size_t p) -> const KeyframeSpace& {
        return space_a[at(pairs[p].a - a.begin)];
      };
      count(pairs, pairs_of_b[at(i)], queries, space_b[at(i)], &Matches::of_a, matches);
    });
    parallel(a.size(), [&](int i) {
      const auto queries = [&](size_t p) -> const KeyframeSpace& {
        return space_b[at(pairs[p].b - b.begin)];
      };
      count(pairs, pairs_of_a[at(i)], queries, space_a[at(i)], &Matches::of_b, matches);
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
             const QueriesOf& queries_of, const KeyframeSpace& targets, double Matches::*result,
             std::vector<Matches>& matches) {
    if (own_pairs.empty()) return;
    std::vector<NearestGrid>& grids = grids_.local();
    grids.resize(sensors_.size());
    for (size_t s = 0; s < sensors_.size(); ++s) {
      if (const auto* points = std::get_if<SensedPoints>(&targets[s])) grids[s].rebuild(*points);
    }
    for (const size_t p : own_pairs) {
      if (!pairs[p].covariance.known()) continue;
      const PoseSpread spread(source_.T_frame_keyframe(pairs[p].b), pairs[p].covariance.matrix());
      const KeyframeSpace& queries = queries_of(p);
      for (size_t s = 0; s < sensors_.size(); ++s) {
        matches[p * sensors_.size() + s].*result = count(queries[s], targets[s], spread, grids[s]);
      }
    }
  }

  /// Number of elements of the queries that match one of the targets.
  double count(const SensedReading& queries, const SensedReading& targets, const PoseSpread& spread,
               const NearestGrid& grid) const {
    if (queries.index() != targets.index()) return 0;
    if (const auto* points = std::get_if<SensedPoints>(&queries)) {
      return count_matches(*points, std::get<SensedPoints>(targets), spread, options_, &grid);
    }
    if (const auto* voxels = std::get_if<SensedVoxels>(&queries)) {
      return common_voxels(*voxels, std::get<SensedVoxels>(targets), spread, options_);
    }
    if (const auto* landmarks = std::get_if<SensedLandmarks>(&queries)) {
      return match_landmarks(*landmarks, std::get<SensedLandmarks>(targets), spread, options_);
    }
    return 0;
  }

  const KeyframeSpaceSource& source_;
  int first_;
  const PairCovariance& covariance_;
  const OverlapOptions& options_;
  const Run& run_;
  tbb::task_arena arena_;
  References references_;
  tbb::enumerable_thread_specific<std::vector<NearestGrid>> grids_;  ///< one a sensor
  std::vector<SensorUse> sensors_;                                   ///< sorted
  std::vector<SensorIndex> index_;                                   ///< one a sensor
};

}  // namespace

graph::WeightedGraph overlap_graph(std::span<const Keyframe> keyframes,
                                   std::span<const Pose> T_world_keyframe,
                                   const PairCovariance& covariance,
                                   const ObservationStore& observations,
                                   const OverlapOptions& options, const Run& run) {
  return overlap_of_section(keyframes, T_world_keyframe, 0, covariance, observations, options, run)
      .graph;
}

SectionOverlap overlap_of_section(std::span<const Keyframe> keyframes,
                                  std::span<const Pose> T_world_keyframe, int first,
                                  const PairCovariance& covariance,
                                  const ObservationStore& observations,
                                  const OverlapOptions& options, const Run& run) {
  check(options);
  if (keyframes.size() != T_world_keyframe.size()) {
    throw InputError("overlap_graph: " + std::to_string(keyframes.size()) + " keyframes, but " +
                     std::to_string(T_world_keyframe.size()) + " poses");
  }
  for (const Pose& pose : T_world_keyframe) check_finite(pose);
  const KeyframeSpaceSource source(keyframes, T_world_keyframe, observations, options);
  return OverlapGraphBuilder(source, first, covariance, options, run).build();
}

}  // namespace hmt::submap
