// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "consensus_growth.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "hmt/graph/pose_covariance.hpp"
#include "spanning_tree.hpp"

namespace hmt::graph {
namespace {

/// Probabilities of a false edge to pass up to which edges are accepted, one after the other.
constexpr std::array<double, 5> kFalsePassLevels = {1e-4, 1e-3, 1e-2, 1e-1, 1};
/// Rounds at one level; the set stands after a few.
constexpr int kRoundsPerLevel = 6;
/// Iterations of a solve on the way; the next round goes on from where it ended.
constexpr int kIterationsPerRound = 10;

/// Degrees of freedom from which chi2 tells the scale of the noise, and the least scale that is
/// believed.
constexpr double kDegreesForScale = 30;
constexpr double kLeastScale = 0.01;

PoseGraph subgraph(const PoseGraph& graph, const std::vector<bool>& use, std::vector<Pose> poses) {
  PoseGraph part;
  part.space = graph.space;
  part.fixed = graph.fixed;
  part.poses = std::move(poses);
  for (size_t k = 0; k < use.size(); ++k)
    if (use[k]) part.edges.push_back(graph.edges[k]);
  return part;
}

std::vector<double> to_weights(const std::vector<bool>& use) {
  return {use.begin(), use.end()};
}

/// Logarithm of the volume of all relative poses within the extent of the map: translations in a
/// cube times all rotations (2 pi in the plane, 8 pi^2 in space, measured in radians).
double log_volume_of_map(const PoseGraph& graph, int translation_size) {
  Eigen::AlignedBox3d box;
  for (const Pose& pose : graph.poses) box.extend(pose.translation);
  const double pi = std::numbers::pi;
  return translation_size * std::log(std::max(box.diagonal().norm(), 1e-3)) +
         std::log(translation_size == 2 ? 2 * pi : 8 * pi * pi);
}

/// Volume of the unit ball in 3 or 6 dimensions.
double log_unit_ball(int size) {
  const double pi = std::numbers::pi;
  return std::log(size == 3 ? 4 * pi / 3 : pi * pi * pi / 6);
}

/// How an edge that is not in the set agrees with the solution over the set.
struct Prediction {
  double chi2 = 0;            ///< r^T S^-1 r
  double log_false_pass = 0;  ///< logarithm of the probability of a false edge to pass
};

template <class Chart>
class Grower {
 public:
  Grower(const PoseGraph& graph, const std::vector<bool>& trusted, double limit, int threads,
         PoseProblem<Chart>& problem)
      : graph_(graph), trusted_(trusted), limit_(limit), threads_(threads), problem_(problem) {}

  std::optional<std::vector<bool>> run() {
    accepted_ = trusted_;
    const PoseGraph backbone = subgraph(graph_, trusted_, graph_.poses);
    problem_.set_poses(spanning_tree_poses(backbone, held_nodes(graph_)));
    if (connected_components(backbone) != connected_components(graph_)) return std::nullopt;
    problem_.solve(to_weights(accepted_), 0, kIterationsPerRound);
    log_gate_ = log_unit_ball(Chart::kTangent) + Chart::kTangent / 2.0 * std::log(limit_) -
                log_volume_of_map(subgraph(graph_, {}, problem_.poses()), Chart::kTangent / 3 + 1);
    for (const double level : kFalsePassLevels)
      for (int round = 0; round < kRoundsPerLevel; ++round) {
        const auto next = grow(std::log(level));
        if (!next) return std::nullopt;
        if (*next == accepted_) break;
        accepted_ = *next;
        problem_.solve(to_weights(accepted_), 0, kIterationsPerRound);
      }
    return accepted_;
  }

 private:
  std::optional<std::vector<bool>> grow(double log_level) const {
    const PoseGraph present = subgraph(graph_, accepted_, problem_.poses());
    const PoseCovariance covariance(present);
    if (!covariance.ok()) return std::nullopt;
    std::vector<std::pair<int, int>> pairs;
    std::vector<size_t> open;
    for (size_t k = 0; k < accepted_.size(); ++k) {
      if (accepted_[k]) continue;
      open.push_back(k);
      pairs.emplace_back(graph_.edges[k].from, graph_.edges[k].to);
    }
    const auto relative = covariance.relative(pairs, threads_);
    const std::vector<double> chi2 = problem_.edge_chi2();
    const double scale = variance_scale(chi2);
    std::vector<bool> next = accepted_;
    for (size_t k = 0; k < next.size(); ++k)
      next[k] = trusted_[k] || (next[k] && chi2[k] <= limit_);
    for (size_t i = 0; i < open.size(); ++i) {
      const auto prediction =
          predict(graph_.edges[open[i]], present.poses, relative[i].value(), scale);
      if (!prediction) return std::nullopt;
      next[open[i]] = prediction->chi2 <= limit_ && prediction->log_false_pass <= log_level;
    }
    return next;
  }

  /// chi2 of the set by its degrees of freedom, at most 1: many graphs state far less information
  /// than their edges have, and predictions from it would let nearly anything pass.
  double variance_scale(const std::vector<double>& chi2) const {
    double sum = 0;
    double degrees = 0;
    for (size_t k = 0; k < chi2.size(); ++k)
      if (accepted_[k]) {
        sum += chi2[k];
        degrees += Chart::kTangent;
      }
    const std::vector<bool> held = held_nodes(graph_);
    degrees -= static_cast<double>(Chart::kTangent * std::count(held.begin(), held.end(), false));
    if (degrees < kDegreesForScale) return 1;
    return std::clamp(sum / degrees, kLeastScale, 1.0);
  }

  std::optional<Prediction> predict(const PoseGraphEdge& edge, const std::vector<Pose>& poses,
                                    const Matrix6d& relative, double scale) const {
    using Matrix = Eigen::Matrix<double, Chart::kTangent, Chart::kTangent>;
    const Eigen::LLT<Matrix> information(chart_block<Chart>(edge.information));
    if (information.info() != Eigen::Success) return std::nullopt;
    const Matrix S = scale * (chart_block<Chart>(relative) + information.solve(Matrix::Identity()));
    const Eigen::LLT<Matrix> llt(S);
    if (llt.info() != Eigen::Success) return std::nullopt;
    const Pose T_from_to =
        relative_pose(poses[static_cast<size_t>(edge.from)], poses[static_cast<size_t>(edge.to)]);
    const auto r = chart_vector<Chart>(boxminus(T_from_to, edge.T_from_to));
    const double log_root_det = llt.matrixLLT().diagonal().array().log().sum();
    return Prediction{r.dot(llt.solve(r)), log_gate_ + log_root_det};
  }

  const PoseGraph& graph_;
  const std::vector<bool>& trusted_;
  double limit_;
  int threads_;
  PoseProblem<Chart>& problem_;
  std::vector<bool> accepted_;
  double log_gate_ = 0;  ///< of the gate of a unit covariance, as a share of the map
};

}  // namespace

template <class Chart>
std::optional<std::vector<bool>> grow_consensus(const PoseGraph& graph,
                                                const std::vector<bool>& trusted, double limit,
                                                int threads, PoseProblem<Chart>& problem) {
  return Grower<Chart>(graph, trusted, limit, threads, problem).run();
}

template std::optional<std::vector<bool>> grow_consensus(const PoseGraph&, const std::vector<bool>&,
                                                         double, int, PoseProblem<PlanarChart>&);
template std::optional<std::vector<bool>> grow_consensus(const PoseGraph&, const std::vector<bool>&,
                                                         double, int, PoseProblem<SpatialChart>&);

}  // namespace hmt::graph
