// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include "cloud_file.hpp"
#include "header_lines.hpp"
#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

using graph::InputError;

struct Type {
  std::string_view name;
  size_t size;
  bool is_float = false;
};
constexpr Type kTypes[] = {
    {"char", 1},        {"uchar", 1},         {"int8", 1},         {"uint8", 1},
    {"short", 2},       {"ushort", 2},        {"int16", 2},        {"uint16", 2},
    {"int", 4},         {"uint", 4},          {"int32", 4},        {"uint32", 4},
    {"float", 4, true}, {"float32", 4, true}, {"double", 8, true}, {"float64", 8, true}};

struct Header {
  std::string_view format;
  uint64_t vertices = 0;
  PointLayout layout;
  std::array<size_t, 3> columns{};
};

void add_property(std::string_view line, size_t column, Header& header) {
  const std::string_view type_name = take_field(line);
  const std::string_view name = take_field(line);
  const auto type = std::ranges::find(kTypes, type_name, &Type::name);
  if (type == std::end(kTypes))
    throw InputError("a vertex has a property of type \"" + std::string(type_name.substr(0, 40)) +
                     "\"");
  if (!header.layout.add_field(name, header.layout.step, type->size, type->is_float))
    throw InputError("the coordinates are no floating-point numbers");
  if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z')
    header.columns[static_cast<size_t>(name[0] - 'x')] = column;
  header.layout.step += type->size;
}

/// Takes the header off the front of the file.
Header take_header(std::string_view& file) {
  Header header;
  int elements = 0;
  size_t properties = 0;
  while (true) {
    const auto whole_line = take_line(file);
    if (!whole_line) throw InputError("no PLY file: it has no line end_header");
    std::string_view line = *whole_line;
    const std::string_view key = take_field(line);
    if (key == "end_header") break;
    if (key == "format") header.format = take_field(line);
    if (key == "element" && elements++ == 0) {
      const auto count = take_field(line) == "vertex" ? to_count(take_field(line)) : std::nullopt;
      if (!count) throw InputError("the first element is no number of vertices");
      header.vertices = static_cast<uint64_t>(*count);
    }
    if (key == "property" && elements == 1) add_property(line, properties++, header);
  }
  header.layout.little_endian = header.format != "binary_big_endian";
  if (const auto problem = header.layout.problem(); !problem.empty()) throw InputError(problem);
  return header;
}

}  // namespace

CloudPoints read_ply(std::string_view file) {
  if (!file.starts_with("ply")) throw InputError("no PLY file");
  const Header header = take_header(file);
  CloudPoints cloud;
  if (header.format == "ascii") {
    add_ascii_points(file, header.vertices, header.columns, cloud);
  } else if (header.format.starts_with("binary_")) {
    add_points(file, header.vertices, header.layout, cloud);
    cloud.damage = missing_points(file.size() / header.layout.step, header.vertices);
  } else {
    throw InputError("unknown PLY format");
  }
  return cloud;
}

}  // namespace hmt::submap
