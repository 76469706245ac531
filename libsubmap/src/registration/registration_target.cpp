// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration_target.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hmt::submap {
namespace {

constexpr double kSearchCell_m = 0.25;
// In space a cell of twice the side holds as many points, and there are fewer to look into.
constexpr double kCloudSearchCell_m = 0.5;

struct PlacedPoint {
  uint64_t key = 0;  // cell and side that the normal points to
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  double weight = 0;
  double normal_variance = 0;
  double spacing_m = 0;
  uint32_t surface = 0;
  uint32_t index = 0;
};

uint64_t merge_key(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double cell_m) {
  const auto part = [cell_m](double v) {
    const double cell = std::clamp(std::floor(v / cell_m), -524288.0, 524287.0);
    return static_cast<uint64_t>(static_cast<int64_t>(cell) + 524288);
  };
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const uint64_t side = 2 * static_cast<uint64_t>(axis) + (normal[axis] < 0 ? 1 : 0);
  return (part(point.x()) << 43) | (part(point.y()) << 23) | (part(point.z()) << 3) | side;
}

std::vector<PlacedPoint> place(std::span<const RegistrationTarget::Placed> surfaces,
                               double cell_m) {
  std::vector<PlacedPoint> placed;
  for (size_t s = 0; s < surfaces.size(); ++s) {
    const Surface& surface = *surfaces[s].surface;
    const Pose& T_target_robot = surfaces[s].T_target_robot;
    const Eigen::Matrix3d R = T_target_robot.rotation_matrix();
    for (size_t i = 0; i < surface.size(); ++i) {
      if (surface.normals_robot[i].isZero(0)) continue;
      PlacedPoint p;
      p.point = R * surface.points_robot[i] + T_target_robot.translation;
      p.normal = R * surface.normals_robot[i];
      p.key = merge_key(p.point, p.normal, cell_m);
      p.weight = 1 / (surface.sigma_m[i] * surface.sigma_m[i]);
      p.normal_variance = surface.normal_sigma_rad[i] * surface.normal_sigma_rad[i];
      p.spacing_m = surface.spacing_m[i];
      p.surface = static_cast<uint32_t>(s);
      p.index = static_cast<uint32_t>(placed.size());
      placed.push_back(p);
    }
  }
  return placed;
}

// Weighted means over points [begin, end) of one key. Normals of one surface are made from the same
// neighbors, so only different surfaces lower the variance of the direction.
SurfaceElement merge(std::span<const PlacedPoint> points) {
  SurfaceElement element;
  double weight = 0;
  double normal_variance = 0;
  double spacing_m = points[0].spacing_m;
  for (size_t i = 0; i < points.size(); ++i) {
    const PlacedPoint& p = points[i];
    weight += p.weight;
    element.point += p.weight * p.point;
    element.normal += p.weight * p.normal;
    normal_variance += p.normal_variance;
    spacing_m = std::min(spacing_m, p.spacing_m);
    if (i == 0 || p.surface != points[i - 1].surface) ++element.surfaces;
  }
  element.point /= weight;
  element.normal.normalize();
  element.variance = 1 / weight;
  element.normal_variance = normal_variance / static_cast<double>(points.size()) / element.surfaces;
  element.spacing_m = spacing_m;
  return element;
}

}  // namespace

RegistrationTarget::RegistrationTarget(std::span<const Placed> surfaces, double cell_m)
    : impl_(std::make_unique<Impl>()) {
  std::vector<PlacedPoint> placed = place(surfaces, cell_m);
  std::sort(placed.begin(), placed.end(), [](const PlacedPoint& a, const PlacedPoint& b) {
    return std::pair(a.key, a.index) < std::pair(b.key, b.index);
  });
  std::vector<Eigen::Vector3d> points;
  for (size_t begin = 0; begin < placed.size();) {
    size_t end = begin + 1;
    while (end < placed.size() && placed[end].key == placed[begin].key) ++end;
    impl_->elements.push_back(merge(std::span(placed).subspan(begin, end - begin)));
    points.push_back(impl_->elements.back().point);
    begin = end;
  }
  impl_->planar = std::all_of(points.begin(), points.end(),
                              [](const Eigen::Vector3d& p) { return p.z() == 0; });
  impl_->grid =
      PointGrid(points, impl_->planar ? kSearchCell_m : std::max(kCloudSearchCell_m, 2 * cell_m));
}

RegistrationTarget::~RegistrationTarget() = default;
RegistrationTarget::RegistrationTarget(RegistrationTarget&&) noexcept = default;
RegistrationTarget& RegistrationTarget::operator=(RegistrationTarget&&) noexcept = default;

size_t RegistrationTarget::size() const {
  return impl_->elements.size();
}

}  // namespace hmt::submap
