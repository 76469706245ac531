// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/map/octree.hpp"

// Otherwise OctoMap prints from its headers in debug builds.
#define OCTOMAP_NODEBUGOUT
#include <octomap/OcTree.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "scan_caster.hpp"

namespace hmt::submap {
namespace {

/// Log odds of one cell, changed and clamped as octomap::OccupancyOcTreeBase does.
struct LogOddsCell : DrawnCell {
  float log_odds = 0;
  void hit() { log_odds = std::min(log_odds + kHit, kMax); }
  void miss() { log_odds = std::max(log_odds + kMiss, kMin); }

  // OctoMap's defaults: P(hit) = 0.7, P(miss) = 0.4, clamped to [0.1192, 0.971].
  static inline const float kHit = octomap::logodds(0.7);
  static inline const float kMiss = octomap::logodds(0.4);
  static inline const float kMin = octomap::logodds(0.1192);
  static inline const float kMax = octomap::logodds(0.971);
};

constexpr size_t kNodeBytes = sizeof(float) + 1;
constexpr int kTreeDepth = 16;

/// Takes one node and its children off the front of the bytes; false where they end too early or
/// the tree is too deep.
bool take_node(std::string_view& bytes, int depth) {
  if (bytes.size() < kNodeBytes || depth > kTreeDepth) return false;
  const auto children = static_cast<uint8_t>(bytes[kNodeBytes - 1]);
  bytes.remove_prefix(kNodeBytes);
  for (int k = 0; k < std::popcount(children); ++k)
    if (!take_node(bytes, depth + 1)) return false;
  return true;
}

/// The header ends here, the nodes follow.
constexpr std::string_view kData = "\ndata\n";

/// Resolution in the header of an .ot tree whose nodes are whole; nothing where it is not one.
std::optional<double> whole_tree_resolution(std::string_view ot_bytes) {
  const size_t end = ot_bytes.substr(0, 1024).find(kData);
  if (!ot_bytes.starts_with("# Octomap OcTree file\n") || end == std::string_view::npos)
    return std::nullopt;
  const std::string header(ot_bytes.substr(0, end));
  const size_t at = header.find("\nres ");
  if (at == std::string::npos) return std::nullopt;
  const double resolution_m = std::strtod(header.c_str() + at + 5, nullptr);
  std::string_view nodes = ot_bytes.substr(end + kData.size());
  const bool whole = nodes.empty() || (take_node(nodes, 0) && nodes.empty());
  // The negation refuses a NaN too.
  if (!whole || !(resolution_m > 0) || !std::isfinite(resolution_m)) return std::nullopt;
  return resolution_m;
}

/// OctoMap's own readers print to the terminal and run away on damaged bytes, so only the nodes are
/// left to them, and only once they have been walked through.
octomap::OcTree read_tree(std::string_view ot_bytes) {
  const std::optional<double> resolution_m = whole_tree_resolution(ot_bytes);
  if (!resolution_m)
    throw InputError("an octree of " + std::to_string(ot_bytes.size()) +
                     " bytes is not a whole .ot tree; make the map again with --force");
  octomap::OcTree tree(*resolution_m);
  const std::string_view nodes = ot_bytes.substr(ot_bytes.find(kData) + kData.size());
  std::istringstream in{std::string(nodes)};
  if (!nodes.empty()) tree.readData(in);
  return tree;
}

}  // namespace

std::string build_octree(std::span<const PlacedObservation> observations,
                         const ObservationStore& store, Space space, const OctreeOptions& options) {
  if (!(options.resolution_m >= 0.005 && options.resolution_m <= 10))
    throw InputError("octree resolution_m is " + std::to_string(options.resolution_m) +
                     "; it must lie in [0.005, 10]");
  BlockGrid<LogOddsCell> grid;
  uint32_t reading_number = 0;
  for (const PlacedObservation& placed : observations)
    for (const auto seen = store.load(placed.observation); const Reading& reading : seen->readings)
      cast_beams(beams_of(reading, placed.T_frame_robot, space, options.resolution_m),
                 ++reading_number, grid);
  octomap::OcTree tree(options.resolution_m);
  constexpr int kCenterKey = 32768;
  grid.for_each([&](const CellIndex& index, const LogOddsCell& cell) {
    if (cell.last_reading == 0) return;
    const auto key = [&](int axis) { return static_cast<uint16_t>(index[axis] + kCenterKey); };
    tree.setNodeValue(octomap::OcTreeKey(key(0), key(1), key(2)), cell.log_odds, true);
  });
  tree.updateInnerOccupancy();
  tree.prune();
  std::ostringstream out;
  tree.write(out);
  return out.str();
}

std::vector<OctreeCell> octree_cells(std::string_view ot_bytes) {
  const octomap::OcTree tree = read_tree(ot_bytes);
  std::vector<OctreeCell> cells;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    cells.push_back({{leaf.getX(), leaf.getY(), leaf.getZ()},
                     leaf.getSize(),
                     leaf->getLogOdds(),
                     tree.isNodeOccupied(*leaf)});
  return cells;
}

std::vector<bool> in_occupied_cells(std::string_view ot_bytes,
                                    std::span<const Eigen::Vector3d> points) {
  const octomap::OcTree tree = read_tree(ot_bytes);
  std::vector<bool> occupied;
  occupied.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    const octomap::OcTreeNode* node = tree.search(p.x(), p.y(), p.z());
    occupied.push_back(node && tree.isNodeOccupied(node));
  }
  return occupied;
}

double octree_resolution(std::string_view ot_bytes) {
  return read_tree(ot_bytes).getResolution();
}

std::string octree_to_bt(std::string_view ot_bytes) {
  octomap::OcTree tree = read_tree(ot_bytes);
  tree.toMaxLikelihood();
  tree.prune();
  // The header of OcTree::writeBinary, which would also print to the terminal.
  std::ostringstream out;
  out << "# Octomap OcTree binary file\n"
      << "# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
      << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres " << tree.getResolution()
      << kData;
  tree.writeBinaryData(out);
  return out.str();
}

}  // namespace hmt::submap
