// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "transform_tree.hpp"

#include <algorithm>

namespace hmt::submap {

using graph::Pose;

namespace {

/// Frames of a robot hang on each other less deep than this.
constexpr size_t kMaxDepth = 100;

}  // namespace

void TransformTree::add(const TransformMessage& transform, bool is_static) {
  Frame& frame = frames_[transform.child_frame];
  const bool replaces = is_static || frame.is_static || frame.parent != transform.header.frame;
  if (replaces) frame = {transform.header.frame, is_static, {}};
  frame.T_parent_frame.add(transform.header.stamp_ns, transform.T_parent_child);
}

std::vector<std::string> TransformTree::ancestry(const std::string& frame) const {
  std::vector<std::string> path = {frame};
  while (path.size() < kMaxDepth) {
    const auto place = frames_.find(path.back());
    if (place == frames_.end()) break;
    if (std::ranges::find(path, place->second.parent) != path.end()) break;
    path.push_back(place->second.parent);
  }
  return path;
}

Pose TransformTree::T_ancestor_frame(const std::vector<std::string>& path, size_t steps,
                                     int64_t stamp_ns) const {
  Pose T_ancestor_frame;
  for (size_t k = 0; k < steps; ++k) {
    const PoseHistory& history = frames_.at(path[k]).T_parent_frame;
    const auto T = history.between(stamp_ns);
    T_ancestor_frame = (T ? *T : history.nearest(stamp_ns).value_or(Pose{})) * T_ancestor_frame;
  }
  return T_ancestor_frame;
}

std::optional<Pose> TransformTree::find(const std::string& target, const std::string& source,
                                        int64_t stamp_ns) const {
  const auto target_path = ancestry(target);
  const auto source_path = ancestry(source);
  for (size_t k = 0; k < source_path.size(); ++k) {
    const auto common = std::ranges::find(target_path, source_path[k]);
    if (common == target_path.end()) continue;
    const auto steps = static_cast<size_t>(common - target_path.begin());
    return T_ancestor_frame(target_path, steps, stamp_ns).inverse() *
           T_ancestor_frame(source_path, k, stamp_ns);
  }
  return std::nullopt;
}

}  // namespace hmt::submap
