// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "unsquared_start.hpp"

#include <algorithm>
#include <cmath>

#include "chordal_relaxation.hpp"

namespace hmt::graph {
namespace {

/// Rounds with the rotations alone, with the sum of deviations, and with lower powers of them.
constexpr int kRotationRounds = 10;
constexpr int kPoseRounds = 20;
constexpr int kSharpRounds = 20;
/// Deviations are squared below this share of the limit, or their median where that is less noise.
constexpr double kLeastSquared = 1e-4;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> rotation_chi2(const PoseGraph& graph, const std::vector<Pose>& poses) {
  std::vector<double> chi2;
  for (const PoseGraphEdge& edge : graph.edges) {
    const Pose T_from_to =
        relative_pose(poses[static_cast<size_t>(edge.from)], poses[static_cast<size_t>(edge.to)]);
    const Eigen::Vector3d r = boxminus(T_from_to, edge.T_from_to).tail<3>();
    chi2.push_back(r.dot(edge.information.bottomRightCorner<3, 3>() * r));
  }
  return chi2;
}

}  // namespace

template <class Chart>
std::vector<double> unsquared_deviations(const PoseGraph& graph, const std::vector<bool>& trusted,
                                         double limit, PoseProblem<Chart>& problem) {
  PoseGraph weighted = graph;
  for (int round = 0; round < kRotationRounds + kPoseRounds + kSharpRounds; ++round) {
    const auto poses = chordal_poses(weighted);
    if (!poses) break;
    problem.set_placement({*poses, {}});
    const std::vector<double> chi2 =
        round < kRotationRounds ? rotation_chi2(graph, *poses) : problem.factor_chi2();
    const double squared = std::clamp(median(chi2), kLeastSquared * limit, limit);
    const double power = round < kRotationRounds + kPoseRounds ? 0.5 : 1;
    for (size_t k = 0; k < chi2.size(); ++k) {
      const double weight = trusted[k] ? 1 : std::pow(squared / std::max(squared, chi2[k]), power);
      weighted.edges[k].information = weight * graph.edges[k].information;
    }
  }
  return problem.factor_chi2();
}

template std::vector<double> unsquared_deviations(const PoseGraph&, const std::vector<bool>&,
                                                  double, PoseProblem<PlanarChart>&);
template std::vector<double> unsquared_deviations(const PoseGraph&, const std::vector<bool>&,
                                                  double, PoseProblem<SpatialChart>&);

}  // namespace hmt::graph
