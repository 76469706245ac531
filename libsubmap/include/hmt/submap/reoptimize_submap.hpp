// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// What came of one submap.
struct SubmapReoptimization {
  double chi2_before = 0;  ///< of the constraints inside the submap
  double chi2 = 0;         ///< the same at their own optimum
  double largest_move_m = 0;
  double largest_turn_rad = 0;
};

/// Optimizes submap `id` of the finished map at `path` anew, on its own: by the constraints inside
/// it, in its own frame, without the pull of its neighbors; then its OctoMap is built again.
/// Nothing else of the map changes: not the other submaps, not where any submap stands. Throws
/// InputError for a submap that is not there or an unfinished map.
SubmapReoptimization reoptimize_submap(const std::filesystem::path& path, int id, const Run& run);

}  // namespace hmt::submap
