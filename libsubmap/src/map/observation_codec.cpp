// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "observation_codec.hpp"

#include <zstd.h>

#include <bit>
#include <cstring>
#include <memory>
#include <new>

namespace hmt::submap {
namespace {

static_assert(std::endian::native == std::endian::little, "the map file is little endian");

// Fast; the points are close to random in their lowest bytes, so higher levels gain little.
constexpr int kZstdLevel = 3;
// 30 million points in one observation.
constexpr size_t kMaxReadingBytes = size_t{1} << 29;
constexpr size_t kPointBytes = 3 * sizeof(float);

template <class T>
void append(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Numbers of a vector or matrix, column by column.
template <class Derived>
void append(std::string& out, const Eigen::MatrixBase<Derived>& numbers) {
  for (Eigen::Index c = 0; c < numbers.cols(); ++c)
    for (Eigen::Index r = 0; r < numbers.rows(); ++r) append(out, double{numbers(r, c)});
}

void append(std::string& out, const Pose& pose) {
  for (int k = 0; k < 3; ++k) append(out, pose.translation[k]);
  for (int k = 0; k < 4; ++k) append(out, pose.rotation.coeffs()[k]);
}

/// Byte b of coordinate c of point i goes to place (c * 4 + b) * n + i.
void append(std::string& out, const std::vector<Eigen::Vector3f>& points) {
  const size_t start = out.size();
  const size_t n = points.size();
  out.resize(start + kPointBytes * n);
  char* const planes = out.data() + start;
  for (size_t i = 0; i < n; ++i) {
    char bytes[kPointBytes];
    std::memcpy(bytes, points[i].data(), kPointBytes);
    for (size_t k = 0; k < kPointBytes; ++k) planes[k * n + i] = bytes[k];
  }
}

void append(std::string& out, const Reading& reading) {
  append(out, static_cast<int32_t>(reading.sensor));
  append(out, reading.T_robot_sensor);
  append(out, reading.max_range_m);
  append(out, reading.beam_step_rad);
  append(out, static_cast<uint32_t>(reading.points_sensor.size()));
  append(out, static_cast<uint32_t>(reading.misses_sensor.size()));
  append(out, reading.points_sensor);
  append(out, reading.misses_sensor);
}

void append(std::string& out, const Landmark& landmark) {
  append(out, landmark.id);
  append(out, landmark.position_sensor);
  append(out, landmark.covariance_sensor);
  append(out, static_cast<uint32_t>(landmark.descriptor.size()));
  for (const float number : landmark.descriptor) append(out, number);
}

void append(std::string& out, const LandmarkReading& reading) {
  append(out, static_cast<int32_t>(reading.sensor));
  append(out, reading.T_robot_sensor);
  append(out, static_cast<uint32_t>(reading.landmarks.size()));
  for (const Landmark& landmark : reading.landmarks) append(out, landmark);
}

/// Takes values off the front of a block of bytes; every take fails where too few are left.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}
  bool at_end() const { return rest_.empty(); }

  template <class T>
  bool take(T& value) {
    if (rest_.size() < sizeof(value)) return false;
    std::memcpy(&value, rest_.data(), sizeof(value));
    rest_.remove_prefix(sizeof(value));
    return true;
  }

  bool take(Pose& pose) {
    for (int k = 0; k < 3; ++k)
      if (!take(pose.translation[k])) return false;
    for (int k = 0; k < 4; ++k)
      if (!take(pose.rotation.coeffs()[k])) return false;
    return true;
  }

  template <class Derived>
  bool take_numbers(Eigen::MatrixBase<Derived>& numbers) {
    for (Eigen::Index c = 0; c < numbers.cols(); ++c)
      for (Eigen::Index r = 0; r < numbers.rows(); ++r)
        if (!take(numbers(r, c))) return false;
    return true;
  }

  bool take(std::vector<Eigen::Vector3f>& points, size_t n) {
    if (rest_.size() / kPointBytes < n) return false;
    points.resize(n);
    for (size_t i = 0; i < n; ++i) {
      char bytes[kPointBytes];
      for (size_t k = 0; k < kPointBytes; ++k) bytes[k] = rest_[k * n + i];
      std::memcpy(points[i].data(), bytes, kPointBytes);
    }
    rest_.remove_prefix(kPointBytes * n);
    return true;
  }

  bool take(Reading& reading) {
    uint32_t points = 0;
    uint32_t misses = 0;
    int32_t sensor = 0;
    if (!take(sensor) || !take(reading.T_robot_sensor) || !take(reading.max_range_m) ||
        !take(reading.beam_step_rad) || !take(points) || !take(misses))
      return false;
    reading.sensor = sensor;
    return take(reading.points_sensor, points) && take(reading.misses_sensor, misses);
  }

  bool take(Landmark& landmark) {
    uint32_t size = 0;
    if (!take(landmark.id) || !take_numbers(landmark.position_sensor) ||
        !take_numbers(landmark.covariance_sensor) || !take(size) ||
        rest_.size() / sizeof(float) < size)
      return false;
    landmark.descriptor.resize(size);
    for (float& number : landmark.descriptor) take(number);
    return true;
  }

  bool take(LandmarkReading& reading) {
    int32_t sensor = 0;
    if (!take(sensor) || !take(reading.T_robot_sensor) || !take_all(reading.landmarks))
      return false;
    reading.sensor = sensor;
    return true;
  }

  /// A count, then so many values.
  template <class T>
  bool take_all(std::vector<T>& values) {
    uint32_t count = 0;
    if (!take(count)) return false;
    for (uint32_t k = 0; k < count; ++k)
      if (!take(values.emplace_back())) return false;
    return true;
  }

  bool take(std::optional<Matrix6d>& matrix) {
    uint8_t is_there = 0;
    if (!take(is_there)) return false;
    return is_there == 0 || take_numbers(matrix.emplace());
  }

 private:
  std::string_view rest_;
};

}  // namespace

std::string compress(std::string_view bytes) {
  std::string frame(ZSTD_compressBound(bytes.size()), '\0');
  const size_t size =
      ZSTD_compress(frame.data(), frame.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (ZSTD_isError(size)) throw std::bad_alloc();
  frame.resize(size);
  return frame;
}

std::optional<std::string> decompress(std::string_view frame, size_t max_bytes) {
  const auto size = ZSTD_getFrameContentSize(frame.data(), frame.size());
  // The two error values of zstd are the largest numbers there are.
  if (size > max_bytes) return std::nullopt;
  std::string bytes(static_cast<size_t>(size), '\0');
  const size_t got = ZSTD_decompress(bytes.data(), bytes.size(), frame.data(), frame.size());
  if (ZSTD_isError(got) || got != bytes.size()) return std::nullopt;
  return bytes;
}

std::string encode_sensed(const Observation& observation) {
  std::string bytes;
  append(bytes, static_cast<uint32_t>(observation.readings.size()));
  for (const Reading& reading : observation.readings) append(bytes, reading);
  append(bytes, static_cast<uint32_t>(observation.landmark_readings.size()));
  for (const LandmarkReading& reading : observation.landmark_readings) append(bytes, reading);
  append(bytes, static_cast<uint8_t>(observation.motion_covariance.has_value()));
  if (observation.motion_covariance) append(bytes, *observation.motion_covariance);
  return compress(bytes);
}

bool decode_sensed(std::string_view frame, Observation& observation) {
  const std::optional<std::string> bytes = decompress(frame, kMaxReadingBytes);
  if (!bytes) return false;
  Reader in(*bytes);
  return in.take_all(observation.readings) && in.take_all(observation.landmark_readings) &&
         in.take(observation.motion_covariance) && in.at_end();
}

}  // namespace hmt::submap
