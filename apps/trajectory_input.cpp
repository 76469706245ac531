// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_input.hpp"

namespace hmt::apps {

std::vector<submap::StampedPose> load_trajectory(const std::filesystem::path& path) {
  return submap::read_tum(path);
}

}  // namespace hmt::apps
