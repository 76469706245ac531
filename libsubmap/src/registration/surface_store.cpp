// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface_store.hpp"

#include <utility>

namespace hmt::submap {
namespace {

size_t size_in_memory(const Surface& surface) {
  return sizeof(Surface) + surface.size() * (2 * sizeof(Eigen::Vector3d) + 3 * sizeof(double));
}

}  // namespace

SurfaceStore::SurfaceStore(const ObservationStore& observations, size_t cache_bytes)
    : observations_(observations), cache_(cache_bytes) {}

std::shared_ptr<const Surface> SurfaceStore::load(int64_t observation) const {
  if (auto cached = cache_.find(observation)) return cached;
  auto surface = std::make_shared<const Surface>(make_surface(*observations_.load(observation)));
  cache_.insert(observation, surface, size_in_memory(*surface));
  return surface;
}

}  // namespace hmt::submap
