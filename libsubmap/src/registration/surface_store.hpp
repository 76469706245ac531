// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "../observation/recently_used.hpp"
#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/surface.hpp"

namespace hmt::submap {

/// The surfaces of observations, made where they are asked for and kept for a while: a keyframe is
/// registered onto several others, and making its surface costs as much as a registration. Safe to
/// call from many threads at once.
class SurfaceStore {
 public:
  /// `observations` must outlive the store. Keeps surfaces of up to so many bytes.
  SurfaceStore(const ObservationStore& observations, size_t cache_bytes);
  /// Throws InputError if the observation is not there or damaged.
  std::shared_ptr<const Surface> load(int64_t observation) const;

 private:
  const ObservationStore& observations_;
  mutable RecentlyUsed<Surface> cache_;
};

}  // namespace hmt::submap
