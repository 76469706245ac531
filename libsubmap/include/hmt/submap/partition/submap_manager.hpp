// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "hmt/graph/weighted_graph.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "hmt/submap/partition/submap_partition.hpp"

namespace hmt::submap {

/// An entry of the new row and column of Omega [Blanco 2009, Eq. 21].
struct WindowArc {
  int keyframe = 0;    ///< an earlier one
  double overlap = 0;  ///< SSO of the new keyframe with it, >= 0
};

/// What one more keyframe brought about.
struct AreaEvent {
  enum class Kind {
    entered,  ///< the robot is in another area than at the keyframe before
    closed    ///< the area is what it is from now on
  };
  Kind kind = Kind::entered;
  /// Areas are numbered 0.. as they are entered; the number of one that dissolved into others is
  /// given again.
  int area = 0;
  std::vector<int> keyframes;  ///< of the area, ascending; of one that is closed all there will be

  bool operator==(const AreaEvent&) const = default;
};

/// Sequential use of the partition [Blanco 2009, Sec. 5]: for each new keyframe Omega of the window
/// of recent keyframes grows by a row and a column (Eq. 21), the window is partitioned, and it is
/// told whether the robot has entered another area and which areas are closed.
///
/// An area is closed, and its keyframes leave the window, as soon as none of its keyframes overlaps
/// the area that the robot is in, provided that this one has min_keyframes keyframes: then nothing
/// that the robot sees changes it. If the window is full all the same, the area that the robot has
/// not been in for longest is closed; where there is but one, that one.
///
/// A step takes time linear in the window's keyframes for the row and about linear in its arcs for
/// the partition; memory is that of the window besides one number a keyframe.
class SubmapManager {
 public:
  /// Throws InputError for options out of range.
  explicit SubmapManager(Space space, const SubmapPartitionOptions& options = {},
                         const OverlapOptions& overlap = {});

  /// Adds the next keyframe (numbers are given in the order of the calls, 0..) with what it saw.
  /// Its row of Omega is observation_overlap with the window's keyframes that `covariance`, asked
  /// with a < b, knows the relative pose of. `T_world_keyframe` by the present estimate of the
  /// trajectory; only poses relative to recent keyframes matter. `constraints` (b is the new
  /// keyframe) hold an area together, see partition_keyframes; those with keyframes that have left
  /// the window are ignored. Throws InputError for numbers that are not finite or out of range, and
  /// changes nothing then.
  std::vector<AreaEvent> add(const Observation& observation, const Pose& T_world_keyframe,
                             const PairCovariance& covariance,
                             std::span<const Constraint> constraints);

  /// The same with a row that is known already. Later keyframes that are added with their
  /// observations do not overlap this one.
  std::vector<AreaEvent> add_row(std::span<const WindowArc> row,
                                 std::span<const Constraint> constraints);

  /// Closes what is open: the log has ended. The next keyframe begins with an empty window.
  std::vector<AreaEvent> finish();

  /// Keyframes in the window, ascending.
  const std::vector<int>& window() const { return window_; }
  /// Omega of the window; node i is keyframe window()[i].
  graph::WeightedGraph window_overlap() const;
  /// Area of every keyframe so far; that of keyframes in the window may still change.
  const graph::Labels& areas() const { return areas_; }

 private:
  struct Seen {
    Observation observation;  ///< without readings where only the row is known
    Pose T_world_keyframe;
  };

  std::vector<AreaEvent> step(std::span<const WindowArc> row,
                              std::span<const Constraint> constraints, Seen seen);
  void check(std::span<const WindowArc> row, std::span<const Constraint> constraints) const;
  int position(int keyframe) const;
  graph::Labels partition_window() const;
  void name_areas(const graph::Labels& groups);
  int free_number(const std::vector<int>& taken) const;
  std::vector<int> keyframes_of(int area) const;
  std::vector<int> finished_areas() const;
  std::vector<int> crowded_out() const;
  AreaEvent close(int area);

  Space space_;
  SubmapPartitionOptions options_;
  OverlapOptions overlap_;
  std::vector<int> window_;
  std::vector<Seen> seen_;               ///< of the window
  std::vector<graph::Arc> arcs_;         ///< of the window, between keyframes
  std::vector<Constraint> constraints_;  ///< of the window
  graph::Labels areas_;
  int current_ = -1;             ///< the area that the robot is in
  std::vector<char> is_closed_;  ///< for each area
};

/// The partition of a whole map by a SubmapManager in one pass over its keyframes: Omega and the
/// constraints of each keyframe with those before it are handed on one keyframe after the other.
/// `report` is called for each event with the keyframe that it came with.
graph::Labels partition_in_sequence(
    Space space, const graph::WeightedGraph& overlap, std::span<const Constraint> constraints,
    const SubmapPartitionOptions& options,
    const std::function<void(int keyframe, const AreaEvent&)>& report);

}  // namespace hmt::submap
