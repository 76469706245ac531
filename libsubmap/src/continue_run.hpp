// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/pipeline.hpp"

namespace hmt::submap {

/// The stages after the track, as far as the file does not have them.
std::vector<StageTime> continue_run(MapFile& file, const Options& given, const Run& run);

}  // namespace hmt::submap
