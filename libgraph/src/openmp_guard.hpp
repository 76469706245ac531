// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Of libgomp, which CHOLMOD brings along. Weak, because a CHOLMOD without OpenMP has none.
extern "C" {
[[gnu::weak]] int omp_get_max_active_levels();
[[gnu::weak]] void omp_set_max_active_levels(int levels);
}

namespace hmt::graph {

/// Keeps CHOLMOD on the calling thread while it lives. Its supernodal factorization otherwise
/// starts four threads whatever the machine and whatever the caller asked for; on two cores they
/// cost a quarter of the time of a solve in waiting for each other. The setting belongs to the
/// calling thread alone and is restored.
class OpenMpGuard {
 public:
  OpenMpGuard() {
    if (omp_set_max_active_levels == nullptr || omp_get_max_active_levels == nullptr) return;
    levels_ = omp_get_max_active_levels();
    omp_set_max_active_levels(0);
  }
  ~OpenMpGuard() {
    if (levels_ >= 0) omp_set_max_active_levels(levels_);
  }
  OpenMpGuard(const OpenMpGuard&) = delete;
  OpenMpGuard& operator=(const OpenMpGuard&) = delete;

 private:
  int levels_ = -1;
};

}  // namespace hmt::graph
