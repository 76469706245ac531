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

#include "backbone.hpp"
#include "hmt/graph/chi_squared.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "noise_scale.hpp"
#include "piece_cycles.hpp"
#include "pose_volume.hpp"
#include "spanning_tree.hpp"
#include "unsquared_start.hpp"

namespace hmt::graph {
namespace {

/// Edges that agree with the prediction to this quantile come first: a false one that is barely
/// possible is out of the question once the predictions are sharper.
constexpr double kFirstProbability = 0.95;
/// Probabilities of a false edge to pass up to which edges are accepted, one after the other.
constexpr std::array<double, 5> kFalsePassLevels = {1e-4, 1e-3, 1e-2, 1e-1, 1};
/// Rounds at one level; the set stands after a few.
constexpr int kRoundsPerLevel = 6;
/// Iterations of a solve on the way; the next round goes on from where it ended.
constexpr int kIterationsPerRound = 10;

/// Rounds of joining pieces anew where the backbone is a guess; they end when nothing changes.
constexpr int kRejoinRounds = 50;
/// Degrees of freedom from which chi2 tells the scale of the noise, and the least scale that is
/// believed.
constexpr double kDegreesForScale = 30;
constexpr double kLeastScale = 1e-6;
/// Where the errors of all edges tell the scale: below what half of them being false can reach.
constexpr double kBulkProbability = 0.25;
/// Where the errors of the accepted ones do, which may have longer tails than a normal deviate.
constexpr double kTailProbability = 0.99;

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

/// How an edge that is not in the set agrees with the solution over the set.
struct Prediction {
  size_t edge = 0;
  double chi2 = 0;          ///< r^T S^-1 r
  double log_root_det = 0;  ///< logarithm of det(S)^(1/2)
};

/// What an edge must meet to be accepted: chi2 up to `limit`, and a gate of that size that a false
/// edge passes with at most this probability.
struct Gate {
  double limit = 0;
  double false_pass = 1;
  bool by_tail = false;  ///< the scale of the noise is that of the longest tail of the accepted
};

template <class Chart>
class Grower {
 public:
  Grower(const PoseGraph& graph, const std::vector<bool>& trusted, double limit, int threads,
         PoseProblem<Chart>& problem)
      : graph_(graph),
        trusted_(trusted),
        limit_(limit),
        threads_(threads),
        problem_(problem),
        backbone_(trusted) {}

  std::optional<Consensus> run() {
    if (!graph_.point_edges.empty()) return std::nullopt;
    untrusted_ = !determines_all(trusted_);
    accepted_.assign(graph_.edges.size(), false);
    hold_by(untrusted_ ? guessed_backbone() : trusted_);
    solve();
    log_volume_ =
        log_volume_of_map(subgraph(graph_, {}, problem_.poses()), Chart::kTangent / 3 + 1);
    if (!predict_all() || !grow()) return std::nullopt;
    for (int round = 0; round < kRejoinRounds && untrusted_; ++round) {
      const std::vector<bool> before = accepted_;
      if (!rejoin()) break;
      solve();
      if (!predict_all() || !grow()) return std::nullopt;
      if (accepted_ == before) break;
    }
    return take_in_the_tail();
  }

 private:
  std::vector<Gate> gates() const {
    std::vector<Gate> all;
    const double first = chi_squared_quantile(Chart::kTangent, kFirstProbability);
    for (const double level : kFalsePassLevels) all.push_back({first, level, false});
    for (const double level : kFalsePassLevels) all.push_back({limit_, level, false});
    all.push_back({limit_, 1, true});
    return all;
  }

  bool determines_all(const std::vector<bool>& edges) const {
    return connected_components(subgraph(graph_, edges, graph_.poses)) ==
           connected_components(graph_);
  }

  /// The trusted edges, and where these leave poses apart the least doubted others.
  std::vector<bool> guessed_backbone() {
    std::vector<double> doubt = unsquared_deviations(graph_, trusted_, limit_, problem_);
    for (size_t k = 0; k < doubt.size(); ++k)
      if (trusted_[k]) doubt[k] = -1;
    std::vector<bool> backbone = least_doubted_forest(graph_, doubt);
    for (size_t k = 0; k < doubt.size(); ++k)
      if (trusted_[k]) backbone[k] = true;
    return backbone;
  }

