// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "figures.hpp"
#include "hmt/submap/export/atomic_file.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "read_log.hpp"
#include "robot_model.hpp"

namespace hmt::paper {
namespace {

using submap::Observation;
using submap::Reading;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTau = 2.0 / 3.0;  // the default of hmtmap
const std::vector<double> kOtherTaus = {0.3, 0.4, 0.5, 0.6, 0.8, 1.0};

Observation only(const Observation& from, std::vector<Reading> readings, bool landmarks) {
  Observation observation = from;
  observation.readings = std::move(readings);
  if (!landmarks) observation.landmark_readings.clear();
  return observation;
}

/// The part of the scan within so many degrees, as sensor number `sensor`.
Reading cut_view(const Observation& observation, double view_deg, int sensor) {
  Reading reading = observation.readings.at(0);
  reading.sensor = sensor;
  const auto outside = [=](const Eigen::Vector3f& p) {
    return std::abs(std::atan2(p.y(), p.x())) > view_deg / 2 * kDegree;
  };
  std::erase_if(reading.points_sensor, outside);
  std::erase_if(reading.misses_sensor, outside);
  return reading;
}

std::string areas_csv(const std::vector<SensorAreas>& rows) {
  std::string csv = fmt::format("sensors,keyframes,areas_at_tau_{:.4f}", kTau);
  for (const double tau : kOtherTaus) csv += fmt::format(",areas_at_tau_{:g}", tau);
  for (const SensorAreas& row : rows) {
    csv += fmt::format("\n{},{},{}", row.name, row.labels.size(), row.areas());
    for (const double tau : kOtherTaus) csv += fmt::format(",{}", areas_at(row, tau));
  }
  return csv + "\n";
}

void write(const std::filesystem::path& folder, const std::string& name, const std::string& title,
           const Drive& drive, const std::vector<SensorAreas>& rows) {
  submap::write_file(folder / (name + ".svg"), sensors_svg(title, drive, wall_points(drive), rows));
  submap::write_file(folder / (name + ".csv"), areas_csv(rows));
}

/// Poses of a log by their stamp in tenths of milliseconds, and its scans that have one.
Drive read_drive(const std::filesystem::path& data, const std::string& name) {
  std::map<int64_t, submap::Pose> poses;
  const auto key = [](double stamp_s) { return std::llround(stamp_s * 1e4); };
  for (const auto& p : submap::read_tum(data / (name + ".keyframes.tum")))
    poses[key(p.stamp_s)] = p.T_world_robot;
  Drive drive;
  for (Observation& observation : test::read_log(data / (name + ".clf.bz2"))) {
    const auto pose = poses.find(key(observation.stamp_s));
    if (pose == poses.end()) continue;
    if (!drive.T_world_robot.empty() && !is_next_keyframe(drive.T_world_robot.back(), pose->second))
      continue;
    drive.T_world_robot.push_back(pose->second);
    drive.observations.push_back(std::move(observation));
  }
  return drive;
}

std::vector<SensorAreas> divide_by_sensors(const Drive& drive, int threads) {
  const PoseSigma sigma{0.02, 0.2 * kDegree};
  std::vector<SensorAreas> rows;
  const auto add = [&](const std::string& name, const auto& keep) {
    rows.push_back(divide(name, drive, keep, sigma, kTau, threads));
  };
  add("one laser of 180 deg",
      [](const Observation& o) { return only(o, {o.readings.at(kFrontLaser)}, false); });
  add("two lasers of 360 deg",
      [](const Observation& o) { return only(o, {whole_scan(o)}, false); });
  add("camera of 65 deg", [](const Observation& o) { return only(o, {}, true); });
  add("two lasers and camera", [](const Observation& o) { return only(o, {whole_scan(o)}, true); });
  return rows;
}

}  // namespace

std::vector<Claim> draw_sensors(const std::filesystem::path& folder,
                                const std::vector<std::string>& worlds, int threads) {
  std::vector<Claim> claims;
  for (const std::string& world : worlds) {
    const Drive drive = simulate_robot(world, 1);
    const std::vector<SensorAreas> rows = divide_by_sensors(drive, threads);
    write(folder, "fig9_" + world, "A robot with three sensors in the simulated world " + world,
          drive, rows);
    const int one = rows[0].areas();
    const int two = rows[1].areas();
    const int camera = rows[2].areas();
    const int all = rows[3].areas();
    claims.push_back(
        {fmt::format("Fig. 9, simulated {}: {} areas by 65 deg > {} by 180 deg > {} by 360 deg",
                     world, camera, one, two),
         camera > one && one > two});
    claims.push_back(
        {fmt::format("Fig. 9, simulated {}: {} areas by all sensors together, between {} and {}",
                     world, all, two, camera),
         two <= all && all < camera});
  }
  return claims;
}

std::vector<Claim> draw_real_log(const std::filesystem::path& folder,
                                 const std::filesystem::path& data, const std::string& name,
                                 int threads) {
  const Drive drive = read_drive(data, name);
  // As good as the reference poses are between neighbors: some centimetres, half a degree.
  const PoseSigma sigma{0.05, 0.5 * kDegree};
  std::vector<SensorAreas> rows;
  for (const double view_deg : {65.0, 90.0, 120.0, 180.0})
    rows.push_back(divide(
        fmt::format("{:g} deg", view_deg), drive,
        [=](const Observation& o) { return only(o, {cut_view(o, view_deg, 0)}, false); }, sigma,
        kTau, threads));
  rows.push_back(divide(
      "65 deg and 180 deg as two sensors", drive,
      [](const Observation& o) {
        return only(o, {cut_view(o, 180, 0), cut_view(o, 65, 1)}, false);
      },
      sigma, kTau, threads));
  write(folder, "fig9_" + name, name + ", its field of view cut", drive, rows);
  const int narrow = rows[0].areas();
  const int wide = rows[3].areas();
  const int both = rows[4].areas();
  return {{fmt::format("Fig. 9, {}: {} areas by 65 deg > {} by 90 > {} by 120 > {} by 180 deg",
                       name, narrow, rows[1].areas(), rows[2].areas(), wide),
           narrow > rows[1].areas() && rows[1].areas() > rows[2].areas() && rows[2].areas() > wide},
          {fmt::format("Fig. 9, {}: {} areas by 65 and 180 deg together, between", name, both),
           wide <= both && both <= narrow}};
}

}  // namespace hmt::paper
