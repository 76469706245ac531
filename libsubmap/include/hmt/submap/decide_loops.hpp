// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "hmt/submap/pipeline.hpp"

namespace hmt::submap {

/// What a user knows better: ids of loop candidates, their places in HybridMap::loops.
struct LoopDecisions {
  std::vector<int> accept;
  std::vector<int> reject;
};

/// Records the decisions in the finished map at `path` and makes it anew from its track and its
/// loop closures: overlap, submaps, loops and OctoMaps as in build_map.
///
/// An accepted candidate becomes `confirmed` and is never doubted; its T_a_b and information are
/// taken as they are. A rejected one becomes `rejected`, with those that tell the same of the same
/// revisit, then and in later searches; registrations between visits go too, because they may rest
/// on it, and are made again where the poses without it predict them. Ids stay as they are. Throws
/// InputError for an unknown id, a candidate without a match, contrary decisions, or an unfinished
/// map. If it is interrupted, `hmtmap map` with the same log and options goes on.
BuildResult decide_loops(const std::filesystem::path& path, const LoopDecisions& decisions,
                         const Run& run);

}  // namespace hmt::submap
