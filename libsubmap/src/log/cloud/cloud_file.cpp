// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_file.hpp"

#include <fstream>
#include <limits>
#include <string>

#include "header_lines.hpp"
#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

using graph::InputError;

constexpr size_t kKittiPointBytes = 4 * sizeof(float);

std::string file_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  std::string text(in ? static_cast<size_t>(in.tellg()) : 0, '\0');
  in.seekg(0);
  if (!in.read(text.data(), static_cast<std::streamsize>(text.size())))
    throw InputError("cannot be read");
  if (text.empty()) throw InputError("the file is empty");
  return text;
}

/// One line of numbers; a line without all three coordinates gives a point nowhere.
Eigen::Vector3f ascii_point(std::string_view line, const std::array<size_t, 3>& columns) {
  Eigen::Vector3f point = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  for (size_t column = 0; column <= std::ranges::max(columns); ++column) {
    const auto value = to_number(take_field(line));
    for (size_t k = 0; k < columns.size(); ++k)
      if (columns[k] == column && value) point[static_cast<Eigen::Index>(k)] = to_float(*value);
  }
  return point;
}

}  // namespace

void add_ascii_points(std::string_view text, uint64_t count, const std::array<size_t, 3>& columns,
                      CloudPoints& cloud) {
  uint64_t points = 0;
  while (points < count) {
    const auto line = take_line(text);
    if (!line) break;
    if (without_comment(*line).empty()) continue;
    cloud.add(ascii_point(*line, columns));
    ++points;
  }
  cloud.damage = missing_points(points, count);
}

CloudPoints read_kitti_bin(std::string_view file) {
  PointLayout layout;
  layout.step = kKittiPointBytes;
  layout.add_field("x", 0, sizeof(float), true);
  layout.add_field("y", sizeof(float), sizeof(float), true);
  layout.add_field("z", 2 * sizeof(float), sizeof(float), true);
  CloudPoints cloud;
  add_points(file, file.size() / kKittiPointBytes, layout, cloud);
  if (file.size() % kKittiPointBytes != 0) cloud.damage = "clouds cut: the last point is not whole";
  return cloud;
}

CloudPoints read_cloud_file(const std::filesystem::path& path) {
  const std::string text = file_text(path);
  const std::string extension = path.extension().string();
  if (extension == ".pcd") return read_pcd(text);
  if (extension == ".ply") return read_ply(text);
  return read_kitti_bin(text);
}

}  // namespace hmt::submap
