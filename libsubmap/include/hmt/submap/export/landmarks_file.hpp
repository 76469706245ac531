// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "hmt/submap/map/hybrid_map.hpp"

namespace hmt::submap {

/// What files call a landmark: the log's name, or -1 - its number in the map where it has none.
int64_t landmark_name(const HybridMap& map, int landmark);

/// Every landmark in the world, then in each submap that saw it:
///   landmark,frame,x_m,y_m,z_m,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz
/// `frame` is `world` or the number of the submap, in whose frame the position and its covariance
/// (m^2) then are.
std::string landmarks_csv(const HybridMap& map);

/// Reads true positions: `name x y` a line, further fields and `#` comments left out (the landmark
/// file of MRCLAM is one). Planar. Throws InputError naming file and line.
std::map<int64_t, Eigen::Vector2d> read_true_landmarks(const std::filesystem::path& path);

/// Error of the landmarks of a map.
struct LandmarkError {
  int64_t true_landmarks = 0;
  int64_t matched = 0;  ///< by name
  double rmse_m = 0;    ///< of positions, after the best rigid alignment
  double max_m = 0;

  bool operator==(const LandmarkError&) const = default;
};

/// Error of the landmarks in the world, in the plane, after rigid alignment without scale [Umeyama
/// 1991]. Throws InputError with fewer than three matches, two of which any alignment would fit.
LandmarkError evaluate_landmarks(const HybridMap& map,
                                 const std::map<int64_t, Eigen::Vector2d>& truth);

}  // namespace hmt::submap
