// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// An edge whose information matrix in the file is not positive definite.
struct G2oWeakEdge {
  size_t edge = 0;      ///< index in the graph
  int64_t line = 0;     ///< in the file, from 1
  double smallest = 0;  ///< smallest eigenvalue of the matrix in the file
  /// Negative beyond rounding: the graph holds the nearest positive semidefinite matrix instead.
  /// Otherwise the matrix is singular and used as it is.
  bool replaced = false;
  Matrix6d as_read = Matrix6d::Zero();  ///< in the units of PoseGraphEdge
};

/// A pose graph as a g2o file holds it, and what was noticed in it.
struct G2oFile {
  PoseGraph graph;
  std::vector<int64_t> ids;  ///< id in the file of every node, ascending
  /// Nodes without a vertex line: chained along the spanning tree from the others.
  std::vector<int> created;
  std::vector<G2oWeakEdge> weak_edges;
  std::map<std::string, int64_t> skipped;  ///< lines of other tags, by tag
  int components = 0;                      ///< connected components; each has its own gauge
};

/// Reads a pose graph in the text format of g2o: VERTEX_SE2, EDGE_SE2, VERTEX_SE3:QUAT,
/// EDGE_SE3:QUAT, FIX, and VERTEX2 and EDGE2 of TORO. Other tags (landmarks, parameters) are
/// skipped and counted; `#` starts a comment. The information of rotations, which g2o states by
/// vec(q), is scaled to 2 vec(q) exactly (rows and columns halved), so chi2 is that of g2o.
///
/// Throws InputError with file and line for: a number that is missing, superfluous or not finite,
/// an id that is not an integer >= 0, a vertex that is defined twice, a quaternion far from unit
/// length, an edge from a vertex to itself, planar and spatial lines in one file, a FIX of an
/// unknown vertex, a line that starts with no tag, and a file without poses.
G2oFile read_g2o(const std::filesystem::path& path);
/// The same from text; `name` stands for the file in messages.
G2oFile parse_g2o(std::string_view text, const std::string& name);

/// Writes vertices, fixed vertices and edges; read_g2o gives the same numbers again. Matrices that
/// were replaced are written as they were read. An existing file is replaced only when the new one
/// is complete. Throws InputError where the file cannot be written.
void write_g2o(const std::filesystem::path& path, const G2oFile& file);
/// The same as text.
std::string format_g2o(const G2oFile& file);

}  // namespace hmt::graph
