// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fit_noise.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

constexpr double kLeastNoise_m = 0.003;
constexpr double kLargestNoise_m = 0.05;
// Residuals of a fit within so many standard deviations of the reading's noise: one surface. The
// largest of some hundred sample deviations with few degrees of freedom stays below it.
constexpr double kSmoothFactor = 2.5;
// A fit's own residuals against the reading's: worth so many degrees of freedom of the latter.
constexpr double kPriorFreedom = 4;

}  // namespace

double median_noise_m(const std::vector<LocalFit>& fits, int fit_parameters) {
  std::vector<double> variances;
  variances.reserve(fits.size());
  for (const LocalFit& fit : fits)
    if (fit.points >= fit_parameters + 2)
      variances.push_back(fit.residual2 / (fit.points - fit_parameters));
  if (variances.empty()) return kLargestNoise_m / 2;
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  return std::clamp(std::sqrt(*middle), kLeastNoise_m, kLargestNoise_m);
}

bool is_smooth(const LocalFit& fit, int fit_parameters, double noise_m) {
  const int freedom = fit.points - fit_parameters;
  if (freedom < 1) return false;
  const double limit_m = kSmoothFactor * noise_m;
  return fit.residual2 <= limit_m * limit_m * freedom;
}

PointNormal normal_from_fit(const LocalFit& fit, int fit_parameters, double noise_m,
                            const Eigen::Vector3d& point_sensor, double flattest) {
  PointNormal result;
  const double freedom = fit.points - fit_parameters + kPriorFreedom;
  result.sigma_m = std::sqrt((fit.residual2 + kPriorFreedom * noise_m * noise_m) / freedom);
  const double towards_sensor = -fit.normal.dot(point_sensor.normalized());
  if (std::abs(towards_sensor) < flattest || fit.spread2 <= 0) return result;
  result.normal = towards_sensor > 0 ? fit.normal : Eigen::Vector3d(-fit.normal);
  result.normal_sigma_rad = result.sigma_m / std::sqrt(fit.spread2);
  return result;
}

}  // namespace hmt::submap
