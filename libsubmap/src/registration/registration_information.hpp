// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "surface_matches.hpp"

namespace hmt::submap {

/// Inverse covariance of the pose by the last matches, if their residuals were independent and as
/// large as the points' noise: what the geometry alone fixes. Does not vanish far from the result.
Matrix6d geometric_information(const SurfaceMatcher& matcher, Space space);

/// The same with the residuals as they are, see register_surface.
Matrix6d honest_information(const SurfaceMatcher& matcher, Space space);

/// Fills in information, inliers, inlier_fraction and rmse_m from the last matches.
void summarize(const SurfaceMatcher& matcher, Space space, Registration& result);

}  // namespace hmt::submap