  /// Accepts what agrees, gate by gate, until the set stands.
  bool grow() {
    for (const Gate& gate : gates())
      for (int round = 0; round < kRoundsPerLevel; ++round) {
        const std::vector<bool> next = pass(gate);
        if (next == accepted_) break;
        accepted_ = next;
        solve();
        if (!predict_all()) return false;
      }
    return true;
  }

  /// Joins the pieces of the accepted graph anew where cycles over them close; false where none
  /// does, or nothing changes.
  bool rejoin() {
    const PoseCovariance covariance(subgraph(graph_, accepted_, problem_.poses()));
    if (!covariance.ok()) return false;
    const AcceptedGraph accepted(graph_, accepted_, trusted_);
    const std::vector<int> piece = accepted.pieces();
    const std::vector<size_t> closing =
        closing_edges<Chart>(graph_, problem_.poses(), covariance, piece,
                             [&](size_t k, size_t l) { return accepted.are_beside(k, l); },
                             {limit_ * scale_of_bulk(), log_volume_});
    if (closing.empty()) return false;
    const std::vector<bool> before = accepted_;
    std::vector<double> doubt(before.size(), 4);
    for (size_t k = 0; k < before.size(); ++k) {
      if (!before[k]) continue;
      const PoseGraphEdge& edge = graph_.edges[k];
      accepted_[k] = piece[static_cast<size_t>(edge.from)] == piece[static_cast<size_t>(edge.to)];
      doubt[k] = !accepted_[k] ? 3 : backbone_[k] ? 0 : 1;
    }
    for (const size_t k : closing) {
      accepted_[k] = true;
      doubt[k] = 2;
    }
    hold_by(least_doubted_forest(graph_, doubt));
    return accepted_ != before;
  }

  /// Takes the edges for the backbone and places all poses along it.
  void hold_by(std::vector<bool> backbone) {
    backbone_ = std::move(backbone);
    for (size_t k = 0; k < backbone_.size(); ++k)
      if (backbone_[k]) accepted_[k] = true;
    const PoseGraph part = subgraph(graph_, backbone_, graph_.poses);
    problem_.set_placement({spanning_tree_poses(part, held_nodes(graph_)), {}});
  }

  void solve() {
    problem_.solve(to_weights(accepted_), false, kIterationsPerRound);
    chi2_ = problem_.factor_chi2();
  }

  /// The accepted edges that still agree, and the others that pass the gate.
  std::vector<bool> pass(const Gate& gate) const {
    std::vector<bool> next = accepted_;
    for (size_t k = 0; k < next.size(); ++k)
      next[k] = backbone_[k] || (next[k] && chi2_[k] <= limit_);
    const double limit = gate.limit * (gate.by_tail ? scale_of_tail() : scale_of_bulk());
    const double log_gate =
        log_unit_ball(Chart::kTangent) + Chart::kTangent / 2.0 * std::log(limit) - log_volume_;
    for (const Prediction& p : predictions_)
      if (p.chi2 <= limit && log_gate + p.log_root_det <= std::log(gate.false_pass))
        next[p.edge] = true;
    return next;
  }

  /// The edges beyond the limit that the scale of the noise sets, up to the one of the information
  /// as stated, belong to the bulk or to the false ones: the widest gap between them decides.
  Consensus take_in_the_tail() const {
    std::vector<double> predicted;
    for (const Prediction& p : predictions_) predicted.push_back(p.chi2);
    Consensus consensus{accepted_, 0, untrusted_};
    consensus.limit_of_others = below_widest_gap(predicted, limit_ * scale_of_tail(), limit_);
    for (const Prediction& p : predictions_)
      if (p.chi2 <= consensus.limit_of_others) consensus.accepted[p.edge] = true;
    return consensus;
  }

  /// Predicts every edge that is not in the set; false where that is not possible.
  bool predict_all() {
    predictions_.clear();
    const PoseGraph present = subgraph(graph_, accepted_, problem_.poses());
    const PoseCovariance covariance(present);
    if (!covariance.ok()) return false;
    std::vector<std::pair<int, int>> pairs;
    for (size_t k = 0; k < accepted_.size(); ++k) {
      if (accepted_[k]) continue;
      predictions_.push_back({k, 0, 0});
      pairs.emplace_back(graph_.edges[k].from, graph_.edges[k].to);
    }
    const auto relative = covariance.relative(pairs, threads_);
    for (size_t i = 0; i < pairs.size(); ++i)
      if (!predict(present.poses, relative[i].value(), predictions_[i])) return false;
    return true;
  }

