// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/partition/submap_manager.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "hmt/submap/log/simulation.hpp"

namespace hmt::submap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Constraint tie(int a, int b) {
  Constraint c;
  c.a = a;
  c.b = b;
  c.information = Matrix6d::Identity();
  return c;
}

AreaEvent entered(int area, std::vector<int> keyframes) {
  return {AreaEvent::Kind::entered, area, std::move(keyframes)};
}

AreaEvent closed(int area, std::vector<int> keyframes) {
  return {AreaEvent::Kind::closed, area, std::move(keyframes)};
}

std::vector<int> range(int begin, int end) {
  std::vector<int> all(static_cast<size_t>(end - begin));
  std::iota(all.begin(), all.end(), begin);
  return all;
}

/// Rooms of ten keyframes in a row. Keyframes of a room overlap by 0.8, the last of a room and the
/// first of the next by 0.05.
std::vector<WindowArc> row_in_rooms(int keyframe) {
  std::vector<WindowArc> row;
  for (int other = keyframe / 10 * 10; other < keyframe; ++other) row.push_back({other, 0.8});
  if (keyframe > 0 && keyframe % 10 == 0) row.push_back({keyframe - 1, 0.05});
  return row;
}

std::vector<AreaEvent> add_in_rooms(SubmapManager& manager, int keyframe) {
  std::vector<Constraint> constraints;
  if (keyframe > 0) constraints.push_back(tie(keyframe - 1, keyframe));
  return manager.add_row(row_in_rooms(keyframe), constraints);
}

// Eq. 21:  [0  .5 .2]
//          [.5  0 .4]
//          [.2 .4  0]
TEST(SubmapManager, GrowsOmegaByARowAndAColumn) {
  SubmapManager manager(Space::se2);
  manager.add_row({}, {});
  manager.add_row(std::vector<WindowArc>{{0, 0.5}}, std::vector{tie(0, 1)});
  manager.add_row(std::vector<WindowArc>{{0, 0.2}, {1, 0.4}}, std::vector{tie(1, 2)});
  const graph::WeightedGraph omega = manager.window_overlap();
  EXPECT_EQ(omega.num_nodes(), 3);
  EXPECT_EQ(omega.num_arcs(), 3);
  EXPECT_DOUBLE_EQ(omega.degree(0), 0.7);
  EXPECT_DOUBLE_EQ(omega.degree(1), 0.9);
  EXPECT_DOUBLE_EQ(omega.degree(2), 0.6);
}

// A new room shows with its third keyframe, since smaller pieces join their neighbor. The first
// room does not touch the third, and is closed once that one has eight keyframes.
TEST(SubmapManager, TellsWhenAreasAreEnteredAndClosed) {
  SubmapManager manager(Space::se2);
  std::vector<std::pair<int, AreaEvent>> events;
  for (int keyframe = 0; keyframe < 30; ++keyframe)
    for (const AreaEvent& event : add_in_rooms(manager, keyframe))
      events.emplace_back(keyframe, event);
  EXPECT_THAT(events, ElementsAre(std::pair(0, entered(0, {0})),            //
                                  std::pair(12, entered(1, {10, 11, 12})),  //
                                  std::pair(22, entered(2, {20, 21, 22})),  //
                                  std::pair(27, closed(0, range(0, 10)))));
  EXPECT_EQ(manager.window(), range(10, 30));
  EXPECT_THAT(manager.finish(), ElementsAre(closed(1, range(10, 20)), closed(2, range(20, 30))));
  EXPECT_THAT(manager.window(), IsEmpty());
}

TEST(SubmapManager, KeepsAnAreaOpenThatTheRobotComesBackTo) {
  SubmapManager manager(Space::se2);
  for (int keyframe = 0; keyframe < 20; ++keyframe) add_in_rooms(manager, keyframe);
  // Back in the first room.
  std::vector<WindowArc> row;
  for (int other = 0; other < 10; ++other) row.push_back({other, 0.8});
  EXPECT_THAT(manager.add_row(row, std::vector{tie(9, 20)}),
              ElementsAre(entered(0, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 20})));
}

/// A robot that wanders: overlap falls with the distance, so areas come, merge and go.
std::vector<graph::Arc> wandering(int keyframes, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> step(-0.3, 1.0);
  std::vector<double> x = {0};
  std::vector<graph::Arc> arcs;
  for (int k = 1; k < keyframes; ++k) {
    x.push_back(x.back() + step(random));
    for (int other = 0; other < k; ++other) {
      const double distance = std::abs(x.back() - x[static_cast<size_t>(other)]);
      if (distance < 3) arcs.push_back({other, k, std::exp(-distance)});
    }
  }
  return arcs;
}

