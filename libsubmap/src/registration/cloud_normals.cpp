// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "fit_noise.hpp"
#include "point_grid.hpp"
#include "surface_normals.hpp"

namespace hmt::submap {
namespace {

constexpr int kPlaneParameters = 3;
constexpr double kRadius_m = 0.25;
constexpr double kCell_m = 0.5;
// Beams of a spinning sensor are much coarser in elevation than in azimuth, so the radius is wide
// in steps of the finer one; it stays below what a facade is flat over.
constexpr double kRadiusSteps = 6;
constexpr double kLargestRadius_m = 1.5;
// Where a disc bends around an edge, or over rough ground, a narrower one may still be flat.
constexpr int kNarrowings = 3;
constexpr double kNarrowing = 1.5;
// Sine of the flattest angle: the beams of several rings meet in a plane, mixed pixels do not, but
// ground beyond some 50 m shows less height than noise.
constexpr double kFlattest = 0.03;

LocalFit fit_plane(const std::vector<Eigen::Vector3d>& points, const PointGrid& grid, size_t i,
                   double radius_m) {
  LocalFitSums sums;
  grid.visit_near(points[i], radius_m, [&](size_t k) {
    const Eigen::Vector3d offset = points[k] - points[i];
    if (offset.squaredNorm() <= radius_m * radius_m) sums.add(offset);
  });
  if (sums.points() < kPlaneParameters + 1) return {.points = sums.points()};
  return sums.plane();
}

}  // namespace

std::vector<PointNormal> cloud_normals(const std::vector<Eigen::Vector3d>& points_sensor,
                                       double beam_step_rad, size_t every) {
  const PointGrid grid(points_sensor, kCell_m);
  std::vector<LocalFit> fits;
  std::vector<double> radii_m;
  for (size_t i = 0; i < points_sensor.size(); i += every) {
    const double step_m = points_sensor[i].norm() * beam_step_rad;
    radii_m.push_back(std::clamp(kRadiusSteps * step_m, kRadius_m, kLargestRadius_m));
    fits.push_back(fit_plane(points_sensor, grid, i, radii_m.back()));
  }
  const double noise_m = median_noise_m(fits, kPlaneParameters);
  std::vector<PointNormal> normals(fits.size());
  for (size_t k = 0; k < normals.size(); ++k) {
    const size_t i = k * every;
    normals[k].sigma_m = noise_m;
    for (int n = 0; n < kNarrowings && fits[k].points > kPlaneParameters + 1 &&
                    !is_smooth(fits[k], kPlaneParameters, noise_m);
         ++n) {
      radii_m[k] /= kNarrowing;
      fits[k] = fit_plane(points_sensor, grid, i, radii_m[k]);
    }
    if (is_smooth(fits[k], kPlaneParameters, noise_m))
      normals[k] = normal_from_fit(fits[k], kPlaneParameters, noise_m, points_sensor[i], kFlattest);
    // Points spread evenly over the disc of the fit are about this far from each other.
    const double points = std::max(1.0, fits[k].points / static_cast<double>(every));
    normals[k].spacing_m = radii_m[k] / std::sqrt(points);
  }
  return normals;
}

}  // namespace hmt::submap
