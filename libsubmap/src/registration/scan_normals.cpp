// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fit_noise.hpp"
#include "surface_normals.hpp"

namespace hmt::submap {
namespace {

constexpr int kLineParameters = 2;
// Half length of the piece of wall that a line is fitted to: furniture is straight over it, and
// noise of a centimetre turns the line by less than a few degrees. At least so many spacings.
constexpr double kHalfLength_m = 0.15;
constexpr double kHalfLengthSpacings = 2.5;
// Sine of the flattest angle, about 4.6 degrees, at which a surface is told from mixed pixels.
constexpr double kFlattest = 0.08;

// Neighbouring beams see one surface if it is met at more than about 10 degrees (spacing at most
// 6 times that of a surface across the beam), give or take noise.
bool same_surface(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double beam_step_rad) {
  constexpr double kStretch = 6, kNoise_m = 0.03;
  const double nearer_m = std::min(a.norm(), b.norm());
  const double angle_rad = std::atan2(std::abs(a.x() * b.y() - a.y() * b.x()), a.dot(b));
  if (angle_rad > 3.5 * beam_step_rad) return false;
  const double limit_m = kStretch * nearer_m * std::max(angle_rad, beam_step_rad) + kNoise_m;
  return (a - b).norm() <= limit_m;
}

// The points to the left and to the right of each that lie on its surface and near it.
struct Window {
  size_t first = 0;
  size_t last = 0;  // inclusive
  double spacing_m = 0;
};

Window window_of(const std::vector<Eigen::Vector3d>& points, const std::vector<char>& joined,
                 size_t i, double beam_step_rad) {
  // joined[k]: points k and k + 1 are on one surface.
  const bool left = i > 0 && joined[i - 1];
  const bool right = i + 1 < points.size() && joined[i];
  Window window{i, i, points[i].norm() * beam_step_rad};
  if (left && right)
    window.spacing_m =
        std::min((points[i] - points[i - 1]).norm(), (points[i] - points[i + 1]).norm());
  else if (left || right)
    window.spacing_m = (points[i] - points[left ? i - 1 : i + 1]).norm();
  const double reach_m = std::max(kHalfLength_m, kHalfLengthSpacings * window.spacing_m);
  while (window.first > 0 && joined[window.first - 1] &&
         (points[window.first - 1] - points[i]).norm() <= reach_m)
    --window.first;
  while (window.last + 1 < points.size() && joined[window.last] &&
         (points[window.last + 1] - points[i]).norm() <= reach_m)
    ++window.last;
  return window;
}

LocalFit fit_line(const std::vector<Eigen::Vector3d>& points, size_t first, size_t last,
                  size_t origin) {
  LocalFitSums sums;
  for (size_t k = first; k <= last; ++k) sums.add(points[k] - points[origin]);
  if (sums.points() < kLineParameters + 1) return {.points = sums.points()};
  return sums.line();
}

// The line through both sides of the point, or at a corner through the straighter one of them.
LocalFit best_line(const std::vector<Eigen::Vector3d>& points, const Window& window,
                   const LocalFit& both, size_t i, double noise_m) {
  if (is_smooth(both, kLineParameters, noise_m)) return both;
  const LocalFit left = fit_line(points, window.first, i, i);
  const LocalFit right = fit_line(points, i, window.last, i);
  const bool left_smooth = is_smooth(left, kLineParameters, noise_m);
  const bool right_smooth = is_smooth(right, kLineParameters, noise_m);
  if (!left_smooth && !right_smooth) return {};
  if (left_smooth && right_smooth) {
    const double left_variance = left.residual2 / (left.points - kLineParameters);
    const double right_variance = right.residual2 / (right.points - kLineParameters);
    return left_variance <= right_variance ? left : right;
  }
  return left_smooth ? left : right;
}

// How much more the directions of fits scatter than independent noise of the points explains:
// ranges come in steps, and walls have texture, both of which neighbors share. From the angle
// between the lines to the left and to the right of a point, as median over the scan of its square
// over the expected one; at least 1.
double direction_excess(const std::vector<Eigen::Vector3d>& points,
                        const std::vector<Window>& windows, double noise_m) {
  constexpr size_t kStride = 3;
  constexpr double kMedianOfChi2 = 0.4549;  // one degree of freedom
  std::vector<double> ratios;
  for (size_t i = 0; i < points.size(); i += kStride) {
    const LocalFit left = fit_line(points, windows[i].first, i, i);
    const LocalFit right = fit_line(points, i, windows[i].last, i);
    if (!is_smooth(left, kLineParameters, noise_m) || !is_smooth(right, kLineParameters, noise_m))
      continue;
    const double sine = left.normal.cross(right.normal).norm();
    const double variance = noise_m * noise_m * (1 / left.spread2 + 1 / right.spread2);
    ratios.push_back(sine * sine / variance);
  }
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return std::max(1.0, std::sqrt(*middle / kMedianOfChi2));
}

}  // namespace

std::vector<PointNormal> scan_normals(const std::vector<Eigen::Vector3d>& points_sensor,
                                      double beam_step_rad) {
  const size_t n = points_sensor.size();
  std::vector<char> joined(n, 0);
  for (size_t i = 0; i + 1 < n; ++i)
    joined[i] = same_surface(points_sensor[i], points_sensor[i + 1], beam_step_rad);
  std::vector<Window> windows(n);
  std::vector<LocalFit> fits(n);
  for (size_t i = 0; i < n; ++i) {
    windows[i] = window_of(points_sensor, joined, i, beam_step_rad);
    fits[i] = fit_line(points_sensor, windows[i].first, windows[i].last, i);
  }
  const double noise_m = median_noise_m(fits, kLineParameters);
  const double excess = direction_excess(points_sensor, windows, noise_m);
  std::vector<PointNormal> normals(n);
  for (size_t i = 0; i < n; ++i) {
    const LocalFit fit = best_line(points_sensor, windows[i], fits[i], i, noise_m);
    if (fit.points > 0)
      normals[i] = normal_from_fit(fit, kLineParameters, noise_m, points_sensor[i], kFlattest);
    else
      normals[i].sigma_m = noise_m;
    normals[i].normal_sigma_rad *= excess;
    normals[i].spacing_m = windows[i].spacing_m;
  }
  return normals;
}

}  // namespace hmt::submap
