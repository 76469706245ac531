// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "database.hpp"
#include "hmt/submap/map/hybrid_map.hpp"

namespace hmt::submap {

/// Throws InputError unless every index in the map points at something: a checksum cannot see what
/// was put together from different runs.
void check_map(const Database& database, const HybridMap& map);

}  // namespace hmt::submap
