// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "hmt/graph/pose.hpp"
#include "log/ros/wire.hpp"

namespace hmt::test {

/// Serializes messages for tests, in each of the two wire formats and byte orders.
class WireWriter {
 public:
  explicit WireWriter(submap::Wire wire, bool little_endian = true)
      : wire_(wire), little_endian_(little_endian) {
    if (is_cdr()) bytes_ = {'\0', little_endian ? '\1' : '\0', '\0', '\0'};
  }

  template <typename Number>
  WireWriter& number(Number value) {
    if (is_cdr())
      while ((bytes_.size() - 4) % sizeof(Number) != 0) bytes_.push_back('\0');
    char raw[sizeof(Number)];
    std::memcpy(raw, &value, sizeof raw);
    if (little_endian_ != (std::endian::native == std::endian::little))
      std::reverse(raw, raw + sizeof raw);
    bytes_.append(raw, sizeof raw);
    return *this;
  }
  WireWriter& text(std::string_view value) {
    number(static_cast<uint32_t>(value.size() + (is_cdr() ? 1 : 0)));
    bytes_.append(value);
    if (is_cdr()) bytes_.push_back('\0');
    return *this;
  }
  WireWriter& raw(std::string_view value) {
    bytes_.append(value);
    return *this;
  }
  WireWriter& header(int64_t stamp_ns, std::string_view frame) {
    if (!is_cdr()) number(uint32_t{7});
    number(static_cast<int32_t>(stamp_ns / 1'000'000'000));
    number(static_cast<uint32_t>(stamp_ns % 1'000'000'000));
    return text(frame);
  }
  WireWriter& pose(const graph::Pose& T) {
    for (const double v : T.translation) number(v);
    for (const double v : T.rotation.coeffs()) number(v);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }
  bool is_cdr() const { return wire_ == submap::Wire::cdr; }

 private:
  submap::Wire wire_;
  bool little_endian_;
  std::string bytes_;
};

struct SampleScan {
  int64_t stamp_ns = 0;
  std::string frame = "laser";
  float angle_min = 0;
  float angle_increment = 0;
  float range_min = 0;
  float range_max = 0;
  std::vector<double> ranges;
  float time_increment = 0;
};

inline std::string laser_scan(WireWriter out, const SampleScan& scan, bool multi_echo = false) {
  out.header(scan.stamp_ns, scan.frame);
  const float last = scan.angle_min + scan.angle_increment * static_cast<float>(scan.ranges.size());
  for (const float v : {scan.angle_min, last, scan.angle_increment, scan.time_increment, 0.1F,
                        scan.range_min, scan.range_max})
    out.number(v);
  out.number(static_cast<uint32_t>(scan.ranges.size()));
  for (const double range : scan.ranges) {
    if (multi_echo) out.number(uint32_t{2});
    out.number(static_cast<float>(range));
    if (multi_echo) out.number(static_cast<float>(range + 1));
  }
  return out.number(uint32_t{0}).bytes();  // intensities
}

inline std::string odometry(WireWriter out, int64_t stamp_ns, const graph::Pose& T_odom_robot,
                            std::string_view child_frame = "base_link") {
  out.header(stamp_ns, "odom").text(child_frame).pose(T_odom_robot);
  for (int k = 0; k < 36 + 6 + 36; ++k) out.number(0.0);
  return out.bytes();
}

/// Of which only the gyroscope says anything.
inline std::string imu(WireWriter out, int64_t stamp_ns, std::string_view frame,
                       const Eigen::Vector3d& turn_rate) {
  out.header(stamp_ns, frame);
  for (int k = 0; k < 4 + 9; ++k) out.number(0.0);
  for (const double rate : turn_rate) out.number(rate);
  for (int k = 0; k < 9 + 3 + 9; ++k) out.number(0.0);
  return out.bytes();
}

struct SampleTransform {
  int64_t stamp_ns = 0;
  std::string parent;
  std::string child;
  graph::Pose T_parent_child;
};

inline std::string transforms(WireWriter out, const std::vector<SampleTransform>& all) {
  out.number(static_cast<uint32_t>(all.size()));
  for (const SampleTransform& t : all)
    out.header(t.stamp_ns, t.parent).text(t.child).pose(t.T_parent_child);
  return out.bytes();
}

/// A cloud of one row whose points are an intensity, x, y and z.
inline std::string cloud(WireWriter out, int64_t stamp_ns, std::string_view frame,
                         const std::vector<Eigen::Vector3f>& points, bool big_endian = false) {
  const auto width = static_cast<uint32_t>(points.size());
  out.header(stamp_ns, frame).number(uint32_t{1}).number(width).number(uint32_t{4});
  const char* names[] = {"intensity", "x", "y", "z"};
  for (uint32_t k = 0; k < 4; ++k)
    out.text(names[k]).number(4 * k).number(uint8_t{7}).number(uint32_t{1});
  out.number(uint8_t{big_endian}).number(uint32_t{16}).number(16 * width).number(16 * width);
  for (const Eigen::Vector3f& p : points) {
    WireWriter data(submap::Wire::ros1, !big_endian);
    out.raw(data.number(0.5F).number(p.x()).number(p.y()).number(p.z()).bytes());
  }
  return out.number(uint8_t{1}).bytes();
}

/// A field of the time of points: how it is called, its datatype in PointField and its values.
struct SampleTimes {
  std::string name;
  uint8_t datatype = 7;  ///< 6 uint32, 7 float32, 8 float64
  std::vector<double> values;
};

/// A cloud of one row whose points are x, y, z and a time.
inline std::string timed_cloud(WireWriter out, int64_t stamp_ns, std::string_view frame,
                               const std::vector<Eigen::Vector3f>& points,
                               const SampleTimes& times) {
  const auto width = static_cast<uint32_t>(points.size());
  const uint32_t step = times.datatype == 8 ? 20 : 16;
  out.header(stamp_ns, frame).number(uint32_t{1}).number(width).number(uint32_t{4});
  const std::string names[] = {"x", "y", "z", times.name};
  for (uint32_t k = 0; k < 4; ++k)
    out.text(names[k])
        .number(4 * k)
        .number(k < 3 ? uint8_t{7} : times.datatype)
        .number(uint32_t{1});
  out.number(uint8_t{0}).number(step).number(step * width).number(step * width);
  for (size_t i = 0; i < points.size(); ++i) {
    WireWriter data(submap::Wire::ros1);
    for (const float v : points[i]) data.number(v);
    const double time = times.values[i];
    if (times.datatype == 8) data.number(time);
    if (times.datatype == 7) data.number(static_cast<float>(time));
    if (times.datatype == 6) data.number(static_cast<uint32_t>(time));
    out.raw(data.bytes());
  }
  return out.number(uint8_t{1}).bytes();
}

}  // namespace hmt::test
