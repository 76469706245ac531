// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "log_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <numbers>

namespace hmt::apps {
namespace {

constexpr double kDegPerRad = 180 / std::numbers::pi;

double beams_per_reading(const submap::SensorSummary& sensor) {
  return static_cast<double>(sensor.points + sensor.misses) /
         static_cast<double>(std::max<int64_t>(1, sensor.readings));
}

double miss_share(const submap::SensorSummary& sensor) {
  return static_cast<double>(sensor.misses) /
         static_cast<double>(std::max<int64_t>(1, sensor.points + sensor.misses));
}

nlohmann::ordered_json sensor_json(const submap::SensorSummary& sensor) {
  const auto& p = sensor.T_robot_sensor.translation;
  return {{"sensor", sensor.sensor},
          {"readings", sensor.readings},
          {"points", sensor.points},
          {"misses", sensor.misses},
          {"beams_per_reading", beams_per_reading(sensor)},
          {"beam_step_deg", sensor.beam_step_rad * kDegPerRad},
          {"max_range_m", sensor.max_range_m},
          {"mount",
           {{"x_m", p.x()},
            {"y_m", p.y()},
            {"z_m", p.z()},
            {"yaw_deg", sensor.T_robot_sensor.yaw_rad() * kDegPerRad}}},
          {"mount_changes", sensor.mount_changes}};
}

}  // namespace

nlohmann::ordered_json log_json(const submap::LogSummary& summary) {
  nlohmann::ordered_json json = {{"observations", summary.report.observations},
                                 {"odometry_records", summary.report.odometry_records},
                                 {"space", summary.space == submap::Space::se2 ? "2D" : "3D"},
                                 {"first_stamp_s", summary.first_stamp_s},
                                 {"last_stamp_s", summary.last_stamp_s},
                                 {"period_s", summary.period_s},
                                 {"largest_gap_s", summary.largest_gap_s},
                                 {"gaps", summary.gaps},
                                 {"path_m", summary.path_m},
                                 {"odometry_jumps", summary.odometry_jumps},
                                 {"largest_jump_m", summary.largest_jump_m}};
  json["sensors"] = nlohmann::ordered_json::array();
  for (const auto& sensor : summary.sensors) json["sensors"].push_back(sensor_json(sensor));
  json["landmark_sensors"] = nlohmann::ordered_json::array();
  for (const auto& sensor : summary.landmark_sensors)
    json["landmark_sensors"].push_back({{"sensor", sensor.sensor},
                                        {"readings", sensor.readings},
                                        {"sightings", sensor.sightings},
                                        {"unnamed", sensor.unnamed},
                                        {"landmarks", sensor.landmarks},
                                        {"max_range_m", sensor.max_range_m}});
  return json;
}

std::string log_text(const submap::LogSummary& summary) {
  std::string text = fmt::format(
      "  observations  {} ({})\n"
      "  time          {:.6f} to {:.6f} s: {:.1f} s, one each {:.3g} s\n"
      "  path          {:.1f} m by odometry\n",
      summary.report.observations, summary.space == submap::Space::se2 ? "2D" : "3D",
      summary.first_stamp_s, summary.last_stamp_s, summary.last_stamp_s - summary.first_stamp_s,
      summary.period_s, summary.path_m);
  for (const auto& sensor : summary.sensors)
    text += fmt::format(
        "  sensor {}      {} readings of {:.1f} beams, step {:.4g} deg, up to {:.4g} m, {:.2f} % "
        "misses, at x {:.3f} y {:.3f} m, {:.2f} deg on the robot\n",
        sensor.sensor, sensor.readings, beams_per_reading(sensor),
        sensor.beam_step_rad * kDegPerRad, sensor.max_range_m, 100 * miss_share(sensor),
        sensor.T_robot_sensor.translation.x(), sensor.T_robot_sensor.translation.y(),
        sensor.T_robot_sensor.yaw_rad() * kDegPerRad);
  for (const auto& sensor : summary.landmark_sensors)
    text += fmt::format(
        "  landmarks {}   {} sightings in {} readings, {} of them unnamed; {} names; up to {:.4g} "
        "m\n",
        sensor.sensor, sensor.sightings, sensor.readings, sensor.unnamed, sensor.landmarks,
        sensor.max_range_m);
  return text;
}

nlohmann::ordered_json topics_json(const std::vector<submap::TopicSummary>& topics) {
  auto json = nlohmann::ordered_json::array();
  for (const auto& topic : topics)
    json.push_back({{"name", topic.name},
                    {"type", topic.type},
                    {"messages", topic.messages},
                    {"rate_hz", topic.rate_hz},
                    {"first_s", topic.first_s},
                    {"last_s", topic.last_s},
                    {"frames", topic.frames}});
  return json;
}

std::string topics_text(const std::vector<submap::TopicSummary>& topics) {
  std::string text;
  for (const auto& topic : topics) {
    text += fmt::format("  {}  {}: {} messages", topic.name, topic.type, topic.messages);
    if (topic.messages > 0)
      text += fmt::format(", {:.6f} to {:.6f} s, {:.4g} Hz", topic.first_s, topic.last_s,
                          topic.rate_hz);
    if (!topic.frames.empty()) text += fmt::format(", frames {}", fmt::join(topic.frames, ", "));
    text += "\n";
  }
  return text;
}

}  // namespace hmt::apps
