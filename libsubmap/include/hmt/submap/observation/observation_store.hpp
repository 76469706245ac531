// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// Where the stages after reading get the sensed points from: the map file, or memory in tests.
/// Safe to call from many threads at once.
class ObservationStore {
 public:
  virtual ~ObservationStore() = default;
  /// The observation of that index in the log; throws InputError if it is not there or damaged.
  virtual std::shared_ptr<const Observation> load(int64_t index) const = 0;
};

/// Observations held in memory; index i is the i-th.
class ObservationVector : public ObservationStore {
 public:
  explicit ObservationVector(std::vector<Observation> observations);
  std::shared_ptr<const Observation> load(int64_t index) const override;

 private:
  // Shared with those who loaded an observation and may outlive this store.
  std::vector<std::shared_ptr<const Observation>> observations_;
};

}  // namespace hmt::submap
