// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/overlap/overlap.hpp"

#include <algorithm>
#include <vector>

#include "common_share.hpp"
#include "count_matches.hpp"
#include "match_landmarks.hpp"
#include "sensed_landmarks.hpp"
#include "sensed_points.hpp"
#include "sensed_voxels.hpp"

namespace hmt::submap {
namespace {

/// What is known of two observations besides their readings.
struct Relation {
  Pose T_a_b;
  Matrix6d covariance_a_b;
  PoseSpread spread;
  const OverlapOptions& options;

  Relation(const Pose& T_robota_robotb, const Matrix6d& covariance,
           const OverlapOptions& overlap_options)
      : T_a_b(T_robota_robotb),
        covariance_a_b(covariance),
        spread(T_robota_robotb, covariance),
        options(overlap_options) {
    check(options);
    check_finite(T_a_b);
  }
};

/// By voxels that are laid out in the frame of a.
double voxel_overlap(const Reading& a, const Reading& b, const Relation& relation) {
  const SensedVoxels voxels_a(a, Pose{}), voxels_b(b, relation.T_a_b);
  const double common = common_voxels(voxels_a, voxels_b, relation.spread, relation.options);
  return sensed_space_overlap(voxels_a.size(), voxels_b.size(), {common, common});
}

void add_overlap(const Reading& a, const Reading& b, const Relation& relation, MeanOverlap& mean) {
  const auto points = static_cast<double>(a.points_sensor.size() + b.points_sensor.size());
  const bool cloud = is_cloud(a) || is_cloud(b);
  if (points / 2 > (cloud ? kMaxExactCloud : kMaxExactPoints)) {
    // Laid out in the frame of either, so that none comes first.
    const Relation back(relation.T_a_b.inverse(),
                        graph::inverse_covariance(relation.T_a_b, relation.covariance_a_b),
                        relation.options);
    mean.add((voxel_overlap(a, b, relation) + voxel_overlap(b, a, back)) / 2);
    return;
  }
  const OverlapOptions& options = relation.options;
  const SensedPoints points_a(a, Pose{}, options.max_mahalanobis);
  const SensedPoints points_b(b, relation.T_a_b, options.max_mahalanobis);
  mean.add(points_a.size(), points_b.size(),
           {1.0 * count_matches(points_a, points_b, relation.spread, options),
            1.0 * count_matches(points_b, points_a, relation.spread, options)});
}

void add_overlap(const LandmarkReading& a, const LandmarkReading& b, const Relation& relation,
                 MeanOverlap& mean) {
  const SensedLandmarks landmarks_a(a, Pose{}, relation.options);
  const SensedLandmarks landmarks_b(b, relation.T_a_b, relation.options);
  const double matches =
      match_landmarks(landmarks_a, landmarks_b, relation.spread, relation.options);
  mean.add(landmarks_a.size(), landmarks_b.size(), {matches, matches});
}

/// Of the sensors that both have; of several readings of one sensor the first counts.
template <typename AnyReading>
void add_overlaps(const std::vector<AnyReading>& a, const std::vector<AnyReading>& b,
                  const Relation& relation, MeanOverlap& mean) {
  const auto first_of = [](const std::vector<AnyReading>& readings, int sensor) {
    return std::find_if(readings.begin(), readings.end(),
                        [sensor](const AnyReading& r) { return r.sensor == sensor; });
  };
  for (auto reading_a = a.begin(); reading_a != a.end(); ++reading_a) {
    if (first_of(a, reading_a->sensor) != reading_a) continue;
    const auto reading_b = first_of(b, reading_a->sensor);
    if (reading_b != b.end()) add_overlap(*reading_a, *reading_b, relation, mean);
  }
}

template <typename AnyReading>
double overlap_of(const AnyReading& a, const AnyReading& b, const Relation& relation) {
  MeanOverlap mean;
  add_overlap(a, b, relation, mean);
  return mean.mean();
}

}  // namespace

double reading_overlap(const Reading& a, const Reading& b, const Pose& T_robota_robotb,
                       const Matrix6d& covariance_a_b, const OverlapOptions& options) {
  return overlap_of(a, b, Relation(T_robota_robotb, covariance_a_b, options));
}

double reading_overlap(const LandmarkReading& a, const LandmarkReading& b,
                       const Pose& T_robota_robotb, const Matrix6d& covariance_a_b,
                       const OverlapOptions& options) {
  return overlap_of(a, b, Relation(T_robota_robotb, covariance_a_b, options));
}

double observation_overlap(const Observation& a, const Observation& b, const Pose& T_robota_robotb,
                           const Matrix6d& covariance_a_b, const OverlapOptions& options) {
  const Relation relation(T_robota_robotb, covariance_a_b, options);
  MeanOverlap mean;
  add_overlaps(a.readings, b.readings, relation, mean);
  add_overlaps(a.landmark_readings, b.landmark_readings, relation, mean);
  return mean.mean();
}

}  // namespace hmt::submap
