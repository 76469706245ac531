// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pcl_registration.hpp"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/ndt.h>

namespace hmt::test {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr double kCorrespondence_m = 1.0;
constexpr double kConverged_m = 1e-4;
constexpr int kIterations = 50;
constexpr float kNdtCell_m = 1.0;
constexpr double kNdtStep_m = 0.1;

Cloud::Ptr as_cloud(const std::vector<Eigen::Vector3f>& points) {
  Cloud::Ptr cloud(new Cloud);
  for (const Eigen::Vector3f& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  return cloud;
}

graph::Pose align(pcl::Registration<pcl::PointXYZ, pcl::PointXYZ>& registration,
                  const std::vector<Eigen::Vector3f>& source,
                  const std::vector<Eigen::Vector3f>& target, const graph::Pose& guess) {
  registration.setInputSource(as_cloud(source));
  registration.setInputTarget(as_cloud(target));
  registration.setMaximumIterations(kIterations);
  Eigen::Matrix4d start = Eigen::Matrix4d::Identity();
  start.topLeftCorner<3, 3>() = guess.rotation_matrix();
  start.topRightCorner<3, 1>() = guess.translation;
  Cloud aligned;
  registration.align(aligned, start.cast<float>());
  const Eigen::Matrix4d T = registration.getFinalTransformation().cast<double>();
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  return {T.topRightCorner<3, 1>(), Eigen::Quaterniond(R).normalized()};
}

}  // namespace

graph::Pose register_by_pcl(PclMethod method, const std::vector<Eigen::Vector3f>& source,
                            const std::vector<Eigen::Vector3f>& target, const graph::Pose& guess) {
  if (method == PclMethod::gicp) {
    pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
    gicp.setMaxCorrespondenceDistance(kCorrespondence_m);
    return align(gicp, source, target, guess);
  }
  pcl::NormalDistributionsTransform<pcl::PointXYZ, pcl::PointXYZ> ndt;
  ndt.setResolution(kNdtCell_m);
  ndt.setStepSize(kNdtStep_m);
  ndt.setTransformationEpsilon(kConverged_m);
  return align(ndt, source, target, guess);
}

}  // namespace hmt::test
