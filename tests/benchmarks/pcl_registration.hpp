// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/pose.hpp"

namespace hmt::test {

enum class PclMethod { gicp, ndt };

/// Registers a source onto a target cloud from a guess by the Point Cloud Library, with its own
/// settings but for those that its tutorials tell to set: of GICP the largest distance of
/// corresponding points, of NDT the side of the cells (1 m), the line search (0.1 m) and when to
/// stop (0.1 mm).
graph::Pose register_by_pcl(PclMethod method, const std::vector<Eigen::Vector3f>& source,
                            const std::vector<Eigen::Vector3f>& target,
                            const graph::Pose& T_target_source_guess);

}  // namespace hmt::test
