// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "floor_plan.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/submap/log/simulation.hpp"
#include "random.hpp"

namespace hmt::submap {
namespace {

using Eigen::Vector2d;
using Path = std::vector<Vector2d>;

constexpr double kHalfWidth = 1.25;  // of a corridor, metres
constexpr double kWallThickness = 0.2;
constexpr double kHalfDoor = 0.5;

Box box(double x0, double y0, double x1, double y1) {
  return {Vector2d(std::min(x0, x1), std::min(y0, y1)),
          Vector2d(std::max(x0, x1), std::max(y0, y1))};
}

/// A room beside a horizontal corridor, with a doorway in the middle of the wall between.
struct SideRoom {
  double x0 = 0;
  double x1 = 0;
  double corridor_y = 0;
  double depth = 0;
  double side = 1;  ///< 1: north of the corridor, -1: south

  double door_x() const { return (x0 + x1) / 2; }
  double wall_y() const { return corridor_y + side * (kHalfWidth + kWallThickness); }
  Vector2d middle() const { return {door_x(), wall_y() + side * depth / 2}; }
};

void add(const SideRoom& room, FloorPlan& plan) {
  plan.free.push_back(box(room.x0, room.wall_y(), room.x1, room.wall_y() + room.side * room.depth));
  plan.free.push_back(box(room.door_x() - kHalfDoor, room.wall_y(), room.door_x() + kHalfDoor,
                          room.wall_y() - room.side * kWallThickness));
}

/// A box against each of the two far corners of the room, of random size.
void furnish(const SideRoom& room, Random& random, FloorPlan& plan) {
  const double back = room.wall_y() + room.side * room.depth;
  const double most = (room.x1 - room.x0) / 4;
  const double left = random.uniform(0.3, most);
  const double right = random.uniform(0.3, most);
  plan.furniture.push_back(
      box(room.x0, back, room.x0 + left, back - room.side * random.uniform(0.3, room.depth / 3)));
  plan.furniture.push_back(
      box(room.x1, back, room.x1 - right, back - room.side * random.uniform(0.3, room.depth / 3)));
}

/// From the corridor into the middle of the room and back.
void visit(const SideRoom& room, Path& path) {
  const Vector2d before_door(room.door_x(), room.corridor_y);
  for (const Vector2d& corner : {before_door, room.middle(), before_door}) path.push_back(corner);
}

std::vector<SideRoom> row_of_rooms(double x0, double x1, int count, double corridor_y, double depth,
                                   double side) {
  std::vector<SideRoom> rooms;
  const double pitch = (x1 - x0) / count;
  for (int i = 0; i < count; ++i)
    rooms.push_back(
        {x0 + i * pitch, x0 + (i + 1) * pitch - kWallThickness, corridor_y, depth, side});
  return rooms;
}

FloorPlan three_rooms(Random& random) {
  FloorPlan plan;
  static constexpr double kWidth = 7;
  static constexpr double kDepth = 6;
  for (int i = 0; i < 3; ++i) {
    const double x0 = i * (kWidth + kWallThickness);
    plan.free.push_back(box(x0, 0, x0 + kWidth, kDepth));
    if (i > 0) plan.free.push_back(box(x0 - kWallThickness, 2.5, x0, 3.5));
    plan.furniture.push_back(
        box(x0, kDepth, x0 + random.uniform(0.5, 2.5), kDepth - random.uniform(0.4, 1.5)));
    plan.furniture.push_back(
        box(x0 + kWidth, 0, x0 + kWidth - random.uniform(0.5, 2.5), random.uniform(0.4, 1.5)));
  }
  plan.path = [](int) {
    // Around the middle of each room, to the last and back.
    Path path = {{1.5, 3}};
    for (const int room : {0, 1, 2, 1, 0}) {
      const double x = room * (kWidth + kWallThickness) + kWidth / 2;
      for (const Vector2d& corner : {Vector2d(x - 1.5, 3), Vector2d(x, 4), Vector2d(x + 1.5, 3),
                                     Vector2d(x, 2), Vector2d(x, 3)})
        path.push_back(corner);
    }
    path.emplace_back(1.5, 3);
    return path;
  };
  return plan;
}

FloorPlan corridor(Random& random) {
  static constexpr double kLength = 100;
  FloorPlan plan;
  plan.free.push_back(box(-2, -kHalfWidth, kLength + 2, kHalfWidth));
  for (const double side : {-1.0, 1.0})
    for (double x = 2; x < kLength; x += random.uniform(3, 8))
      plan.free.push_back(box(x, side * kHalfWidth, x + random.uniform(0.8, 2),
                              side * (kHalfWidth + random.uniform(0.15, 1.2))));
  plan.path = [](int) { return Path{{0, 0}, {kLength, 0}, {0, 0}}; };
  return plan;
}

FloorPlan building(Random& random) {
  static constexpr double kLength = 36;
  static constexpr double kDepth = 24;
  static constexpr int kRooms = 4;
  FloorPlan plan;
  for (const double y : {0.0, kDepth})
    plan.free.push_back(box(-kHalfWidth, y - kHalfWidth, kLength + kHalfWidth, y + kHalfWidth));
  for (const double x : {0.0, kLength})
    plan.free.push_back(box(x - kHalfWidth, -kHalfWidth, x + kHalfWidth, kDepth + kHalfWidth));
  const double x0 = kHalfWidth + kWallThickness;
  const double x1 = kLength - kHalfWidth;
  // South corridor: rooms north and south of it; north corridor: rooms south and north of it.
  const std::array rows = {
      row_of_rooms(x0, x1, kRooms, 0, 8, 1), row_of_rooms(x0, x1, kRooms, 0, 6, -1),
      row_of_rooms(x0, x1, kRooms, kDepth, 7, -1), row_of_rooms(x0, x1, kRooms, kDepth, 5, 1)};
  for (const auto& row : rows)
    for (const SideRoom& room : row) {
      add(room, plan);
      furnish(room, random, plan);
    }
  plan.path = [rows](int lap) {
    const auto room = [&](size_t row, int k) { return rows[row][static_cast<size_t>(k % kRooms)]; };
    Path path = {{0, 0}};
    visit(room(0, lap), path);
    visit(room(1, lap + 2), path);
    path.insert(path.end(), {{kLength, 0}, {kLength, kDepth}});
    visit(room(3, lap + 3), path);
    visit(room(2, lap + 1), path);
    path.insert(path.end(), {{0, kDepth}, {0, 0}});
    visit(room(0, lap), path);
    path.emplace_back(0, 0);
    return path;
  };
  return plan;
}

/// A corridor of 200 m that closes a loop, with equal rooms on its outer side: every side looks
/// like the one across.
FloorPlan ring() {
  static constexpr double kLength = 70;
  static constexpr double kDepth = 30;
  static constexpr int kRooms = 12;
  FloorPlan plan;
  for (const double y : {0.0, kDepth})
    plan.free.push_back(box(-kHalfWidth, y - kHalfWidth, kLength + kHalfWidth, y + kHalfWidth));
  for (const double x : {0.0, kLength})
    plan.free.push_back(box(x - kHalfWidth, -kHalfWidth, x + kHalfWidth, kDepth + kHalfWidth));
  const std::array rows = {row_of_rooms(0, kLength, kRooms, 0, 5, -1),
                           row_of_rooms(0, kLength, kRooms, kDepth, 5, 1)};
  for (const auto& row : rows)
    for (const SideRoom& room : row) add(room, plan);
  plan.path = [rows](int lap) {
    const auto enter = [&](size_t row, int k, Path& path) {
      visit(rows[row][static_cast<size_t>((k + lap) % kRooms)], path);
    };
    Path path = {{0, 0}};
    enter(0, 2, path);
    path.insert(path.end(), {{kLength, 0}, {kLength, kDepth}});
    enter(1, 7, path);
    path.insert(path.end(), {{0, kDepth}, {0, 0}, {20, 0}, {0, 0}});
    return path;
  };
  return plan;
}

FloorPlan symmetric() {
  static constexpr double kLength = 200;
  static constexpr int kRooms = 33;
  FloorPlan plan;
  plan.free.push_back(box(0, -kHalfWidth, kLength, kHalfWidth));
  const std::array rows = {row_of_rooms(0, kLength, kRooms, 0, 5, 1),
                           row_of_rooms(0, kLength, kRooms, 0, 5, -1)};
  for (const auto& row : rows)
    for (const SideRoom& room : row) add(room, plan);
  plan.path = [rows](int lap) {
    Path path = {{1, 0}};
    for (int k = lap % 3; k < kRooms; k += 3)
      visit(rows[static_cast<size_t>(k % 2)][static_cast<size_t>(k)], path);
    path.insert(path.end(), {{kLength - 1, 0}, {1, 0}});
    return path;
  };
  return plan;
}

}  // namespace

std::vector<std::string> simulated_worlds() {
  return {"building", "corridor", "ring", "rooms", "symmetric"};
}

FloorPlan make_floor_plan(const std::string& name, uint64_t seed) {
  Random random(seed);
  if (name == "building") return building(random);
  if (name == "corridor") return corridor(random);
  if (name == "ring") return ring();
  if (name == "rooms") return three_rooms(random);
  if (name == "symmetric") return symmetric();
  std::string known;
  for (const std::string& world : simulated_worlds()) known += " " + world;
  throw InputError("unknown world '" + name + "'; there are" + known);
}

}  // namespace hmt::submap
