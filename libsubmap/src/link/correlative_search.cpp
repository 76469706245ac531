// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/correlative_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hmt::submap {
namespace {

/// All translations x .. x + 2^level - 1, y .. y + 2^level - 1 (cells) at one heading.
struct Node {
  int score = 0;  ///< no translation of the node scores more; sum over the points, 255 each
  int heading = 0;
  int level = 0;
  int x = 0;
  int y = 0;
};

/// The query points' cells at one heading and the guess's translation.
struct Rotated {
  double yaw_offset_rad = 0;
  bool excluded = false;  ///< translations near the excluded one are left out
  std::vector<Eigen::Vector2i> cells;
};

class Search {
 public:
  Search(const CorrelativeGrid& map, std::span<const Eigen::Vector2f> points_query,
         const CorrelativeWindow& window, const std::optional<CorrelativeExclusion>& excluded)
      : map_(map), window_(window), excluded_(excluded) {
    reach_x_ = static_cast<int>(std::ceil(window.half_x_m / map.cell_m()));
    reach_y_ = static_cast<int>(std::ceil(window.half_y_m / map.cell_m()));
    rotate(points_query);
  }

  std::optional<Node> best(int floor_score) {
    best_.score = floor_score;
    for (const Node& node : roots()) {
      if (node.score <= best_.score) break;
      descend(node);
    }
    return found_ ? std::optional(best_) : std::nullopt;
  }

  Pose pose(const Node& leaf) const {
    const double c = map_.cell_m();
    const Eigen::Vector3d& t = window_.T_map_query.translation;
    const double yaw =
        window_.T_map_query.yaw_rad() + headings_[static_cast<size_t>(leaf.heading)].yaw_offset_rad;
    return Pose::planar(t.x() + leaf.x * c, t.y() + leaf.y * c, yaw);
  }

 private:
  void rotate(std::span<const Eigen::Vector2f> points_query);
  std::vector<Node> roots() const;
  void descend(const Node& node);

  /// Zero as soon as it is clear that the node cannot beat `floor`.
  int bound(const Node& node, int floor) const;

  /// Whether all translations of the node are excluded.
  bool is_excluded(const Node& node) const {
    if (!excluded_ || !headings_[static_cast<size_t>(node.heading)].excluded) return false;
    const double c = map_.cell_m();
    const Eigen::Vector2d low =
        (window_.T_map_query.translation - excluded_->T_map_query.translation).head<2>() +
        c * Eigen::Vector2d(node.x, node.y);
    const Eigen::Vector2d high = low.array() + c * ((1 << node.level) - 1);
    return low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm() < excluded_->radius_m;
  }

  const CorrelativeGrid& map_;
  const CorrelativeWindow& window_;
  const std::optional<CorrelativeExclusion>& excluded_;
  int reach_x_ = 0;  ///< translations -reach .. reach, cells
  int reach_y_ = 0;
  std::vector<Rotated> headings_;  ///< 0, +1, -1, +2, .. steps from the guess
  Node best_;
  bool found_ = false;
};

void Search::rotate(std::span<const Eigen::Vector2f> points_query) {
  float farthest_m = 0;
  for (const Eigen::Vector2f& p : points_query) farthest_m = std::max(farthest_m, p.norm());
  const double step_rad = map_.cell_m() / std::max<double>(farthest_m, map_.cell_m());
  const int reach = static_cast<int>(std::ceil(window_.half_yaw_rad / step_rad));
  const Eigen::Vector2d t = window_.T_map_query.translation.head<2>();
  const auto add = [&](double offset_rad) {
    Rotated heading{offset_rad, false, {}};
    if (excluded_)
      heading.excluded =
          std::abs(graph::wrap_angle(window_.T_map_query.yaw_rad() + offset_rad -
                                     excluded_->T_map_query.yaw_rad())) < excluded_->angle_rad;
    heading.cells.reserve(points_query.size());
    const Eigen::Rotation2Dd R(window_.T_map_query.yaw_rad() + offset_rad);
    for (const Eigen::Vector2f& p : points_query)
      heading.cells.push_back(map_.cell(R * p.cast<double>() + t));
    headings_.push_back(std::move(heading));
  };
  add(0.0);
  for (int i = 1; i <= reach; ++i) {
    add(i * step_rad);
    add(-i * step_rad);
  }
}

std::vector<Node> Search::roots() const {
  const int level = map_.levels();
  const int step = 1 << level;
  std::vector<Node> nodes;
  for (int heading = 0; heading < static_cast<int>(headings_.size()); ++heading)
    for (int y = -reach_y_; y <= reach_y_; y += step)
      for (int x = -reach_x_; x <= reach_x_; x += step) {
        Node node{0, heading, level, x, y};
        node.score = bound(node, best_.score);
        if (node.score > best_.score) nodes.push_back(node);
      }
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const Node& l, const Node& r) { return l.score > r.score; });
  return nodes;
}

int Search::bound(const Node& node, int floor) const {
  constexpr size_t kBlock = 32;
  const auto& cells = headings_[static_cast<size_t>(node.heading)].cells;
  int sum = 0;
  for (size_t first = 0; first < cells.size(); first += kBlock) {
    const size_t last = std::min(cells.size(), first + kBlock);
    for (size_t i = first; i < last; ++i)
      sum += map_.bound(node.level, cells[i].x() + node.x, cells[i].y() + node.y);
    if (sum + 255 * static_cast<int>(cells.size() - last) <= floor) return 0;
  }
  return sum;
}

void Search::descend(const Node& node) {
  if (is_excluded(node)) return;
  if (node.level == 0) {
    best_ = node;
    found_ = true;
    return;
  }
  std::vector<Node> children;
  const int half = 1 << (node.level - 1);
  for (const int dy : {0, half})
    for (const int dx : {0, half}) {
      Node child{0, node.heading, node.level - 1, node.x + dx, node.y + dy};
      if (child.x > reach_x_ || child.y > reach_y_) continue;
      child.score = bound(child, best_.score);
      if (child.score > best_.score) children.push_back(child);
    }
  std::stable_sort(children.begin(), children.end(),
                   [](const Node& l, const Node& r) { return l.score > r.score; });
  for (const Node& child : children)
    if (child.score > best_.score) descend(child);
}

}  // namespace

std::optional<CorrelativeMatch> correlative_search(
    const CorrelativeGrid& map, std::span<const Eigen::Vector2f> points_query,
    const CorrelativeWindow& window, double floor_score,
    const std::optional<CorrelativeExclusion>& excluded) {
  if (points_query.empty()) return std::nullopt;
  const double full = 255.0 * static_cast<double>(points_query.size());
  Search search(map, points_query, window, excluded);
  const auto best = search.best(static_cast<int>(std::floor(floor_score * full)));
  if (!best) return std::nullopt;
  return CorrelativeMatch{search.pose(*best), best->score / full};
}

}  // namespace hmt::submap
