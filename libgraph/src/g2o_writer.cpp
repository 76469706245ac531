// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <charconv>
#include <fstream>

#include "hmt/graph/g2o_file.hpp"
#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

/// Appends fields in the shortest form that reads back as the same number.
class TextWriter {
 public:
  template <class Number>
  void add(Number value) {
    std::array<char, 32> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    text_.push_back(' ');
    text_.append(buffer.data(), end);
  }
  void begin_line(const char* tag) { text_ += tag; }
  void end_line() { text_.push_back('\n'); }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void add_pose(TextWriter& out, Space space, const Pose& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  if (space == Space::se2)
    for (const double value : {t.x(), t.y(), pose.yaw_rad()}) out.add(value);
  else
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) out.add(value);
}

/// Upper triangle; rotation by vec(q), as g2o has it.
void add_information(TextWriter& out, Space space, const Matrix6d& information) {
  const auto factor = [space](int k) { return space == Space::se3 && k >= 3 ? 2.0 : 1.0; };
  for (int r = 0; r < 6; ++r)
    for (int c = r; c < 6; ++c) {
      const auto used = [space](int k) { return space == Space::se3 || k < 2 || k == 5; };
      if (used(r) && used(c)) out.add(factor(r) * factor(c) * information(r, c));
    }
}

}  // namespace

std::string format_g2o(const G2oFile& file) {
  const PoseGraph& graph = file.graph;
  const bool planar = graph.space == Space::se2;
  TextWriter out;
  for (size_t node = 0; node < graph.poses.size(); ++node) {
    out.begin_line(planar ? "VERTEX_SE2" : "VERTEX_SE3:QUAT");
    out.add(file.ids[node]);
    add_pose(out, graph.space, graph.poses[node]);
    out.end_line();
  }
  for (const int node : graph.fixed) {
    out.begin_line("FIX");
    out.add(file.ids[static_cast<size_t>(node)]);
    out.end_line();
  }
  auto weak = file.weak_edges.begin();
  for (size_t k = 0; k < graph.edges.size(); ++k) {
    const PoseGraphEdge& edge = graph.edges[k];
    out.begin_line(planar ? "EDGE_SE2" : "EDGE_SE3:QUAT");
    out.add(file.ids[static_cast<size_t>(edge.from)]);
    out.add(file.ids[static_cast<size_t>(edge.to)]);
    add_pose(out, graph.space, edge.T_from_to);
    const bool is_weak = weak != file.weak_edges.end() && weak->edge == k;
    add_information(out, graph.space, is_weak ? (weak++)->as_read : edge.information);
    out.end_line();
  }
  return out.take();
}

void write_g2o(const std::filesystem::path& path, const G2oFile& file) {
  const std::string text = format_g2o(file);
  const std::filesystem::path unfinished = path.string() + ".part";
  std::ofstream out(unfinished, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(unfinished, path, error);
  if (!out || error) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw InputError(path.string() + ": cannot be written");
  }
}

}  // namespace hmt::graph