TEST(SubmapManager, HasAtEachStepTheOfflinePartitionOfItsWindow) {
  constexpr int kKeyframes = 120;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const graph::WeightedGraph whole(kKeyframes, wandering(kKeyframes, seed));
    SubmapPartitionOptions options;
    options.max_window = 60;
    SubmapManager manager(Space::se2, options);
    for (int keyframe = 0; keyframe < kKeyframes; ++keyframe) {
      const std::vector<int> window = [&] {
        std::vector<int> all = manager.window();
        all.push_back(keyframe);
        return all;
      }();
      // Rows and columns of the window in the whole matrix.
      std::vector<graph::Arc> arcs;
      for (int i = 0; i < std::ssize(window); ++i)
        for (int j = 0; j < i; ++j)
          for (const auto& [other, weight] : whole.neighbors(window[static_cast<size_t>(i)]))
            if (other == window[static_cast<size_t>(j)]) arcs.push_back({j, i, weight});
      std::vector<Constraint> ties;
      for (int i = 1; i < std::ssize(window); ++i)
        if (window[static_cast<size_t>(i)] == window[static_cast<size_t>(i) - 1] + 1)
          ties.push_back(tie(i - 1, i));
      const graph::Labels offline = partition_keyframes(
          Space::se2, {static_cast<int>(window.size()), arcs}, ties, {}, options, 1);

      std::vector<WindowArc> row;
      for (const auto& [other, weight] : whole.neighbors(keyframe))
        if (other < keyframe) row.push_back({other, weight});
      std::vector<Constraint> own;
      if (keyframe > 0) own.push_back(tie(keyframe - 1, keyframe));
      manager.add_row(row, own);
      graph::Labels online;
      for (const int k : window) online.push_back(manager.areas()[static_cast<size_t>(k)]);
      ASSERT_EQ(graph::canonical_labels(online), offline) << "keyframe " << keyframe;
    }
  }
}

// One endless hall: areas are cut where the window is full.
TEST(SubmapManager, BoundsTheWindow) {
  SubmapPartitionOptions options;
  options.max_window = 20;
  SubmapManager manager(Space::se2, options);
  std::vector<size_t> sizes;
  for (int keyframe = 0; keyframe < 100; ++keyframe) {
    std::vector<WindowArc> row;
    for (int other = 0; other < keyframe; ++other) row.push_back({other, 0.5});
    std::vector<Constraint> ties;
    if (keyframe > 0) ties.push_back(tie(keyframe - 1, keyframe));
    for (const AreaEvent& event : manager.add_row(row, ties))
      if (event.kind == AreaEvent::Kind::closed) sizes.push_back(event.keyframes.size());
    EXPECT_LT(manager.window().size(), 20u);
  }
  EXPECT_THAT(sizes, ElementsAre(20, 20, 20, 20, 20));
}

// Keyframe 10 sees nothing that the others saw, as behind a passer-by; odometry holds it.
TEST(SubmapManager, StaysInAnAreaThroughAKeyframeThatSeesNothing) {
  SubmapManager manager(Space::se2);
  for (int keyframe = 0; keyframe < 10; ++keyframe) add_in_rooms(manager, keyframe);
  EXPECT_THAT(manager.add_row({}, std::vector{tie(9, 10)}), IsEmpty());
  EXPECT_EQ(manager.areas(), graph::Labels(11, 0));
  // Even one that nothing holds closes nothing.
  EXPECT_THAT(manager.add_row({}, {}), ElementsAre(entered(1, {11})));
  EXPECT_THAT(manager.window(), SizeIs(12));
}

