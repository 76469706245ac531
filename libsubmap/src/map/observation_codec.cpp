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

std::string encode_readings(const std::vector<Reading>& readings) {
  std::string bytes;
  append(bytes, static_cast<uint32_t>(readings.size()));
  for (const Reading& reading : readings) {
    append(bytes, static_cast<int32_t>(reading.sensor));
    append(bytes, reading.T_robot_sensor);
    append(bytes, reading.max_range_m);
    append(bytes, reading.beam_step_rad);
    append(bytes, static_cast<uint32_t>(reading.points_sensor.size()));
    append(bytes, static_cast<uint32_t>(reading.misses_sensor.size()));
    append(bytes, reading.points_sensor);
    append(bytes, reading.misses_sensor);
  }
  return compress(bytes);
}

std::optional<std::vector<Reading>> decode_readings(std::string_view frame) {
  const std::optional<std::string> bytes = decompress(frame, kMaxReadingBytes);
  if (!bytes) return std::nullopt;
  Reader in(*bytes);
  uint32_t count = 0;
  if (!in.take(count)) return std::nullopt;
  std::vector<Reading> readings;
  for (uint32_t k = 0; k < count; ++k)
    if (!in.take(readings.emplace_back())) return std::nullopt;
  if (!in.at_end()) return std::nullopt;
  return readings;
}

}  // namespace hmt::submap
