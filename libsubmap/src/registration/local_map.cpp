// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "local_map.hpp"

#include <utility>

namespace hmt::submap {
void LocalMap::add(const Pose& T_track_robot, Surface surface) {
  surfaces_.push_back({T_track_robot, std::move(surface)});
  if (surfaces_.size() > kLocalMapKeyframes) surfaces_.pop_front();
  target_ = RegistrationTarget(surfaces());
}

std::vector<RegistrationTarget::Placed> LocalMap::surfaces() const {
  std::vector<RegistrationTarget::Placed> placed;
  for (const Placed& p : surfaces_) placed.push_back({p.T_track_robot, &p.surface});
  return placed;
}

}  // namespace hmt::submap