TEST(SubmapManager, RefusesBadInputAndChangesNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SubmapManager manager(Space::se2);
  manager.add_row({}, {});
  const auto refusal = [&](std::vector<WindowArc> row, std::vector<Constraint> constraints) {
    try {
      manager.add_row(row, constraints);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refusal({{0, nan}}, {}), HasSubstr("keyframe 1: the overlap with keyframe 0"));
  EXPECT_THAT(refusal({{0, -0.1}}, {}), HasSubstr(">= 0"));
  EXPECT_THAT(refusal({{1, 0.1}}, {}), HasSubstr("keyframe 1, which is not before it"));
  EXPECT_THAT(refusal({{-1, 0.1}}, {}), HasSubstr("not before"));
  EXPECT_THAT(refusal({{0, 0.1}, {0, 0.2}}, {}), HasSubstr("two overlaps with keyframe 0"));
  EXPECT_THAT(refusal({}, {tie(0, 2)}), HasSubstr("between keyframes 0 and 2"));
  EXPECT_THAT(refusal({}, {tie(1, 1)}), HasSubstr("between keyframes 1 and 1"));
  Pose far;
  far.translation.x() = nan;
  EXPECT_THROW(manager.add({}, far, {}, {}), InputError);
  EXPECT_THAT(manager.window(), ElementsAre(0));
  EXPECT_EQ(refusal({{0, 0.1}}, {tie(0, 1)}), "accepted");
}

TEST(SubmapManager, NamesTheOptionThatIsOutOfRange) {
  SubmapPartitionOptions options;
  options.max_window = 1;
  EXPECT_THROW(SubmapManager(Space::se2, options), InputError);
  options = {};
  options.tau = 2;
  EXPECT_THROW(SubmapManager(Space::se2, options), InputError);
  options = {};
  options.min_keyframes = 0;
  EXPECT_THROW(SubmapManager(Space::se2, options), InputError);
}

TEST(PartitionInSequence, OfNoKeyframesIsEmpty) {
  EXPECT_THAT(partition_in_sequence(Space::se2, {}, {}, {}, [](int, const AreaEvent&) {}),
              IsEmpty());
}

/// Keyframes of the robot that goes through three rooms and back, at their true poses.
class ThreeRooms : public testing::Test {
 protected:
  void SetUp() override {
    Simulation simulation({.world = "rooms"});
    while (const auto scan = simulation.next()) {
      if (!T_world_robot_.empty()) {
        const Pose move = graph::relative_pose(T_world_robot_.back(), scan->T_world_robot);
        if (move.translation.norm() < 0.5 && std::abs(move.yaw_rad()) < 0.35) continue;
      }
      observations_.push_back(scan->observation);
      T_world_robot_.push_back(scan->T_world_robot);
    }
  }

  /// Number of the room: the first is 7 m wide.
  int room(int keyframe) const {
    const double x = T_world_robot_[static_cast<size_t>(keyframe)].translation.x();
    return x < 7 ? 0 : x < 14.2 ? 1 : 2;
  }

  std::vector<AreaEvent> add(SubmapManager& manager, int keyframe) const {
    std::vector<Constraint> ties;
    if (keyframe > 0) ties.push_back(tie(keyframe - 1, keyframe));
    return manager.add(
        observations_[static_cast<size_t>(keyframe)], T_world_robot_[static_cast<size_t>(keyframe)],
        [](int, int) { return Matrix6d(1e-6 * Matrix6d::Identity()); }, ties);
  }

  std::vector<Observation> observations_;
  std::vector<Pose> T_world_robot_;
};

TEST_F(ThreeRooms, GivesOmegaOfTheWindow) {
  SubmapManager manager(Space::se2);
  for (int keyframe = 0; keyframe < 8; ++keyframe) add(manager, keyframe);
  const graph::WeightedGraph omega = manager.window_overlap();
  ASSERT_EQ(omega.num_nodes(), 8);
  for (const graph::Arc& arc : omega.arcs()) {
    const auto a = static_cast<size_t>(arc.a);
    const auto b = static_cast<size_t>(arc.b);
    EXPECT_DOUBLE_EQ(arc.weight,
                     observation_overlap(observations_[a], observations_[b],
                                         graph::relative_pose(T_world_robot_[a], T_world_robot_[b]),
                                         1e-6 * Matrix6d::Identity(), {}));
  }
  EXPECT_GT(omega.degree(0), 1);
}

TEST_F(ThreeRooms, AreAreasOfTheirOwn) {
  SubmapManager manager(Space::se2);
  std::vector<AreaEvent> all;
  const auto count = static_cast<int>(observations_.size());
  for (int keyframe = 0; keyframe < count; ++keyframe)
    for (AreaEvent& event : add(manager, keyframe)) all.push_back(std::move(event));
  for (AreaEvent& event : manager.finish()) all.push_back(std::move(event));
  std::set<int> rooms_entered;
  std::vector<int> keyframes;
  for (const AreaEvent& event : all) {
    if (event.kind == AreaEvent::Kind::entered) {
      rooms_entered.insert(room(event.keyframes.back()));
      continue;
    }
    keyframes.insert(keyframes.end(), event.keyframes.begin(), event.keyframes.end());
    // Besides a keyframe in the doorway all are in one room.
    std::map<int, int> in_room;
    for (const int k : event.keyframes) ++in_room[room(k)];
    const auto most = std::max_element(in_room.begin(), in_room.end(),
                                       [](auto l, auto r) { return l.second < r.second; });
    EXPECT_GE(most->second, std::ssize(event.keyframes) - 1) << "area " << event.area;
  }
  EXPECT_THAT(rooms_entered, ElementsAre(0, 1, 2));
  std::sort(keyframes.begin(), keyframes.end());
  EXPECT_EQ(keyframes, range(0, count));
}

}  // namespace
}  // namespace hmt::submap
