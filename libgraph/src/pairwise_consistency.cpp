// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pairwise_consistency.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <numeric>
#include <string>

#include "hmt/graph/chi_squared.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "maximum_clique.hpp"
#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

/// Loops that each is compared with, in the order of the poses that they lead to. The covariance of
/// the trajectory between loops that lie farther apart is so large that hardly any two contradict
/// each other.
constexpr size_t kCompared = 500;

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

  /// Those of the loops `others` whose cycle with loop k does not close within the limit. Where the
  /// trajectory says nothing about a relative pose, nothing contradicts.
  std::vector<size_t> conflicts(size_t k, std::span<const size_t> others) const {
    // All from one pose, then all from the other: each is one column of the covariance.
    std::vector<std::optional<UncertainPose>> ends, starts;
    for (const size_t l : others) ends.push_back(trajectory_pose(loops_[k].to, loops_[l].to));
    for (const size_t l : others) starts.push_back(trajectory_pose(loops_[k].from, loops_[l].from));
    std::vector<size_t> found;
    for (size_t i = 0; i < others.size(); ++i)
      if (ends[i] && starts[i] && !agree(k, *ends[i], others[i], *starts[i]))
        found.push_back(others[i]);
    return found;
  }

 private:
  bool agree(size_t k, const UncertainPose& ends, size_t l, const UncertainPose& starts) const {
    const UncertainPose cycle = measured_[k] * ends * inverse(measured_[l]) * inverse(starts);
    const auto covariance = chart_block<Chart>(cycle.covariance);
    const Vector6d error = boxminus(cycle.T_a_b, Pose{});
    const auto e = chart_vector<Chart>(error);
    return e.dot(covariance.llt().solve(e)) <= limit_;
  }

  std::optional<UncertainPose> trajectory_pose(int a, int b) const {
    const auto covariance = covariance_.relative_by_column(a, b);
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

/// The loops in the order of the poses that they lead to.
std::vector<size_t> in_order(std::span<const PoseGraphEdge> loops) {
  std::vector<size_t> order(loops.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t k, size_t l) { return loops[k].to < loops[l].to; });
  return order;
}

/// For each loop those that it contradicts, in no order.
template <class Chart>
std::vector<std::vector<size_t>> all_conflicts(const PoseGraph& trajectory,
                                               std::span<const PoseGraphEdge> loops,
                                               double confidence) {
  const ConsistencyTest<Chart> test(trajectory, loops, confidence);
  const std::vector<size_t> order = in_order(loops);
  std::vector<std::vector<size_t>> later(loops.size());
  tbb::parallel_for(size_t{0}, order.size(), [&](size_t i) {
    const size_t count = std::min(kCompared, order.size() - i - 1);
    later[order[i]] = test.conflicts(order[i], std::span(order).subspan(i + 1, count));
  });
  std::vector<std::vector<size_t>> conflicts = later;
  for (size_t k = 0; k < later.size(); ++k)
    for (const size_t l : later[k]) conflicts[l].push_back(k);
  return conflicts;
}

/// The loops that are tied to loop k by conflicts, ascending; marks them as seen.
std::vector<size_t> component_of(size_t k, const std::vector<std::vector<size_t>>& conflicts,
                                 std::vector<bool>& seen) {
  std::vector<size_t> component{k};
  seen[k] = true;
  for (size_t i = 0; i < component.size(); ++i)
    for (const size_t l : conflicts[component[i]]) {
      if (seen[l]) continue;
      seen[l] = true;
      component.push_back(l);
    }
  std::sort(component.begin(), component.end());
  return component;
}

/// A branch of the search takes time with the square of the number of loops; two million of 64
/// loops, and as few of more loops as take no longer: less than a second.
long affordable_branches(size_t loops) {
  constexpr double kMost = 2e6;
  const double share = 64.0 / static_cast<double>(std::max<size_t>(64, loops));
  return static_cast<long>(std::max(100.0, kMost * share * share));
}

/// The largest sets of loops without conflicts, one for each component of the graph of conflicts:
/// together they are the largest of all.
std::vector<bool> without_conflicts(const std::vector<std::vector<size_t>>& conflicts) {
  std::vector<bool> chosen(conflicts.size(), false);
  std::vector<bool> seen(conflicts.size(), false);
  for (size_t k = 0; k < conflicts.size(); ++k) {
    if (seen[k]) continue;
    const std::vector<size_t> component = component_of(k, conflicts, seen);
    std::vector<std::vector<bool>> agrees(component.size(),
                                          std::vector<bool>(component.size(), true));
    for (size_t i = 0; i < component.size(); ++i)
      for (const size_t l : conflicts[component[i]]) {
        const auto at = std::lower_bound(component.begin(), component.end(), l);
        agrees[i][static_cast<size_t>(at - component.begin())] = false;
      }
    for (const int i : maximum_clique(agrees, affordable_branches(component.size())))
      chosen[component[static_cast<size_t>(i)]] = true;
  }
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
    return without_conflicts(all_conflicts<decltype(chart)>(trajectory, loops, confidence));
  });
}

}  // namespace hmt::graph
