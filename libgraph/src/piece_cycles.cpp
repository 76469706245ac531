// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "piece_cycles.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "disjoint_sets.hpp"
#include "pose_factor.hpp"
#include "pose_volume.hpp"

namespace hmt::graph {
namespace {

constexpr int kMostPieces = 5;
/// Steps of the search from one edge at one length; beyond, only what was found counts.
constexpr int kMostSteps = 300;
constexpr double kChance = 0.01;

/// An edge in the direction in which a cycle passes it.
struct Passage {
  size_t edge = 0;
  int from = 0;
  int to = 0;
  Pose T_from_to;
  Matrix6d covariance;
};

struct Cycle {
  std::vector<size_t> edges;
  std::vector<int> pieces;
  double log_chance = 0;  ///< of closing if one of its edges is false
};

/// A way over pieces: where it has come to, and how it came there.
struct Way {
  Pose T_start_here;
  Matrix6d covariance;
};

template <class Chart>
class CycleSearch {
 public:
  CycleSearch(const PoseGraph& graph, const std::vector<Pose>& poses,
              const PoseCovariance& covariance, const std::vector<int>& piece,
              const std::function<bool(size_t, size_t)>& beside, const CycleGate& gate)
      : poses_(poses), covariance_(covariance), piece_(piece), beside_(beside), gate_(gate) {
    leaving_.resize(graph.poses.size());
    for (size_t k = 0; k < graph.edges.size(); ++k) {
      const PoseGraphEdge& edge = graph.edges[k];
      if (piece_of(edge.from) == piece_of(edge.to)) continue;
      using Matrix = Eigen::Matrix<double, Chart::kTangent, Chart::kTangent>;
      const Eigen::LLT<Matrix> llt(chart_block<Chart>(edge.information));
      if (llt.info() != Eigen::Success) continue;
      const Matrix6d forward = from_chart_block<Chart>(llt.solve(Matrix::Identity()));
      leaving(edge.from).push_back({k, edge.from, edge.to, edge.T_from_to, forward});
      leaving(edge.to).push_back({k, edge.to, edge.from, edge.T_from_to.inverse(),
                                  inverse_covariance(edge.T_from_to, forward)});
    }
  }

  std::vector<size_t> run() {
    for (int length = 2; length <= kMostPieces; ++length) {
      length_ = length;
      closings_ = 0;
      cycles_.clear();
      for (const auto& passages : leaving_)
        for (const Passage& first : passages)
          if (first.from < first.to) start(first);
      const std::vector<size_t> taken = take();
      if (!taken.empty()) return taken;
    }
    return {};
  }

 private:
  int piece_of(int node) const { return piece_[static_cast<size_t>(node)]; }
  std::vector<Passage>& leaving(int node) { return leaving_[static_cast<size_t>(piece_of(node))]; }

  void start(const Passage& first) {
    edges_ = {first.edge};
    pieces_ = {piece_of(first.from), piece_of(first.to)};
    steps_ = 0;
    extend(first, first, {first.T_from_to, first.covariance});
  }

  /// Goes on from where `last` arrived.
  void extend(const Passage& first, const Passage& last, const Way& way) {
    for (const Passage& next : leaving(last.to)) {
      // Each cycle once: from its edge of least index.
      if (next.edge <= first.edge) continue;
      const int target = piece_of(next.to);
      const bool closes = target == pieces_.front();
      if (closes != (static_cast<int>(pieces_.size()) == length_)) continue;
      if (!closes && std::find(pieces_.begin(), pieces_.end(), target) != pieces_.end()) continue;
      if (++steps_ > kMostSteps) return;
      const auto within = relative(last.to, next.from);
      if (!within) continue;
      Way longer = append(append(way, *within), {next.T_from_to, next.covariance});
      edges_.push_back(next.edge);
      if (closes) {
        close(first, next, longer);
      } else {
        pieces_.push_back(target);
        extend(first, next, longer);
        pieces_.pop_back();
      }
      edges_.pop_back();
    }
  }

