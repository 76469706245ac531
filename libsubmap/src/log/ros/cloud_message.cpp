// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "messages.hpp"

namespace hmt::submap {
namespace {

// Bytes of the shortest PointField: an empty name, offset, datatype, count.
constexpr size_t kLeastField = 4 + 4 + 1 + 4;
// Sizes of the datatypes of sensor_msgs/PointField: from 1, int8 and uint8, ..., float32, float64.
constexpr size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 4, 8};
constexpr int kFloat32 = 7;
constexpr int kFloat64 = 8;

PointLayout read_layout(WireReader& in) {
  PointLayout layout;
  const size_t fields = in.count(kLeastField);
  for (size_t i = 0; i < fields; ++i) {
    const std::string_view name = in.text();
    const size_t offset = in.number<uint32_t>();
    const int datatype = in.number<uint8_t>();
    in.skip<uint32_t>(1);  // count
    const bool is_float = datatype == kFloat32 || datatype == kFloat64;
    const size_t size = datatype <= kFloat64 ? kSizes[datatype] : 0;
    if (!layout.add_field(name, offset, size, is_float))
      throw MessageError("the coordinates are no floating-point numbers");
  }
  return layout;
}

}  // namespace

CloudMessage read_cloud(WireReader in) {
  CloudMessage cloud;
  cloud.header = read_header(in);
  const uint64_t height = in.number<uint32_t>();
  const uint64_t width = in.number<uint32_t>();
  PointLayout layout = read_layout(in);
  layout.little_endian = in.number<uint8_t>() == 0;
  layout.step = in.number<uint32_t>();
  const uint64_t row_step = in.number<uint32_t>();
  const std::string_view data = in.take(in.number<uint32_t>());
  if (height == 0 || width == 0) return cloud;
  if (const std::string problem = layout.problem(); !problem.empty()) throw MessageError(problem);
  // Some drivers leave row_step 0 in clouds of one row.
  const uint64_t row = height == 1 ? width * layout.step : row_step;
  if (row < width * layout.step || row > data.size() / height)
    throw MessageError("width, height and steps do not fit the data");
  for (uint64_t v = 0; v < height; ++v)
    add_points(data.substr(v * row, row), width, layout, cloud.cloud);
  return cloud;
}

}  // namespace hmt::submap
