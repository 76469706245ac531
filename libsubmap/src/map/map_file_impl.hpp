// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>

#include "../observation/recently_used.hpp"
#include "database.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::submap {

/// Table observations: id, stamp, seven numbers of the pose, digest, readings.
constexpr int kObservationDigestColumn = 9;

/// Table submaps: id, chi2, degrees of freedom, counts of keyframes and constraints, digest.
constexpr int kSubmapDigestColumn = 5;

/// What the recently used observations may hold unless a run sets it.
constexpr size_t kCacheBytes = size_t{64} << 20;

/// Bytes that an observation takes.
size_t size_in_memory(const Observation& observation);

struct MapFile::Impl {
  Impl(const std::filesystem::path& path, Database::Access access) : database(path, access) {}

  /// Stamp and pose of an observation, and its encoded readings; with the mutex held.
  std::string read_observation(int64_t index, Observation& observation);

  Database database;
  // Held during every use of the database: one connection serves all threads.
  std::mutex mutex;
  std::optional<Statement> select_observation;
  RecentlyUsed<Observation> cache{kCacheBytes};
};

}  // namespace hmt::submap
