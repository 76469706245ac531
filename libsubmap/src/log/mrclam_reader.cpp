// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mrclam_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "text_fields.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

/// The data set numbers its robots 1 to 5; all other subjects are landmarks.
constexpr int64_t kLastRobot = 5;
/// Motion after which there is an observation even without a measurement: an arc this short is as
/// good as straight.
constexpr double kStep_m = 0.25;
constexpr double kStep_rad = 0.25;
/// Commands come many times a second. Beyond this the last one does not tell the motion any more.
constexpr double kLongestHold = 2;  // seconds

const char* const kEndings[] = {"", ".gz", ".bz2", ".zst"};

/// The file of that name, plain or compressed; throws where there is none.
fs::path find_file(const fs::path& folder, const std::string& name) {
  for (const char* ending : kEndings)
    if (fs::exists(folder / (name + ending))) return folder / (name + ending);
  throw InputError((folder / name).string() + ": no such file, plain or compressed");
}

fs::path robot_file(const fs::path& folder, int robot, const char* what) {
  return find_file(folder, "Robot" + std::to_string(robot) + "_" + what + ".dat");
}

int64_t bytes_of(const fs::path& path) {
  return static_cast<int64_t>(fs::file_size(path));
}

/// Motion at constant velocities.
Pose arc(double forward_m_s, double turn_rad_s, double duration_s) {
  const double yaw_rad = turn_rad_s * duration_s;
  const double length_m = forward_m_s * duration_s;
  // Chord of the arc: sin(yaw / 2) / (yaw / 2) of its length, along half the turn.
  const double half_rad = yaw_rad / 2;
  const double chord_m =
      std::abs(half_rad) > 1e-9 ? length_m * std::sin(half_rad) / half_rad : length_m;
  return Pose::planar(chord_m * std::cos(half_rad), chord_m * std::sin(half_rad),
                      graph::wrap_angle(yaw_rad));
}

}  // namespace

std::vector<int> mrclam_robots(const fs::path& folder) {
  std::vector<int> robots;
  for (int robot = 1; robot <= kLastRobot; ++robot)
    for (const char* ending : kEndings)
      if (fs::exists(folder / ("Robot" + std::to_string(robot) + "_Measurement.dat" + ending))) {
        robots.push_back(robot);
        break;
      }
  return robots;
}

MrclamReader::MrclamReader(const fs::path& folder, int robot)
    : velocities_(robot_file(folder, robot, "Odometry"), report_),
      sightings_(robot_file(folder, robot, "Measurement"), report_),
      bytes_total_(bytes_of(velocities_.source().path()) + bytes_of(sightings_.source().path())) {
  read_barcodes(find_file(folder, "Barcodes.dat"));
  read_velocity();
  read_sighting();
  if (!next_sighting_)
    throw InputError(sightings_.source().path().string() + ": no usable measurement of a landmark");
  velocity_.stamp_s = next_velocity_ ? std::min(next_velocity_->stamp_s, next_sighting_->stamp_s)
                                     : next_sighting_->stamp_s;
  holds_until_s_ = std::numeric_limits<double>::infinity();  // at rest before the first command
}

int64_t MrclamReader::bytes_read() const {
  return velocities_.source().bytes_read() + sightings_.source().bytes_read();
}

void MrclamReader::read_barcodes(const fs::path& path) {
  RecordLines lines(path, report_);
  const auto parse = [this](std::string_view fields) {
    const int64_t subject = take_count(fields, "subject");
    const int64_t barcode = take_count(fields, "barcode");
    if (!subject_of_barcode_.try_emplace(barcode, subject).second)
      throw std::invalid_argument("barcode of two subjects");
  };
  while (lines.read("Barcodes", parse)) {
  }
  if (subject_of_barcode_.empty()) throw InputError(path.string() + ": no usable barcode");
}

