// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "hmt/submap/map/hybrid_map.hpp"

// The columns of each record after its key, once for writing and reading: visit(field, field, ...)
// in the order of the table.
namespace hmt::submap {

/// The one row of table `track`.
struct TrackRecord {
  Space space = Space::se2;
  int64_t observations = 0;
  int64_t odometry_records = 0;
};

/// One count of LogReport.
struct LogNote {
  int loss = 0;  ///< 1 for a loss, 0 for a note
  std::string text;
  int64_t count = 0;
};

/// One constraint or landmark that a link is made of.
struct LinkEvidence {
  int link = 0;
  int number = 0;
};

/// The one row of table `solution`.
struct SolutionRecord {
  double information_loss = 0;
  double chi2_initial = 0;
  double chi2 = 0;
  DivisionCost division;
  double landmark_information_loss = 0;
};

/// Where one submap stands.
struct SubmapPose {
  Pose T_world_submap;
  Matrix6d covariance = Matrix6d::Zero();
};

/// Where one keyframe of a submap stands in it.
struct SubmapKeyframe {
  int keyframe = 0;
  Pose T_submap_keyframe;
  Matrix6d covariance = Matrix6d::Zero();
};

template <class T, class Record>
concept RecordOf = std::same_as<std::remove_const_t<T>, Record>;

template <class Visit>
void fields(Visit&& visit, RecordOf<int> auto& number) {
  visit(number);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<int64_t> auto& number) {
  visit(number);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<Sighting> auto& s) {
  visit(s.observation, s.place, s.keyframe, s.landmark, s.p_keyframe, s.information);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<PlacedLandmark> auto& l) {
  visit(l.landmark, l.position, l.covariance);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<Pose> auto& pose) {
  visit(pose);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<TrackRecord> auto& t) {
  visit(t.space, t.observations, t.odometry_records);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<LogNote> auto& n) {
  visit(n.loss, n.text, n.count);
}
/// The id is the key.
template <class Visit>
void fields(Visit&& visit, RecordOf<Keyframe> auto& k) {
  visit(k.observation, k.stamp_s, k.T_track_robot);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<TrackedObservation> auto& t) {
  visit(t.observation, t.stamp_s, t.keyframe, t.T_keyframe_robot);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<Constraint> auto& c) {
  visit(c.a, c.b, c.kind, c.T_a_b, c.information);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<graph::Arc> auto& arc) {
  visit(arc.a, arc.b, arc.weight);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<SubmapKeyframe> auto& k) {
  visit(k.keyframe, k.T_submap_keyframe, k.covariance);
}
/// Its evidence has its own table.
template <class Visit>
void fields(Visit&& visit, RecordOf<Link> auto& l) {
  visit(l.a, l.b, l.T_a_b, l.covariance, l.ncut, l.information_loss);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<LinkEvidence> auto& e) {
  visit(e.link, e.number);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<LoopCandidate> auto& l) {
  visit(l.a, l.b, l.submap_a, l.submap_b, l.predicted_distance_m, l.predicted_sigma_m, l.T_a_b,
        l.information, l.score, l.second_score, l.inlier_fraction, l.rmse_m, l.free_space_conflict,
        l.mahalanobis, l.chi2_rise, l.verdict, l.reason);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<SolutionRecord> auto& s) {
  visit(s.information_loss, s.chi2_initial, s.chi2, s.division.chi2_hybrid, s.division.chi2_refined,
        s.division.chi2_flat, s.landmark_information_loss);
}
template <class Visit>
void fields(Visit&& visit, RecordOf<SubmapPose> auto& p) {
  visit(p.T_world_submap, p.covariance);
}

}  // namespace hmt::submap
