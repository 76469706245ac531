// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <numbers>

#include "figures.hpp"
#include "hmt/submap/export/atomic_file.hpp"
#include "robot_model.hpp"
#include "svg.hpp"

namespace hmt::paper {
namespace {

constexpr double kTau = 1;  // as in Fig. 5
// The map of Fig. 5 shows some orientation errors.
constexpr PoseSigma kSigma{0.05, 1 * std::numbers::pi / 180};

/// Room of a stand: the rooms are 7 m wide with walls of 0.2 m between.
int room_of(const submap::Pose& T_world_robot) {
  return static_cast<int>(T_world_robot.translation.x() / 7.2);
}

std::string svg_of(const Drive& drive, const SensorAreas& areas) {
  const auto walls = wall_points(drive);
  const MapView view({-0.5, -0.5}, {22.5, 6.5}, {10, 30}, {640, 200});
  Svg svg(960, 290);
  svg.text({10, 20}, "14 scans in three rooms: overlap graph and groups at tau 1");
  svg.add(R"(<path stroke="#888" fill="none" d=")" + dots(view, walls) + R"("/>)");
  for (const graph::Arc& arc : areas.overlap.arcs()) {
    const auto at = [&](int k) {
      return view(drive.T_world_robot[static_cast<size_t>(k)].translation.head<2>());
    };
    const int shade = static_cast<int>(255 * (1 - arc.weight));
    svg.line(at(arc.a), at(arc.b), fmt::format("rgb({0},{0},{0})", shade));
  }
  for (size_t k = 0; k < drive.T_world_robot.size(); ++k) {
    const submap::Pose& pose = drive.T_world_robot[k];
    svg.line(view(pose.translation.head<2>()), view((pose * Eigen::Vector3d(0.6, 0, 0)).head<2>()),
             "#000", 2);
    svg.circle(view(pose.translation.head<2>()), 6, group_color(areas.labels[k]));
  }
  draw_matrix(svg, {690, 30}, 240, areas.overlap, order_by_group(areas.labels), areas.labels);
  return svg.str();
}

}  // namespace

std::vector<Claim> draw_three_rooms(const std::filesystem::path& folder) {
  const Drive drive = scan_three_rooms(1);
  const auto all = [](const submap::Observation& o) { return o; };
  const SensorAreas areas = divide("three rooms", drive, all, kSigma, kTau, 1);
  submap::write_file(folder / "fig5.svg", svg_of(drive, areas));
  std::string csv = "scan,x_m,y_m,room,group\n";
  bool as_rooms = true;
  for (size_t k = 0; k < areas.labels.size(); ++k) {
    const Eigen::Vector3d& at = drive.T_world_robot[k].translation;
    const int room = room_of(drive.T_world_robot[k]);
    as_rooms = as_rooms && room == areas.labels[k];
    csv += fmt::format("{},{:g},{:g},{},{}\n", k, at.x(), at.y(), room, areas.labels[k]);
  }
  submap::write_file(folder / "fig5.csv", csv);
  return {{fmt::format("Fig. 5: 14 scans in three rooms, {} groups at tau 1, one a room",
                       areas.areas()),
           areas.areas() == 3 && as_rooms}};
}

}  // namespace hmt::paper
