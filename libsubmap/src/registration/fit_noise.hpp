// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "local_fit.hpp"
#include "surface_normals.hpp"

namespace hmt::submap {

/// Noise of the points along their normals in one reading: the median over the local fits of the
/// standard deviation of their residuals. Most points lie on smooth surfaces, so corners and edges
/// do not move the median. Fits with fewer than two redundant points are left out. Kept within
/// [0.003, 0.05] m: range quantization hides the noise of a good laser from its residuals, and a
/// reading of mere clutter has no walls to tell its noise by.
double median_noise_m(const std::vector<LocalFit>& fits, int fit_parameters);

/// Whether the points of a fit lie on one smooth surface, for points of noise `noise_m`.
bool is_smooth(const LocalFit& fit, int fit_parameters, double noise_m);

/// Normal, its noise and the point's noise from a fit; the normal stays zero where the surface is
/// seen at so flat an angle, its sine below `flattest`, that it may be a chain of mixed pixels
/// between two depths.
PointNormal normal_from_fit(const LocalFit& fit, int fit_parameters, double noise_m,
                            const Eigen::Vector3d& point_sensor, double flattest);

}  // namespace hmt::submap