void MrclamReader::parse_velocity(std::string_view fields) {
  Velocity velocity;
  velocity.stamp_s = take_finite(fields, "stamp");
  velocity.forward_m_s = take_finite(fields, "forward velocity");
  velocity.turn_rad_s = take_finite(fields, "angular velocity");
  if (next_velocity_ && velocity.stamp_s < next_velocity_->stamp_s)
    throw std::invalid_argument("stamps run backwards");
  ++report_.odometry_records;
  next_velocity_ = velocity;
}

void MrclamReader::read_velocity() {
  if (!velocities_.read("Odometry", [this](std::string_view record) { parse_velocity(record); }))
    next_velocity_.reset();
}

/// False for a robot.
bool MrclamReader::parse_sighting(std::string_view fields) {
  Sighting sighting;
  sighting.stamp_s = take_finite(fields, "stamp");
  const int64_t barcode = take_count(fields, "barcode");
  const double range_m = take_finite(fields, "range");
  const double bearing_rad = take_finite(fields, "bearing");
  if (!(range_m > 0)) throw std::invalid_argument("range is not above zero");
  if (std::abs(bearing_rad) > 2 * std::numbers::pi)
    throw std::invalid_argument("bearing is not an angle");
  if (next_sighting_ && sighting.stamp_s < next_sighting_->stamp_s)
    throw std::invalid_argument("stamps run backwards");
  const auto found = subject_of_barcode_.find(barcode);
  if (found == subject_of_barcode_.end()) throw std::invalid_argument("unknown barcode");
  if (found->second <= kLastRobot) {
    note(report_, "measurements of other robots left out", sightings_.source().place());
    return false;
  }
  sighting.landmark.id = found->second;
  sighting.landmark.position_sensor = {range_m * std::cos(bearing_rad),
                                       range_m * std::sin(bearing_rad), 0};
  next_sighting_ = sighting;
  return true;
}

void MrclamReader::read_sighting() {
  bool is_landmark = false;
  while (!is_landmark)
    if (!sightings_.read("Measurement",
                         [&](std::string_view record) { is_landmark = parse_sighting(record); })) {
      next_sighting_.reset();
      return;
    }
}

void MrclamReader::drive_to(double stamp_s) {
  const double until_s = std::min(stamp_s, holds_until_s_);
  if (stamp_s > holds_until_s_ && velocity_.stamp_s <= holds_until_s_)
    note(report_, "pauses in the odometry, in which the robot is taken to stand",
         velocities_.source().place());
  if (until_s > velocity_.stamp_s)
    T_odom_robot_ = T_odom_robot_ *
                    arc(velocity_.forward_m_s, velocity_.turn_rad_s, until_s - velocity_.stamp_s);
  velocity_.stamp_s = stamp_s;
}

bool MrclamReader::has_moved() const {
  const Pose moved = graph::relative_pose(T_odom_latest_, T_odom_robot_);
  return moved.translation.norm() >= kStep_m || std::abs(moved.yaw_rad()) >= kStep_rad;
}

std::optional<Observation> MrclamReader::next() {
  while (next_velocity_ &&
         (!next_sighting_ || next_velocity_->stamp_s <= next_sighting_->stamp_s)) {
    drive_to(next_velocity_->stamp_s);
    velocity_ = *next_velocity_;
    holds_until_s_ = velocity_.stamp_s + kLongestHold;
    read_velocity();
    if (has_moved()) return take(velocity_.stamp_s);
  }
  if (!next_sighting_) return std::nullopt;
  const double stamp_s = next_sighting_->stamp_s;
  drive_to(stamp_s);
  Observation observation = take(stamp_s);
  LandmarkReading& reading = observation.landmark_readings.emplace_back();
  while (next_sighting_ && next_sighting_->stamp_s == stamp_s) {
    reading.landmarks.push_back(next_sighting_->landmark);
    read_sighting();
  }
  return observation;
}

Observation MrclamReader::take(double stamp_s) {
  Observation observation;
  observation.index = report_.observations++;
  observation.stamp_s = stamp_s;
  observation.T_odom_robot = T_odom_latest_ = T_odom_robot_;
  return observation;
}

}  // namespace hmt::submap