  void close(const Passage& first, const Passage& last, const Way& way) {
    const auto within = relative(last.to, first.from);
    if (!within) return;
    ++closings_;
    using Matrix = Eigen::Matrix<double, Chart::kTangent, Chart::kTangent>;
    const Way whole = append(way, *within);
    const Eigen::LLT<Matrix> llt(chart_block<Chart>(whole.covariance));
    if (llt.info() != Eigen::Success) return;
    const auto r = chart_vector<Chart>(boxminus(whole.T_start_here, Pose{}));
    if (r.dot(llt.solve(r)) > gate_.limit) return;
    const double log_gate = log_unit_ball(Chart::kTangent) +
                            Chart::kTangent / 2.0 * std::log(gate_.limit) +
                            llt.matrixLLT().diagonal().array().log().sum();
    cycles_.push_back({edges_, pieces_, log_gate - gate_.log_volume});
  }

  static Way append(const Way& way, const Way& step) {
    return {way.T_start_here * step.T_start_here,
            compose_covariance(step.T_start_here, way.covariance, step.covariance)};
  }

  std::optional<Way> relative(int a, int b) {
    if (a == b) return Way{Pose{}, Matrix6d::Zero()};
    const auto known = relative_.find({a, b});
    if (known != relative_.end()) return known->second;
    std::optional<Way> way;
    if (const auto covariance = covariance_.relative(a, b))
      way = Way{relative_pose(poses_[static_cast<size_t>(a)], poses_[static_cast<size_t>(b)]),
                *covariance};
    relative_[{a, b}] = way;
    return way;
  }

  std::vector<size_t> take() {
    const double most = std::log(kChance / std::max(1, closings_));
    std::stable_sort(cycles_.begin(), cycles_.end(),
                     [](const Cycle& a, const Cycle& b) { return a.log_chance < b.log_chance; });
    DisjointSets joined(piece_.size());
    std::vector<size_t> taken;
    for (const Cycle& cycle : cycles_) {
      if (cycle.log_chance > most) break;
      if (!all_apart(cycle, joined) || has_edges_beside(cycle)) continue;
      for (const int piece : cycle.pieces) joined.join(cycle.pieces.front(), piece);
      taken.insert(taken.end(), cycle.edges.begin(), cycle.edges.end());
    }
    return taken;
  }

  static bool all_apart(const Cycle& cycle, DisjointSets& joined) {
    std::vector<size_t> sets;
    for (const int piece : cycle.pieces) sets.push_back(joined.find(static_cast<size_t>(piece)));
    std::sort(sets.begin(), sets.end());
    return std::adjacent_find(sets.begin(), sets.end()) == sets.end();
  }

  bool has_edges_beside(const Cycle& cycle) const {
    for (size_t i = 0; i < cycle.edges.size(); ++i)
      for (size_t j = i + 1; j < cycle.edges.size(); ++j)
        if (beside_(cycle.edges[i], cycle.edges[j])) return true;
    return false;
  }

  const std::vector<Pose>& poses_;
  const PoseCovariance& covariance_;
  const std::vector<int>& piece_;
  const std::function<bool(size_t, size_t)>& beside_;
  CycleGate gate_;
  std::vector<std::vector<Passage>> leaving_;  ///< by piece
  std::map<std::pair<int, int>, std::optional<Way>> relative_;
  int length_ = 2;
  int steps_ = 0;
  int closings_ = 0;
  std::vector<size_t> edges_;  ///< of the way that is followed
  std::vector<int> pieces_;
  std::vector<Cycle> cycles_;
};

}  // namespace

template <class Chart>
std::vector<size_t> closing_edges(const PoseGraph& graph, const std::vector<Pose>& poses,
                                  const PoseCovariance& covariance, const std::vector<int>& piece,
                                  const std::function<bool(size_t, size_t)>& beside,
                                  const CycleGate& gate) {
  return CycleSearch<Chart>(graph, poses, covariance, piece, beside, gate).run();
}

template std::vector<size_t> closing_edges<PlanarChart>(const PoseGraph&, const std::vector<Pose>&,
                                                        const PoseCovariance&,
                                                        const std::vector<int>&,
                                                        const std::function<bool(size_t, size_t)>&,
                                                        const CycleGate&);
template std::vector<size_t> closing_edges<SpatialChart>(const PoseGraph&, const std::vector<Pose>&,
                                                         const PoseCovariance&,
                                                         const std::vector<int>&,
                                                         const std::function<bool(size_t, size_t)>&,
                                                         const CycleGate&);

}  // namespace hmt::graph
