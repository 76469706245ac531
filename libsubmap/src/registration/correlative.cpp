// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/correlative.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "likelihood_grid.hpp"
#include "registration_target.hpp"

namespace hmt::submap {
namespace {

// More points cost time and add little to a match that registration refines.
constexpr size_t kMostPoints = 200;
// Points farther than this are few and would make the step of heading needlessly small.
constexpr double kMostReach_m = 20;
constexpr double kDistinct_m = 0.3;
constexpr double kDistinct_rad = 0.1;
// Poses within this share of the best score are kept as rivals.
constexpr double kRivalShare = 0.7;

// A square of offsets at one heading, with an upper bound of their scores; at level 0 a single
// offset and its score.
struct Block {
  int bound = 0;
  int level = 0;
  int heading = 0;
  Eigen::Array2i offset{0, 0};
};

// Best first, ties by place.
bool before(const Block& a, const Block& b) {
  const auto order = [](const Block& c) {
    return std::tuple(-c.bound, c.heading, c.offset.y(), c.offset.x());
  };
  return order(a) < order(b);
}

std::vector<Eigen::Vector3d> sample_points(const Surface& source) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : source.points_robot)
    if (p.norm() <= kMostReach_m) points.push_back(p);
  const size_t stride = (points.size() + kMostPoints - 1) / kMostPoints;
  std::vector<Eigen::Vector3d> sampled;
  for (size_t i = 0; i < points.size(); i += stride) sampled.push_back(points[i]);
  return sampled;
}

class Search {
 public:
  Search(std::vector<Eigen::Vector3d> points, const RegistrationTarget::Impl& target,
         const Pose& guess, const CorrelativeWindow& window)
      : points_(std::move(points)),
        guess_(guess),
        reach_m_(reach(points_)),
        grid_(plane_points(target), guess.translation.head<2>(), reach_m_ + window.half_width_m),
        steps_(static_cast<int>(std::ceil(window.half_width_m / LikelihoodGrid::kCell_m))),
        // The farthest points move by no more than a cell and a half from heading to heading.
        heading_step_rad_(1.5 * LikelihoodGrid::kCell_m / reach_m_),
        headings_(static_cast<int>(std::ceil(window.half_angle_rad / heading_step_rad_))) {
    for (int h = -headings_; h <= headings_; ++h) cells_.push_back(cells_at(h));
  }

  // The best offset of every block of level 1 that may hold a rival of the best one, best first.
  std::vector<Block> run(double least_score) {
    best_ = static_cast<int>(least_score * 255.0 * static_cast<double>(points_.size()));
    found_.clear();
    std::vector<Block> roots;
    const int side = LikelihoodGrid::side(kTop);
    for (int h = -headings_; h <= headings_; ++h)
      for (int y = -steps_; y <= steps_; y += side)
        for (int x = -steps_; x <= steps_; x += side) roots.push_back(block_at(kTop, h, {x, y}));
    descend(roots);
    std::sort(found_.begin(), found_.end(), before);
    return std::move(found_);
  }

  Pose pose_of(const Block& candidate) const {
    Pose pose = turned(candidate.heading);
    pose.translation.head<2>() +=
        LikelihoodGrid::kCell_m * candidate.offset.cast<double>().matrix();
    return pose;
  }

  double score_of(const Block& candidate) const {
    return candidate.bound / (255.0 * static_cast<double>(points_.size()));
  }

 private:
  static double reach(const std::vector<Eigen::Vector3d>& points) {
    double reach_m = 1;
    for (const Eigen::Vector3d& p : points) reach_m = std::max(reach_m, p.norm());
    return reach_m;
  }

  static std::vector<Eigen::Vector2d> plane_points(const RegistrationTarget::Impl& target) {
    std::vector<Eigen::Vector2d> points;
    for (const SurfaceElement& element : target.elements) points.push_back(element.point.head<2>());
    return points;
  }

  Pose turned(int heading) const {
    const Eigen::AngleAxisd turn(heading * heading_step_rad_, Eigen::Vector3d::UnitZ());
    return {guess_.translation, Eigen::Quaterniond(turn) * guess_.rotation};
  }

  std::vector<Eigen::Array2i> cells_at(int heading) const {
    const Pose pose = turned(heading);
    const Eigen::Matrix<double, 2, 3> R = pose.rotation_matrix().topRows<2>();
    std::vector<Eigen::Array2i> cells;
    cells.reserve(points_.size());
    for (const Eigen::Vector3d& p : points_)
      cells.push_back(grid_.cell_of(R * p + pose.translation.head<2>()));
    return cells;
  }

  Block block_at(int level, int heading, const Eigen::Array2i& offset) const {
    Block block{0, level, heading, offset};
    for (const Eigen::Array2i& cell : cells_[static_cast<size_t>(heading + headings_)])
      block.bound += grid_.bound(level, cell + offset);
    return block;
  }

  void descend(std::vector<Block>& blocks) {
    std::sort(blocks.begin(), blocks.end(), before);
    for (const Block& block : blocks) {
      if (block.bound < kRivalShare * best_ || block.bound == 0) break;
      if (block.level == 0) {
        // The others of its block are the same match.
        best_ = std::max(best_, block.bound);
        found_.push_back(block);
        break;
      }
      std::vector<Block> children = children_of(block);
      descend(children);
    }
  }

  std::vector<Block> children_of(const Block& block) const {
    std::vector<Block> children;
    const int level = block.level - 1;
    const int side = LikelihoodGrid::side(level);
    for (int y = 0; y < LikelihoodGrid::kPool; ++y)
      for (int x = 0; x < LikelihoodGrid::kPool; ++x) {
        const Eigen::Array2i offset = block.offset + side * Eigen::Array2i(x, y);
        if (level > 0 && (offset > steps_).any()) continue;
        children.push_back(block_at(level, block.heading, offset));
      }
    return children;
  }

  static constexpr int kTop = LikelihoodGrid::kLevels - 1;
  std::vector<Eigen::Vector3d> points_;
  Pose guess_;
  double reach_m_;
  LikelihoodGrid grid_;
  int steps_;
  double heading_step_rad_;
  int headings_;
  std::vector<std::vector<Eigen::Array2i>> cells_;  // one entry a heading
  int best_ = 0;                                    // score so far, or what is asked for
  std::vector<Block> found_;
};

bool is_distinct(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm() > kDistinct_m ||
         std::abs(graph::wrap_angle(a.yaw_rad() - b.yaw_rad())) > kDistinct_rad;
}

}  // namespace

std::vector<CorrelativeMatch> correlative_search(const Surface& source,
                                                 const RegistrationTarget& target,
                                                 const Pose& T_target_source_guess,
                                                 const CorrelativeWindow& window, int max_matches,
                                                 double least_score) {
  std::vector<Eigen::Vector3d> points = sample_points(source);
  if (points.empty() || target.size() == 0) return {};
  Search search(std::move(points), target.impl(), T_target_source_guess, window);
  std::vector<CorrelativeMatch> matches;
  for (const Block& candidate : search.run(least_score)) {
    if (static_cast<int>(matches.size()) >= max_matches) break;
    const Pose pose = search.pose_of(candidate);
    const bool distinct = std::all_of(
        matches.begin(), matches.end(),
        [&](const CorrelativeMatch& match) { return is_distinct(match.T_target_source, pose); });
    if (distinct) matches.push_back({pose, search.score_of(candidate)});
  }
  return matches;
}

}  // namespace hmt::submap