  bool predict(const std::vector<Pose>& poses, const Matrix6d& relative,
               Prediction& prediction) const {
    using Matrix = Eigen::Matrix<double, Chart::kTangent, Chart::kTangent>;
    const PoseGraphEdge& edge = graph_.edges[prediction.edge];
    const Eigen::LLT<Matrix> information(chart_block<Chart>(edge.information));
    if (information.info() != Eigen::Success) return false;
    const Matrix S = chart_block<Chart>(relative) + information.solve(Matrix::Identity());
    const Eigen::LLT<Matrix> llt(S);
    if (llt.info() != Eigen::Success) return false;
    const Pose T_from_to =
        relative_pose(poses[static_cast<size_t>(edge.from)], poses[static_cast<size_t>(edge.to)]);
    const auto r = chart_vector<Chart>(boxminus(T_from_to, edge.T_from_to));
    prediction.chi2 = r.dot(llt.solve(r));
    prediction.log_root_det = llt.matrixLLT().diagonal().array().log().sum();
    return true;
  }

  /// chi2 of the set by its degrees of freedom, at most 1: many graphs state far less information
  /// than their edges have, and predictions from it would let nearly anything pass. While the set
  /// has few loops, the smaller errors of all edges say how large the noise may be.
  double scale_of_bulk() const {
    std::vector<double> doubted = accepted_errors();
    for (const Prediction& p : predictions_) doubted.push_back(p.chi2);
    const double bulk = scale_at(std::move(doubted), kBulkProbability, Chart::kTangent);
    return std::clamp(std::max(bulk, scale_of_set()), kLeastScale, 1.0);
  }
  double scale_of_tail() const {
    const double tail = scale_at(accepted_errors(), kTailProbability, Chart::kTangent);
    return std::clamp(std::max(tail, scale_of_set()), kLeastScale, 1.0);
  }

  double scale_of_set() const {
    double sum = 0;
    double degrees = 0;
    for (size_t k = 0; k < accepted_.size(); ++k)
      if (accepted_[k]) {
        sum += chi2_[k];
        degrees += Chart::kTangent;
      }
    const std::vector<bool> held = held_nodes(graph_);
    degrees -= static_cast<double>(Chart::kTangent * std::count(held.begin(), held.end(), false));
    return degrees < kDegreesForScale ? 0 : sum / degrees;
  }

  /// chi2 of the accepted edges that are not trusted.
  std::vector<double> accepted_errors() const {
    std::vector<double> errors;
    for (size_t k = 0; k < accepted_.size(); ++k)
      if (accepted_[k] && !backbone_[k]) errors.push_back(chi2_[k]);
    return errors;
  }

  const PoseGraph& graph_;
  const std::vector<bool>& trusted_;
  double limit_;
  int threads_;
  PoseProblem<Chart>& problem_;
  std::vector<bool> backbone_;  ///< edges that hold the poses together and are not dropped
  bool untrusted_ = false;      ///< the backbone is a guess
  std::vector<bool> accepted_;
  std::vector<double> chi2_;             ///< of every edge at the present solution
  std::vector<Prediction> predictions_;  ///< of the edges that are not accepted
  double log_volume_ = 0;                ///< of all relative poses within the map
};

}  // namespace

template <class Chart>
std::optional<Consensus> grow_consensus(const PoseGraph& graph, const std::vector<bool>& trusted,
                                        double limit, int threads, PoseProblem<Chart>& problem) {
  return Grower<Chart>(graph, trusted, limit, threads, problem).run();
}

template std::optional<Consensus> grow_consensus(const PoseGraph&, const std::vector<bool>&, double,
                                                 int, PoseProblem<PlanarChart>&);
template std::optional<Consensus> grow_consensus(const PoseGraph&, const std::vector<bool>&, double,
                                                 int, PoseProblem<SpatialChart>&);

}  // namespace hmt::graph
