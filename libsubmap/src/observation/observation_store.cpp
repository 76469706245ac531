// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/observation/observation_store.hpp"

#include <string>
#include <utility>

namespace hmt::submap {

ObservationVector::ObservationVector(std::vector<Observation> observations) {
  observations_.reserve(observations.size());
  for (Observation& observation : observations)
    observations_.push_back(std::make_shared<const Observation>(std::move(observation)));
}

std::shared_ptr<const Observation> ObservationVector::load(int64_t index) const {
  if (index < 0 || index >= static_cast<int64_t>(observations_.size()))
    throw InputError("observation " + std::to_string(index) + " is outside the " +
                     std::to_string(observations_.size()) + " observations in memory");
  return observations_[static_cast<size_t>(index)];
}

}  // namespace hmt::submap
