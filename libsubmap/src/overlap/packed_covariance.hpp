// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "hmt/graph/pose.hpp"

namespace hmt::submap {

/// A symmetric 6x6 matrix, or nothing, in 88 bytes: a block of keyframes has up to a million pairs,
/// and each covariance is asked for only once since it can be dear.
class PackedCovariance {
 public:
  PackedCovariance() = default;
  explicit PackedCovariance(const std::optional<graph::Matrix6d>& covariance)
      : known_(covariance.has_value()) {
    if (!known_) return;
    size_t next = 0;
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column <= row; ++column) {
        lower_[next++] = static_cast<float>((*covariance)(row, column));
      }
    }
  }

  bool known() const { return known_; }

  graph::Matrix6d matrix() const {
    graph::Matrix6d m;
    size_t next = 0;
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column <= row; ++column) {
        m(row, column) = m(column, row) = static_cast<double>(lower_[next++]);
      }
    }
    return m;
  }

 private:
  std::array<float, 21> lower_{};
  bool known_ = false;
};

}  // namespace hmt::submap
