// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_surfaces.hpp"

#include <algorithm>

namespace hmt::submap {
namespace {

void append_point(Surface& to, const Surface& from, size_t i, const Pose& T_to_from) {
  to.points_robot.push_back(T_to_from * from.points_robot[i]);
  to.normals_robot.push_back(T_to_from.rotation * from.normals_robot[i]);
  to.sigma_m.push_back(from.sigma_m[i]);
  to.normal_sigma_rad.push_back(from.normal_sigma_rad[i]);
  to.spacing_m.push_back(from.spacing_m[i]);
}

}  // namespace

PatchSurfaces load_surfaces(const LoopProblem& problem, const LoopPatch& patch) {
  PatchSurfaces loaded{patch.T_center_keyframe, {}};
  for (const int k : patch.keyframes) {
    const Keyframe& keyframe = problem.keyframes[static_cast<size_t>(k)];
    loaded.surfaces.push_back(make_surface(*problem.observations->load(keyframe.observation)));
  }
  return loaded;
}

PatchSurfaces surfaces_around(const PatchSurfaces& patch, const Pose& T_center_place,
                              double reach_m) {
  PatchSurfaces near;
  for (size_t i = 0; i < patch.surfaces.size(); ++i) {
    const Pose T_place_keyframe = graph::relative_pose(T_center_place, patch.T_center_keyframe[i]);
    if (T_place_keyframe.translation.norm() > reach_m) continue;
    near.T_center_keyframe.push_back(T_place_keyframe);
    near.surfaces.push_back(patch.surfaces[i]);
  }
  return near;
}

Surface merged_surface(const PatchSurfaces& patch, double range_m, size_t most_points) {
  std::vector<std::pair<size_t, size_t>> near;  // surface, point
  for (size_t i = 0; i < patch.surfaces.size(); ++i)
    for (size_t j = 0; j < patch.surfaces[i].size(); ++j)
      if ((patch.T_center_keyframe[i] * patch.surfaces[i].points_robot[j]).norm() < range_m)
        near.emplace_back(i, j);
  const size_t stride = std::max<size_t>(1, (near.size() + most_points - 1) / most_points);
  Surface all;
  for (size_t k = 0; k < near.size(); k += stride) {
    const auto [i, j] = near[k];
    append_point(all, patch.surfaces[i], j, patch.T_center_keyframe[i]);
  }
  return all;
}

RegistrationTarget make_target(const PatchSurfaces& patch) {
  std::vector<RegistrationTarget::Placed> placed;
  for (size_t i = 0; i < patch.surfaces.size(); ++i)
    placed.push_back({patch.T_center_keyframe[i], &patch.surfaces[i]});
  return RegistrationTarget(placed);
}

}  // namespace hmt::submap
