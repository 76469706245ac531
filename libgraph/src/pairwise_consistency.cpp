// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pairwise_consistency.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <string>

#include "hmt/graph/chi_squared.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "maximum_clique.hpp"
#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

/// A relative pose and its covariance, in the frame that it leads to.
struct UncertainPose {
  Pose T_a_b;
  Matrix6d covariance;
};

UncertainPose operator*(const UncertainPose& left, const UncertainPose& right) {
  return {left.T_a_b * right.T_a_b,
          compose_covariance(right.T_a_b, left.covariance, right.covariance)};
}

UncertainPose inverse(const UncertainPose& pose) {
  return {pose.T_a_b.inverse(), inverse_covariance(pose.T_a_b, pose.covariance)};
}

template <class Chart>
UncertainPose measured(const PoseGraphEdge& edge) {
  return {edge.T_from_to, from_chart_block<Chart>(chart_block<Chart>(edge.information).inverse())};
}

template <class Chart>
class ConsistencyTest {
 public:
  ConsistencyTest(const PoseGraph& trajectory, std::span<const PoseGraphEdge> loops,
                  double confidence)
      : trajectory_(trajectory),
        covariance_(trajectory),
        loops_(loops),
        limit_(chi_squared_quantile(Chart::kTangent, confidence)) {
    for (const PoseGraphEdge& loop : loops) measured_.push_back(measured<Chart>(loop));
  }

  /// Whether the cycle over loops k and l closes within the limit. Where the trajectory says
  /// nothing about a relative pose, nothing contradicts.
  bool agree(size_t k, size_t l) const {
    const auto ends = trajectory_pose(loops_[k].to, loops_[l].to);
    const auto starts = trajectory_pose(loops_[l].from, loops_[k].from);
    if (!ends || !starts) return true;
    const UncertainPose cycle = measured_[k] * *ends * inverse(measured_[l]) * *starts;
    const auto covariance = chart_block<Chart>(cycle.covariance);
    const Vector6d error = boxminus(cycle.T_a_b, Pose{});
    const auto e = chart_vector<Chart>(error);
    return e.dot(covariance.llt().solve(e)) <= limit_;
  }

 private:
  std::optional<UncertainPose> trajectory_pose(int a, int b) const {
    const auto covariance = covariance_.relative(a, b);
    if (!covariance) return std::nullopt;
    const auto& poses = trajectory_.poses;
    return UncertainPose{
        relative_pose(poses[static_cast<size_t>(a)], poses[static_cast<size_t>(b)]), *covariance};
  }

  const PoseGraph& trajectory_;
  PoseCovariance covariance_;
  std::span<const PoseGraphEdge> loops_;
  double limit_;
  std::vector<UncertainPose> measured_;
};

template <class Chart>
std::vector<bool> consistent_set(const PoseGraph& trajectory, std::span<const PoseGraphEdge> loops,
                                 double confidence) {
  const ConsistencyTest<Chart> test(trajectory, loops, confidence);
  std::vector<std::vector<bool>> agrees(loops.size(), std::vector<bool>(loops.size(), false));
  // Row k belongs to task k alone; the other half is copied afterwards.
  tbb::parallel_for(size_t{0}, loops.size(), [&](size_t k) {
    for (size_t l = k + 1; l < loops.size(); ++l) agrees[k][l] = test.agree(k, l);
  });
  for (size_t k = 0; k < loops.size(); ++k)
    for (size_t l = 0; l < k; ++l) agrees[k][l] = agrees[l][k];
  std::vector<bool> chosen(loops.size(), false);
  for (const int k : maximum_clique(agrees)) chosen[static_cast<size_t>(k)] = true;
  return chosen;
}

}  // namespace

std::vector<bool> pairwise_consistent_set(const PoseGraph& trajectory,
                                          std::span<const PoseGraphEdge> loops, double confidence) {
  check_edges(loops, trajectory.space, trajectory.poses.size());
  with_chart(trajectory.space, [&](auto chart) {
    for (size_t k = 0; k < loops.size(); ++k)
      if (!is_definite(chart_block<decltype(chart)>(loops[k].information)))
        throw InputError("loop " + std::to_string(k) +
                         ": the information matrix is singular, so its cycles cannot be judged");
  });
  return with_chart(trajectory.space, [&](auto chart) {
    return consistent_set<decltype(chart)>(trajectory, loops, confidence);
  });
}

}  // namespace hmt::graph
