// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/weighted_graph.hpp"
#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/track.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

struct OverlapOptions {
  /// Largest Mahalanobis distance of corresponding points or landmarks [Blanco 2009, Sec. 3.1].
  double max_mahalanobis = 3.0;
  /// A point that the uncertainty of the relative pose alone moves by more than this (root mean
  /// square) matches nothing, > 0: its gate of three deviations would reach from one wall of a
  /// corridor, or one jamb of a door, to the other, so that everything would match everything.
  /// Landmarks stand apart, so theirs may be moved farther: until the gate reaches half way to the
  /// next landmark of the reading. One that the log names needs no pose.
  double max_pose_deviation_m = 0.3;
  /// Arcs below this overlap are left out, [0, 1).
  double min_overlap = 0.02;
};

/// Sensed Space Overlap of two readings of range sensors [Blanco 2009, Eq. 13, 15, 16], made
/// symmetric: matches are counted in both directions and averaged; union = |a| + |b| - matches. In
/// [0, 1]; 1 for a reading with itself at the identity; 0 if one is empty. Large clouds, of more
/// than 8192 points on average, are compared by the voxels of 0.5 m that they occupy [footnote 3],
/// whole or in part, the voxels laid out in the frame of either and the two results averaged.
/// `covariance_a_b`: of T_robota_robotb, tangent of Pose (frame b).
double reading_overlap(const Reading& a, const Reading& b, const Pose& T_robota_robotb,
                       const Matrix6d& covariance_a_b, const OverlapOptions& options);

/// Sensed Space Overlap of two readings of landmarks [Blanco 2009, Eq. 13 to 15]: matches are one
/// to one, the smallest distance first; union = |a| + |b| - matches. The same name is the same
/// landmark wherever it is seen, two names are never one; where a name is missing the Mahalanobis
/// distance decides, and descriptors where both have one: they must not be farther apart than half
/// of what is usual between the landmarks of one reading. In [0, 1]; 0 if one is empty. Throws
/// InputError where a measurement covariance is none.
double reading_overlap(const LandmarkReading& a, const LandmarkReading& b,
                       const Pose& T_robota_robotb, const Matrix6d& covariance_a_b,
                       const OverlapOptions& options);

/// Mean over the sensors that both observations have of the overlap of their readings
/// [Blanco 2009, Sec. 6.2]. A sensor with a reading in only one of them is left out, for sensors
/// may run at different rates; so is one that sensed nothing in both. One that looked and sensed
/// nothing in one of them counts with 0. 0 without any common sensor.
double observation_overlap(const Observation& a, const Observation& b, const Pose& T_robota_robotb,
                           const Matrix6d& covariance_a_b, const OverlapOptions& options);

/// Omega: the overlap of all pairs of keyframes whose sensed regions meet at the given poses and
/// whose relative pose is known well enough to tell. Never looks at the points of all n^2 pairs.
/// Where a place was visited again and again only pairs of one visit and pairs with the first few
/// visits count: a keyframe that 16 such references of other visits overlap by half or more is none
/// for later ones. So arcs grow with the keyframes, not with their square.
/// Weights equal observation_overlap up to the rounding of points and covariances to float; a
/// sensor whose readings have more than 8192 points on average is compared by voxels throughout,
/// which are laid out in the world, so its weights differ by some hundredths with the layout. Same
/// result for any number of threads. `covariance` is asked with a < b, once a pair, from several
/// threads at once; no arc where it has none. Throws InputError for options out of range, numbers
/// that are not finite and a number of poses that is not that of the keyframes; Interrupted where
/// `run` asks to stop.
graph::WeightedGraph overlap_graph(std::span<const Keyframe> keyframes,
                                   std::span<const Pose> T_world_keyframe,
                                   const PairCovariance& covariance,
                                   const ObservationStore& observations,
                                   const OverlapOptions& options, const Run& run);

/// What a section of the log shows beside what came before it.
struct SectionOverlap {
  graph::WeightedGraph graph;      ///< all keyframes; arcs with at least one end in the section
  std::vector<char> is_reference;  ///< one a keyframe; 0 where others show what it shows
};

/// The overlap of the keyframes from `first` on with each other and with those before, as
/// overlap_graph, which is that of a section that begins with the first keyframe. Those before
/// `first` are references, and their arcs with each other are left out.
SectionOverlap overlap_of_section(std::span<const Keyframe> keyframes,
                                  std::span<const Pose> T_world_keyframe, int first,
                                  const PairCovariance& covariance,
                                  const ObservationStore& observations,
                                  const OverlapOptions& options, const Run& run);

}  // namespace hmt::submap
