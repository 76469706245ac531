// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "recording_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../cloud/complete_cloud.hpp"
#include "../file_bytes.hpp"
#include "../range_scan.hpp"
#include "../report_book.hpp"

namespace hmt::submap {
namespace {

constexpr size_t kScansAhead = 200;
/// Clouds are large, and nothing is learnt from them ahead.
constexpr size_t kCloudsAhead = 2;
/// Scans of two sensors so close in time are one observation.
constexpr double kSameObservation = 0.2;  // seconds
/// Odometry is recorded later than the scan by less.
constexpr uint64_t kMaxWait_ns = 2'000'000'000;
constexpr size_t kMaxWaiting = 400;
constexpr size_t kMaxCloudsWaiting = 40;
/// Landmarks are found in an image and recorded within this time.
constexpr uint64_t kLandmarkDelay_ns = 1'000'000'000;
/// Where a scan does not tell its greatest range; no planar laser reaches further than the second.
constexpr double kDefaultMaxRange = 80;     // metres
constexpr double kGreatestMaxRange = 1000;  // metres
/// The plane of a laser may be tilted by so much before it is no plan of the walls.
const double kMostTilted = std::cos(10 * std::numbers::pi / 180);
constexpr int64_t kNanosecondsPerSecond = 1'000'000'000;

double seconds(int64_t stamp_ns) {
  const int64_t whole = stamp_ns / kNanosecondsPerSecond;
  return static_cast<double>(whole) +
         static_cast<double>(stamp_ns - whole * kNanosecondsPerSecond) * 1e-9;
}

/// The times of the beams of a scan, or of the points of a cloud.
std::vector<float> times_of(const LaserScanMessage& laser) {
  std::vector<float> times_s;
  if (laser.time_increment_s == 0) return times_s;
  for (size_t i = 0; i < laser.ranges_m.size(); ++i)
    times_s.push_back(static_cast<float>(static_cast<double>(i) * laser.time_increment_s));
  return times_s;
}
std::vector<float> times_of(const CloudMessage& message) {
  const CloudPoints& cloud = message.cloud;
  return beam_times(cloud.times, cloud.times_in_nanoseconds, message.header.stamp_ns);
}

/// Where the point would have been seen from the sensor's pose at the stamp.
Eigen::Vector3f deskewed(const Eigen::Vector3f& p_then, const Sweep& sweep, float time_s) {
  return (sweep.T_stamp_then(time_s) * p_then.cast<double>()).cast<float>();
}

Pose in_plane(const Pose& T) {
  return Pose::planar(T.translation.x(), T.translation.y(), T.yaw_rad());
}

}  // namespace

RecordingReader::RecordingReader(const std::filesystem::path& path, const LogOptions& options)
    : path_(path),
      plan_(plan_recording(path, options)),
      recording_(open_recording(path, options.further_parts)),
      bytes_total_(file_bytes(path)) {
  for (const std::filesystem::path& part : options.further_parts) bytes_total_ += file_bytes(part);
  if (plan_.uses_time_of_receipt)
    note("scans and odometry have different clocks: their times of receipt are taken",
         path.string());
  const size_t wanted = plan_.space == Space::se2 ? kScansAhead : kCloudsAhead;
  while (ahead_.size() < wanted && !(has_landmarks_only() && !sights_.empty()) && read_message()) {
  }
  if (!ahead_.empty() || !sights_.empty()) return;
  throw InputError(path.string() + ": no usable " + (has_landmarks_only() ? "landmark" : "scan") +
                   first_loss(report_));
}

std::optional<Observation> RecordingReader::next() {
  return has_landmarks_only() ? next_landmarks() : next_scans();
}

/// Whether what belongs to something received then has come, too.
bool RecordingReader::has_read_past(int64_t received_ns) const {
  return stamp_distance(last_received_ns_, received_ns) > kLandmarkDelay_ns;
}

std::optional<Observation> RecordingReader::next_landmarks() {
  while (true) {
    while ((sights_.empty() || !has_read_past(sights_.front().received_ns)) &&
           sights_.size() < kMaxWaiting && read_message()) {
    }
    if (sights_.empty()) return std::nullopt;
    const LandmarkSight sight = sights_.pop();
    const auto T_odom_robot = odometry_.at(sight.stamp_ns);
    if (!T_odom_robot) {
      lose("landmarks without odometry at their time", sight.place);
      continue;
    }
    note_stamp(sight.own_stamp_s, sight.place);
    Observation observation;
    observation.index = report_.observations++;
    observation.stamp_s = sight.own_stamp_s;
    observation.T_odom_robot = *T_odom_robot;
    observation.landmark_readings.push_back(as_reading(sight, Pose{}, plan_.space));
    return observation;
  }
}

std::optional<Observation> RecordingReader::next_scans() {
  // Cameras tell later than scanners what they saw.
  const size_t most = plan_.space == Space::se2 ? kMaxWaiting : kMaxCloudsWaiting;
  const auto is_complete = [&] {
    return ahead_.size() >= 2 && (landmark_sensors_.empty() || ahead_.size() >= most ||
                                  has_read_past(ahead_.front().received_ns));
  };
  while (!is_complete() && read_message()) {
  }
  if (ahead_.empty()) return std::nullopt;
  const Scan scan = std::move(ahead_.front());
  ahead_.pop_front();
  note_stamp(scan.own_stamp_s, scan.place);

  Observation observation;
  observation.index = report_.observations++;
  observation.stamp_s = scan.own_stamp_s;
  observation.T_odom_robot = scan.T_odom_robot;
  observation.readings.push_back(reading(scan, observation.T_odom_robot));
  const auto belongs = [&](const Scan& other) {
    return other.sensor != scan.sensor &&
           std::abs(other.own_stamp_s - scan.own_stamp_s) <= kSameObservation;
  };
  while (!ahead_.empty() && belongs(ahead_.front()) &&
         observation.readings.size() < plan_.scan_topics.size()) {
    observation.readings.push_back(reading(ahead_.front(), observation.T_odom_robot));
    ahead_.pop_front();
  }
  join_landmarks(scan, observation);
  return observation;
}

void RecordingReader::join_landmarks(const Scan& scan, Observation& observation) {
  if (sights_.empty()) return;
  const std::string where = sights_.front().place;
  std::optional<int64_t> next_stamp_ns;
  if (!ahead_.empty()) next_stamp_ns = ahead_.front().stamp_ns;
  LandmarkSights::Taken taken =
      sights_.take(observation.T_odom_robot, scan.stamp_ns, next_stamp_ns, odometry_, plan_.space);
  observation.landmark_readings = std::move(taken.readings);
  lose("landmarks more than a second from any scan", where, taken.too_far);
  lose("landmarks without odometry at their time", where, taken.without_odometry);
}

bool RecordingReader::read_message() {
  const auto message = recording_->next();
  // Its counts only grow, and are no reader's own.
  for (const auto& [what, times] : recording_->report().notes) report_.notes[what] = times;
  for (const auto& [what, times] : recording_->report().losses) report_.losses[what] = times;
  report_.first_places.insert(recording_->report().first_places.begin(),
                              recording_->report().first_places.end());
  at_end_ = !message;
  if (message) {
    ++messages_;
    last_received_ns_ = message->received_ns;
    use_message(*message);
  }
  return place_scans() || !at_end_;
}

void RecordingReader::use_message(const RecordedMessage& message) {
  const RecordedTopic& topic = recording_->topics()[message.topic];
  const MessageKind kind = topic.kind();
  try {
    if (is_range_data(kind)) {
      const auto sensor = std::ranges::find(plan_.scan_topics, topic.name);
      if (sensor != plan_.scan_topics.end())
        add_scan(message, static_cast<size_t>(sensor - plan_.scan_topics.begin()), topic);
    } else if (kind == MessageKind::odometry && topic.name == plan_.odometry_topic) {
      const OdometryMessage odometry = read_odometry({message.data, *topic.wire});
      add_odometry(odometry.header, message.received_ns, odometry.T_odom_robot);
    } else if (takes_landmarks(topic.name, kind, plan_.landmark_topics)) {
      add_landmarks(message, topic);
    } else if (kind == MessageKind::transforms) {
      add_transforms(message, topic);
    } else if (kind == MessageKind::imu && topic.name == plan_.imu_topic) {
      add_imu(message, topic);
    }
  } catch (const MessageError& error) {
    lose("damaged messages on " + topic.name + ": " + error.what(), place(topic));
  }
}

void RecordingReader::add_scan(const RecordedMessage& message, size_t sensor,
                               const RecordedTopic& topic) {
  Scan scan;
  scan.sensor = sensor;
  scan.received_ns = message.received_ns;
  scan.place = place(topic);
  const WireReader in(message.data, *topic.wire);
  scan.is_laser = topic.kind() != MessageKind::cloud;
  if (scan.is_laser)
    scan.laser = read_laser_scan(in, topic.kind());
  else
    scan.cloud = read_cloud(in);
  scan.beam_times_s = scan.is_laser ? times_of(scan.laser) : times_of(scan.cloud);
  if (!scan.beam_times_s.empty()) {
    const auto [first_s, last_s] = std::ranges::minmax(scan.beam_times_s);
    scan.first_beam_s = first_s;
    scan.last_beam_s = last_s;
  }
  const MessageHeader& header = scan.is_laser ? scan.laser.header : scan.cloud.header;
  scan.stamp_ns = clock_ns(header, message.received_ns);
  scan.own_stamp_s = seconds(header.stamp_ns != 0 ? header.stamp_ns : message.received_ns);
  if (header.stamp_ns == 0) note("stamps of 0: the time of receipt is taken", scan.place);
  if (!mount(header, scan)) return;
  // An odometry that stands still is none to the tracker.
  if (!plan_.has_odometry)
    for (const double after_s : {scan.first_beam_s, 0.0, scan.last_beam_s})
      odometry_.add(stamp_after(scan.stamp_ns, after_s), Pose{});
  waiting_.push_back(std::move(scan));
}

int64_t RecordingReader::clock_ns(const MessageHeader& header, int64_t received_ns) {
  return plan_.uses_time_of_receipt || header.stamp_ns == 0 ? received_ns : header.stamp_ns;
}

bool RecordingReader::mount(const MessageHeader& header, Scan& scan) {
  const auto T = plan_.transforms.find(plan_.robot_frame, header.frame, header.stamp_ns);
  if (!T)
    note("no transform from frame " + plan_.robot_frame + " to " + header.frame +
             ": the sensor is taken to stand in the robot's middle",
         scan.place);
  scan.T_robot_sensor = T.value_or(Pose{});
  return plan_.space == Space::se3 || mount_in_plane(scan);
}

bool RecordingReader::mount_in_plane(Scan& scan) {
  const double upwards = scan.T_robot_sensor.rotation_matrix()(2, 2);
  if (std::abs(upwards) < kMostTilted) {
    lose("scans of a tilted laser: no planar map can be made of them", scan.place);
    return false;
  }
  scan.is_upside_down = upwards < 0;
  scan.T_robot_sensor = in_plane(scan.T_robot_sensor);
  return true;
}

void RecordingReader::add_landmarks(const RecordedMessage& message, const RecordedTopic& topic) {
  MarkersMessage seen = read_markers({message.data, *topic.wire}, topic.kind());
  lose("landmarks whose position or covariance is none on " + topic.name, place(topic),
       seen.refused);
  note("landmarks left out: without a name that is one number", place(topic), seen.unnamed);
  // How a camera looks no one can guess: its frame and that of its mount differ by a quarter turn.
  const auto T_robot_sensor =
      plan_.transforms.find(plan_.robot_frame, seen.header.frame, seen.header.stamp_ns);
  if (!T_robot_sensor) {
    lose("landmarks left out: no transform from frame " + plan_.robot_frame + " to " +
             seen.header.frame,
         place(topic));
    return;
  }
  const auto sensors = static_cast<int>(plan_.scan_topics.size() + landmark_sensors_.size());
  LandmarkSight sight;
  sight.sensor = landmark_sensors_.try_emplace(topic.name, sensors).first->second;
  sight.stamp_ns = clock_ns(seen.header, message.received_ns);
  sight.received_ns = message.received_ns;
  sight.own_stamp_s =
      seconds(seen.header.stamp_ns != 0 ? seen.header.stamp_ns : message.received_ns);
  sight.place = place(topic);
  sight.T_robot_sensor = *T_robot_sensor;
  sight.markers = std::move(seen.markers);
  if (!sights_.add(std::move(sight)))
    lose("landmarks more than a second from any scan", place(topic));
}

void RecordingReader::add_odometry(const MessageHeader& header, int64_t received_ns,
                                   const Pose& T_odom_robot) {
  ++report_.odometry_records;
  odometry_.add(clock_ns(header, received_ns),
                plan_.space == Space::se2 ? in_plane(T_odom_robot) : T_odom_robot);
}

void RecordingReader::add_imu(const RecordedMessage& message, const RecordedTopic& topic) {
  const auto imu = read_imu({message.data, *topic.wire});
  if (!imu) return;
  const auto T_robot_imu =
      plan_.transforms.find(plan_.robot_frame, imu->header.frame, imu->header.stamp_ns);
  if (!T_robot_imu) {
    note("gyroscope not used: no transform from frame " + plan_.robot_frame + " to " +
             imu->header.frame,
         place(topic));
    return;
  }
  Eigen::Vector3d rate_robot = T_robot_imu->rotation * imu->turn_rate;
  if (plan_.space == Space::se2) rate_robot.head<2>().setZero();
  turn_rates_.add(clock_ns(imu->header, message.received_ns), rate_robot);
}

void RecordingReader::add_transforms(const RecordedMessage& message, const RecordedTopic& topic) {
  const TransformMessages all = read_transforms({message.data, *topic.wire});
  lose("transforms that are no poses on " + topic.name, place(topic), all.refused);
  for (const TransformMessage& transform : all.transforms) {
    plan_.transforms.add(transform, is_static_topic(topic.name));
    if (plan_.has_odometry && plan_.odometry_topic.empty() &&
        transform.child_frame == plan_.robot_frame && transform.header.frame == plan_.odom_frame)
      add_odometry(transform.header, message.received_ns, transform.T_parent_child);
  }
}

/// Gives the scans at the front their poses. True if one was placed.
bool RecordingReader::place_scans() {
  const size_t before = ahead_.size();
  while (!waiting_.empty()) {
    Scan& scan = waiting_.front();
    if (!has_odometry(scan) && !waits_too_long(scan)) break;
    const auto T_odom_robot = odometry_.at(scan.stamp_ns);
    if (T_odom_robot) {
      scan.T_odom_robot = *T_odom_robot;
      find_sweep(scan);
      if (scan.is_laser)
        limits_[scan.sensor].add(scan.laser.ranges_m,
                                 (scan.T_odom_robot * scan.T_robot_sensor).translation.head<2>());
      ahead_.push_back(std::move(scan));
    } else {
      lose("scans without odometry at their time", scan.place);
    }
    waiting_.pop_front();
  }
  return ahead_.size() > before;
}

/// Whether the odometry around the stamp and all beams has been read.
bool RecordingReader::has_odometry(const Scan& scan) const {
  if (!odometry_.between(scan.stamp_ns)) return false;
  return odometry_.between(stamp_after(scan.stamp_ns, scan.last_beam_s)).has_value();
}

void RecordingReader::find_sweep(Scan& scan) {
  if (scan.beam_times_s.empty()) return;
  scan.sweep = Sweep::along(odometry_, turn_rates_, scan.stamp_ns, scan.first_beam_s,
                            scan.last_beam_s, scan.T_robot_sensor);
  if (!scan.sweep)
    note("scans left as they are, without odometry at the times of all beams", scan.place);
}

bool RecordingReader::waits_too_long(const Scan& scan) const {
  return at_end_ || waiting_.size() > kMaxWaiting ||
         stamp_distance(last_received_ns_, scan.received_ns) > kMaxWait_ns;
}

Reading RecordingReader::reading(const Scan& scan, const Pose& T_odom_robot) {
  Reading reading;
  reading.sensor = static_cast<int>(scan.sensor);
  reading.T_robot_sensor = scan.T_robot_sensor;
  // Seen a little later than the first of the observation.
  if (!(scan.T_odom_robot == T_odom_robot))
    reading.T_robot_sensor = relative_pose(T_odom_robot, scan.T_odom_robot) * scan.T_robot_sensor;
  return scan.is_laser ? laser_reading(scan, std::move(reading))
                       : cloud_reading(scan, std::move(reading));
}

Reading RecordingReader::laser_reading(const Scan& scan, Reading reading) {
  const LaserScanMessage& laser = scan.laser;
  const bool tells_range = laser.range_max_m > 0 && laser.range_max_m <= kGreatestMaxRange;
  reading.max_range_m = tells_range ? laser.range_max_m : kDefaultMaxRange;
  if (const auto limit_m = limits_.at(scan.sensor).limit_m())
    reading.max_range_m = std::min(reading.max_range_m, *limit_m);
  std::vector<double> ranges_m = laser.ranges_m;
  int64_t too_near = 0;
  for (double& range_m : ranges_m) {
    if (!(range_m > 0 && range_m < laser.range_min_m)) continue;
    range_m = 0;
    ++too_near;
  }
  if (ranges_m.empty()) note("scans without beams", scan.place);
  // Seen from above, the beams of a laser that hangs upside down turn the other way.
  const double turn = scan.is_upside_down ? -1 : 1;
  const UsedRanges used =
      add_ranges(ranges_m, turn * laser.angle_min_rad, turn * laser.angle_increment_rad, reading);
  note("ranges left out: not a number", scan.place, used.not_a_number);
  note("ranges left out: below range_min", scan.place, too_near);
  note("ranges left out: zero or negative", scan.place, used.not_positive - too_near);
  if (scan.sweep)
    for (size_t k = 0; k < reading.points_sensor.size(); ++k)
      reading.points_sensor[k] = deskewed(reading.points_sensor[k], *scan.sweep,
                                          scan.beam_times_s[used.beams_of_points[k]]);
  return reading;
}

Reading RecordingReader::cloud_reading(const Scan& scan, Reading reading) {
  const CloudPoints& cloud = scan.cloud.cloud;
  reading.points_sensor = cloud.points;
  if (scan.sweep)
    for (size_t k = 0; k < reading.points_sensor.size(); ++k)
      reading.points_sensor[k] =
          deskewed(reading.points_sensor[k], *scan.sweep, scan.beam_times_s[k]);
  complete_cloud(reading);
  note_cloud(report_, cloud, scan.place);
  return reading;
}

void RecordingReader::note_stamp(double stamp_s, const std::string& place) {
  if (last_stamp_s_ && stamp_s < *last_stamp_s_) {
    note("stamps run backwards", place);
  } else if (last_stamp_s_ && stamp_s == *last_stamp_s_) {
    note("stamps repeated", place);
  }
  last_stamp_s_ = stamp_s;
}

void RecordingReader::note(const std::string& what, const std::string& place, int64_t times) {
  add_note(report_, what, place, times);
}

void RecordingReader::lose(const std::string& what, const std::string& place, int64_t times) {
  add_loss(report_, what, place, times);
}

std::string RecordingReader::place(const RecordedTopic& topic) const {
  return path_.string() + ": message " + std::to_string(messages_) + ", " + topic.name;
}

}  // namespace hmt::submap
