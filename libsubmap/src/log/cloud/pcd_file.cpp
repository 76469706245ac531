// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <lzf.h>

#include <algorithm>
#include <limits>
#include <string>

#include "../ros/wire.hpp"
#include "cloud_file.hpp"
#include "header_lines.hpp"
#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

using graph::InputError;

/// Fields of one point: more are no point, and lying counts must not overflow.
constexpr size_t kMaxFields = 1000;
constexpr int64_t kMaxCount = 100000;
/// LZF makes 264 bytes of 3 at most.
constexpr uint64_t kMaxRatio = 88;

struct Field {
  std::string_view name;
  int64_t size = 4;
  char type = 'F';
  int64_t count = 1;

  size_t bytes() const { return static_cast<size_t>(size * count); }
};

struct Header {
  std::vector<Field> fields;
  int64_t width = 0;
  int64_t height = 1;
  std::optional<int64_t> points;
  std::string_view data;  ///< ascii, binary or binary_compressed

  uint64_t count() const {
    if (points) return static_cast<uint64_t>(*points);
    // Of numbers below 2^63 each the product may not fit.
    return height > 0 && width > std::numeric_limits<int64_t>::max() / height
               ? std::numeric_limits<uint64_t>::max()
               : static_cast<uint64_t>(width) * static_cast<uint64_t>(height);
  }
};

int64_t take_count(std::string_view& values, std::string_view key, int64_t most) {
  const auto value = to_count(take_field(values));
  if (!value || *value > most)
    throw InputError("the header's " + std::string(key) + " is no such number");
  return *value;
}

/// One line of the header; false where it is unknown.
void read_header_line(std::string_view line, Header& header) {
  const std::string_view key = take_field(line);
  constexpr int64_t kAny = std::numeric_limits<int64_t>::max();
  if (key == "FIELDS") {
    for (auto name = take_field(line); !name.empty(); name = take_field(line))
      if (header.fields.size() < kMaxFields) header.fields.push_back({name});
  } else if (key == "SIZE") {
    for (Field& field : header.fields) field.size = take_count(line, key, 8);
  } else if (key == "TYPE") {
    for (Field& field : header.fields) field.type = (std::string(take_field(line)) + ' ')[0];
  } else if (key == "COUNT") {
    for (Field& field : header.fields) field.count = take_count(line, key, kMaxCount);
  } else if (key == "WIDTH") {
    header.width = take_count(line, key, kAny);
  } else if (key == "HEIGHT") {
    header.height = take_count(line, key, kAny);
  } else if (key == "POINTS") {
    header.points = take_count(line, key, kAny);
  } else if (key == "DATA") {
    header.data = take_field(line);
  }
}

/// Takes the header off the front of the file.
Header take_header(std::string_view& file) {
  Header header;
  while (header.data.empty()) {
    const auto line = take_line(file);
    if (!line) throw InputError("no PCD file: it has no line DATA");
    read_header_line(without_comment(*line), header);
  }
  return header;
}

PointLayout layout_of(const Header& header) {
  PointLayout layout;
  for (const Field& field : header.fields) {
    if (!layout.add_field(field.name, layout.step, static_cast<size_t>(field.size),
                          field.type == 'F'))
      throw InputError("the coordinates are no floating-point numbers");
    layout.step += field.bytes();
  }
  if (const std::string problem = layout.problem(); !problem.empty()) throw InputError(problem);
  return layout;
}

CloudPoints read_ascii(std::string_view text, const Header& header) {
  std::array<size_t, 3> columns{};
  size_t column = 0;
  for (const Field& field : header.fields) {
    if (field.name.size() == 1 && field.name[0] >= 'x' && field.name[0] <= 'z')
      columns[static_cast<size_t>(field.name[0] - 'x')] = column;
    column += static_cast<size_t>(field.count);
  }
  CloudPoints cloud;
  add_ascii_points(text, header.count(), columns, cloud);
  return cloud;
}

/// In this format all values of the first field come first, then all of the second, and so on.
void add_planes(std::string_view planes, uint64_t points, const Header& header,
                CloudPoints& cloud) {
  std::array<const char*, 3> begin{};
  std::array<Coordinate, 3> xyz;
  size_t offset = 0;
  for (const Field& field : header.fields) {
    if (field.name.size() == 1 && field.name[0] >= 'x' && field.name[0] <= 'z') {
      const auto k = static_cast<size_t>(field.name[0] - 'x');
      begin[k] = planes.data() + offset * points;
      xyz[k].is_double = field.size == 8;
    }
    offset += field.bytes();
  }
  const auto value = [&](size_t k, uint64_t i) {
    return xyz[k].load(begin[k] + i * xyz[k].size(), true);
  };
  for (uint64_t i = 0; i < points; ++i) cloud.add({value(0, i), value(1, i), value(2, i)});
}

CloudPoints read_compressed(std::string_view data, const Header& header, size_t step) {
  if (data.size() < 2 * sizeof(uint32_t)) throw InputError("the compressed points are cut");
  const uint64_t packed = load_number<uint32_t>(data.data(), true);
  const uint64_t unpacked = load_number<uint32_t>(data.data() + sizeof(uint32_t), true);
  data.remove_prefix(2 * sizeof(uint32_t));
  if (packed > data.size()) throw InputError("the compressed points are cut");
  if (unpacked > kMaxRatio * packed) throw InputError("the header's sizes are no LZF data");
  std::string planes(unpacked, '\0');
  const auto size = lzf_decompress(data.data(), static_cast<unsigned>(packed), planes.data(),
                                   static_cast<unsigned>(unpacked));
  if (size != unpacked) throw InputError("the compressed points are damaged");
  // Where the planes lie depends on the count, so a wrong one leaves nothing to use.
  if (header.count() != unpacked / step || unpacked % step != 0)
    throw InputError("the header's number of points is not that of the data");
  CloudPoints cloud;
  add_planes(planes, header.count(), header, cloud);
  return cloud;
}

}  // namespace

CloudPoints read_pcd(std::string_view file) {
  const Header header = take_header(file);
  const PointLayout layout = layout_of(header);
  if (header.count() == 0) return {};
  if (header.data == "ascii") return read_ascii(file, header);
  if (header.data == "binary_compressed") return read_compressed(file, header, layout.step);
  if (header.data != "binary")
    throw InputError("unknown PCD data \"" + std::string(header.data.substr(0, 40)) + "\"");
  CloudPoints cloud;
  add_points(file, header.count(), layout, cloud);
  cloud.damage = missing_points(file.size() / layout.step, header.count());
  return cloud;
}

}  // namespace hmt::submap
