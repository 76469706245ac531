// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/g2o_file.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <optional>
#include <set>

#include "g2o_lines.hpp"
#include "hmt/graph/input_error.hpp"
#include "pose_problem.hpp"
#include "spanning_tree.hpp"

namespace hmt::graph {
namespace {

/// Rotations further from unit length than this are damaged, not rounded.
constexpr double kQuaternionTolerance = 0.05;

struct VertexLine {
  int64_t id;
  int64_t line;
  Pose pose;
};

struct EdgeLine {
  int64_t from;
  int64_t to;
  int64_t line;
};

struct FixLine {
  int64_t id;
  int64_t line;
};

/// Rows and columns of rotation by 1/2: from vec(q) to the chart 2 vec(q).
Matrix6d scale_rotation(Matrix6d information, double factor) {
  information.bottomRows<3>() *= factor;
  information.rightCols<3>() *= factor;
  return information;
}

/// Symmetric matrix over `rows` of the tangent from its upper triangle, row by row.
template <size_t kRows>
Matrix6d from_upper_triangle(const double* values, const std::array<int, kRows>& rows) {
  Matrix6d matrix = Matrix6d::Zero();
  for (size_t r = 0; r < kRows; ++r)
    for (size_t c = r; c < kRows; ++c)
      matrix(rows[r], rows[c]) = matrix(rows[c], rows[r]) = *values++;
  return matrix;
}

constexpr std::array<int, 3> kPlanarRows = {0, 1, 5};
constexpr std::array<int, 6> kSpatialRows = {0, 1, 2, 3, 4, 5};

class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : lines_(text, name), name_(name) {}

  G2oFile run() {
    while (lines_.next_line()) read_line();
    if (vertices_.empty() && edges_.empty())
      throw InputError(name_ + ": holds no pose and no edge of a g2o graph");
    file_.graph.space = space_.value_or(Space::se2);
    number_nodes();
    place_nodes();
    join_edges();
    for (const FixLine& fix : fixes_) file_.graph.fixed.push_back(fixed_node(fix));
    create_missing_nodes();
    find_weak_edges();
    return std::move(file_);
  }

 private:
  void read_line() {
    const std::string_view tag = lines_.tag();
    if (tag == "EDGE_SE3:QUAT")
      read_spatial_edge();
    else if (tag == "EDGE_SE2")
      read_planar_edge({0, 1, 2, 3, 4, 5});
    else if (tag == "VERTEX_SE3:QUAT")
      read_spatial_vertex();
    else if (tag == "VERTEX_SE2" || tag == "VERTEX2")
      read_planar_vertex();
    else if (tag == "EDGE2")
      // TORO orders the information xx xy yy tt xt yt.
      read_planar_edge({0, 1, 4, 2, 5, 3});
    else if (tag == "FIX")
      do fixes_.push_back({lines_.id(), lines_.line()});
      while (lines_.more());
    else
      ++file_.skipped[std::string(tag)];
  }

  void take_space(Space space) {
    if (space_.value_or(space) != space)
      lines_.fail("the file mixes poses of the plane and of space; split it");
    space_ = space;
  }

  void read_planar_vertex() {
    take_space(Space::se2);
    const int64_t id = lines_.id();
    std::array<double, 3> v;
    lines_.numbers(v);
    vertices_.push_back({id, lines_.line(), Pose::planar(v[0], v[1], v[2])});
  }

  void read_spatial_vertex() {
    take_space(Space::se3);
    const int64_t id = lines_.id();
    std::array<double, 7> v;
    lines_.numbers(v);
    vertices_.push_back({id, lines_.line(), spatial_pose(v.data())});
  }

  Pose spatial_pose(const double* v) const {
    Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
    if (!(std::abs(q.norm() - 1) <= kQuaternionTolerance))
      lines_.fail("the quaternion has length " + std::to_string(q.norm()) + " instead of 1");
    return {{v[0], v[1], v[2]}, q.normalized()};
  }

  void read_ends() {
    const int64_t from = lines_.id();
    const int64_t to = lines_.id();
    if (from == to) lines_.fail("the edge joins vertex " + std::to_string(from) + " to itself");
    edges_.push_back({from, to, lines_.line()});
  }

  /// `order[k]` is the place in the line of entry k of the upper triangle.
  void read_planar_edge(const std::array<size_t, 6>& order) {
    take_space(Space::se2);
    read_ends();
    std::array<double, 9> v;
    lines_.numbers(v);
    std::array<double, 6> triangle;
    for (size_t k = 0; k < 6; ++k) triangle[k] = v[3 + order[k]];
    add_edge(Pose::planar(v[0], v[1], v[2]), from_upper_triangle(triangle.data(), kPlanarRows));
  }

  void read_spatial_edge() {
    take_space(Space::se3);
    read_ends();
    std::array<double, 28> v;
    lines_.numbers(v);
    add_edge(spatial_pose(v.data()),
             scale_rotation(from_upper_triangle(v.data() + 7, kSpatialRows), 0.5));
  }

