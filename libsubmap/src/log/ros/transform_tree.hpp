// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "messages.hpp"
#include "pose_history.hpp"

namespace hmt::submap {

/// Whether the transforms of a topic hold for ever.
inline bool is_static_topic(std::string_view topic) {
  return topic.ends_with("tf_static");
}

/// The frames of a recording and how they stand to each other, as its /tf and /tf_static tell.
class TransformTree {
 public:
  /// A frame has one parent; a new one replaces it. Later messages of a static transform replace
  /// the earlier.
  void add(const TransformMessage& transform, bool is_static);

  /// The frame and its ancestors, the root last. Ends where the tree runs in a circle.
  std::vector<std::string> ancestry(const std::string& frame) const;

  /// T_target_source at a stamp: between the recorded transforms, or the nearest of each, however
  /// far its stamp (mounts are often published rarely). Nothing where no path joins the frames.
  std::optional<graph::Pose> find(const std::string& target, const std::string& source,
                                  int64_t stamp_ns) const;

  bool empty() const { return frames_.empty(); }

 private:
  struct Frame {
    std::string parent;
    bool is_static = false;
    PoseHistory T_parent_frame;
  };
  graph::Pose T_ancestor_frame(const std::vector<std::string>& path, size_t steps,
                               int64_t stamp_ns) const;

  std::map<std::string, Frame> frames_;
};

}  // namespace hmt::submap
