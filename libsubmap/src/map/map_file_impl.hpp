// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <list>
#include <mutex>
#include <unordered_map>

#include "database.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::submap {

/// Table observations: id, stamp, seven numbers of the pose, digest, readings.
constexpr int kObservationDigestColumn = 9;

/// Table submaps: id, chi2, degrees of freedom, counts of keyframes and constraints, digest.
constexpr int kSubmapDigestColumn = 5;

/// Recently used observations, up to a number of bytes. Safe for many threads.
class ObservationCache {
 public:
  std::shared_ptr<const Observation> find(int64_t index);
  void insert(std::shared_ptr<const Observation> observation);

 private:
  struct Entry {
    std::shared_ptr<const Observation> observation;
    size_t bytes = 0;
  };
  std::mutex mutex_;
  std::list<Entry> entries_;  // the most recently used first
  std::unordered_map<int64_t, std::list<Entry>::iterator> by_index_;
  size_t bytes_ = 0;
};

struct MapFile::Impl {
  Impl(const std::filesystem::path& path, Database::Access access) : database(path, access) {}

  /// Stamp and pose of an observation, and its encoded readings; with the mutex held.
  std::string read_observation(int64_t index, Observation& observation);

  Database database;
  // Held during every use of the database: one connection serves all threads.
  std::mutex mutex;
  std::optional<Statement> select_observation;
  ObservationCache cache;
};

}  // namespace hmt::submap