  void add_edge(const Pose& T_from_to, const Matrix6d& information) {
    file_.graph.edges.push_back({0, 0, T_from_to, information});
  }

  /// Nodes are the ids of all vertices and edges in ascending order.
  void number_nodes() {
    std::vector<int64_t>& ids = file_.ids;
    ids.reserve(vertices_.size() + 2 * edges_.size());
    for (const VertexLine& vertex : vertices_) ids.push_back(vertex.id);
    for (const EdgeLine& edge : edges_) {
      ids.push_back(edge.from);
      ids.push_back(edge.to);
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    file_.graph.poses.resize(ids.size());
  }

  int node_of(int64_t id) const {
    const auto& ids = file_.ids;
    // Most files number their vertices from 0 without a gap.
    if (id < static_cast<int64_t>(ids.size()) && ids[static_cast<size_t>(id)] == id)
      return static_cast<int>(id);
    const auto at = std::lower_bound(ids.begin(), ids.end(), id);
    return at != ids.end() && *at == id ? static_cast<int>(at - ids.begin()) : -1;
  }

  void place_nodes() {
    lines_of_nodes_.assign(file_.ids.size(), 0);
    for (const VertexLine& vertex : vertices_) {
      const auto node = static_cast<size_t>(node_of(vertex.id));
      if (lines_of_nodes_[node] != 0)
        throw InputError(name_ + ":" + std::to_string(vertex.line) + ": vertex " +
                         std::to_string(vertex.id) + " is defined a second time (first in line " +
                         std::to_string(lines_of_nodes_[node]) + ")");
      lines_of_nodes_[node] = vertex.line;
      file_.graph.poses[node] = vertex.pose;
    }
  }

  void join_edges() {
    for (size_t k = 0; k < edges_.size(); ++k) {
      file_.graph.edges[k].from = node_of(edges_[k].from);
      file_.graph.edges[k].to = node_of(edges_[k].to);
    }
  }

  int fixed_node(const FixLine& fix) const {
    const int node = node_of(fix.id);
    if (node < 0)
      throw InputError(name_ + ":" + std::to_string(fix.line) + ": FIX of vertex " +
                       std::to_string(fix.id) + ", which the file does not hold");
    return node;
  }

  /// The tree grows from the nodes that have a pose, and from the gauge where there is none.
  void create_missing_nodes() {
    const std::vector<int> component = connected_components(file_.graph);
    file_.components = 1 + *std::max_element(component.begin(), component.end());
    for (size_t node = 0; node < lines_of_nodes_.size(); ++node)
      if (lines_of_nodes_[node] == 0) file_.created.push_back(static_cast<int>(node));
    if (file_.created.empty()) return;
    std::vector<bool> placed(lines_of_nodes_.size());
    for (size_t node = 0; node < placed.size(); ++node) placed[node] = lines_of_nodes_[node] != 0;
    file_.graph.poses = spanning_tree_poses(file_.graph, placed);
  }

  void find_weak_edges() {
    with_chart(file_.graph.space, [this](auto chart) {
      for (size_t k = 0; k < edges_.size(); ++k) judge_information<decltype(chart)>(k);
    });
  }

  template <class Chart>
  void judge_information(size_t k) {
    using Matrix = Eigen::Matrix<double, Chart::kTangent, Chart::kTangent>;
    Matrix6d& information = file_.graph.edges[k].information;
    const Matrix block = chart_block<Chart>(information);
    if (is_definite(block)) return;
    // Judged as the file states it; halving the rotation changes no sign.
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(block);
    G2oWeakEdge weak{k, edges_[k].line, eigen.eigenvalues()[0], false, information};
    weak.replaced = !is_semidefinite(block);
    if (weak.replaced)
      information = from_chart_block<Chart>(eigen.eigenvectors() *
                                            eigen.eigenvalues().cwiseMax(0).asDiagonal() *
                                            eigen.eigenvectors().transpose());
    file_.weak_edges.push_back(weak);
  }

  LineReader lines_;
  std::string name_;
  G2oFile file_;
  std::optional<Space> space_;
  std::vector<VertexLine> vertices_;
  std::vector<EdgeLine> edges_;
  std::vector<FixLine> fixes_;
  std::vector<int64_t> lines_of_nodes_;
};

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

std::string read_text(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw InputError(path.string() + ": is a folder, not a g2o file");
  const std::unique_ptr<std::FILE, FileCloser> file(std::fopen(path.c_str(), "rb"));
  if (!file) throw InputError(path.string() + ": cannot be opened for reading");
  std::string text;
  const auto size = std::filesystem::file_size(path, error);
  if (!error) text.reserve(size);
  std::array<char, 1 << 16> buffer;
  while (const size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get()))
    text.append(buffer.data(), count);
  if (std::ferror(file.get()) != 0) throw InputError(path.string() + ": cannot be read to its end");
  return text;
}

}  // namespace

G2oFile parse_g2o(std::string_view text, const std::string& name) {
  return Parser(text, name).run();
}

G2oFile read_g2o(const std::filesystem::path& path) {
  return parse_g2o(read_text(path), path.string());
}

}  // namespace hmt::graph
