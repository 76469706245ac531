// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "check_map.hpp"

#include <algorithm>

namespace hmt::submap {
namespace {

class MapCheck {
 public:
  MapCheck(const Database& database, const HybridMap& map) : database_(&database), map_(&map) {}

  void run() const {
    check_track();
    const size_t n = map_->track.keyframes.size();
    require(map_->submap_of_keyframe.size() == n, "the partition has not one label a keyframe");
    for (const int label : map_->submap_of_keyframe) require_index(label, num_submaps(), "label");
    for (const Constraint& c : map_->constraints) check_pair(c.a, c.b, n, "constraint");
    for (const Sighting& s : map_->sightings) {
      require_index(s.keyframe, n, "keyframe of a sighting");
      require_index(s.observation, map_->track.observations.size(), "observation of a sighting");
      require_landmark(s.landmark);
    }
    for (const PlacedLandmark& l : map_->landmarks) require_landmark(l.landmark);
    for (const graph::Arc& arc : map_->overlap) check_pair(arc.a, arc.b, n, "overlap");
    for (size_t id = 0; id < num_submaps(); ++id) check_submap(static_cast<int>(id));
    for (const Link& link : map_->links) {
      check_pair(link.a, link.b, num_submaps(), "link");
      for (const int c : link.evidence) require_index(c, map_->constraints.size(), "evidence");
      for (const int l : link.landmarks) require_landmark(l);
    }
    for (const LoopCandidate& loop : map_->loops) {
      check_pair(loop.a, loop.b, n, "loop candidate");
      require_index(static_cast<int>(loop.verdict), static_cast<size_t>(LoopVerdict::confirmed) + 1,
                    "verdict");
    }
    require(map_->T_world_submap.size() == num_submaps(), "not one pose a submap");
  }

 private:
  size_t num_submaps() const { return map_->submaps.size(); }

  void check_track() const {
    const Track& track = map_->track;
    for (const TrackedObservation& tracked : track.observations)
      require_index(tracked.keyframe, track.keyframes.size(), "keyframe of an observation");
    for (const Keyframe& keyframe : track.keyframes)
      require_index(keyframe.observation, track.observations.size(), "observation of a keyframe");
    for (const Constraint& c : track.odometry)
      check_pair(c.a, c.b, track.keyframes.size(), "odometry");
  }

  void check_submap(int id) const {
    const Submap& submap = map_->submaps[static_cast<size_t>(id)];
    require(submap.id == id && !submap.keyframes.empty(), "a submap is missing or empty");
    require(std::is_sorted(submap.keyframes.begin(), submap.keyframes.end()),
            "the keyframes of a submap are not in order");
    for (const int keyframe : submap.keyframes) {
      require_index(keyframe, map_->submap_of_keyframe.size(), "keyframe of a submap");
      require(map_->submap_of_keyframe[static_cast<size_t>(keyframe)] == id,
              "a submap has a keyframe of another one");
    }
    const auto members =
        std::count(map_->submap_of_keyframe.begin(), map_->submap_of_keyframe.end(), id);
    require(members == static_cast<long>(submap.keyframes.size()),
            "a submap lacks one of its keyframes");
    for (const int c : submap.constraints)
      require_index(c, map_->constraints.size(), "constraint of a submap");
    for (const PlacedLandmark& l : submap.landmarks) require_landmark(l.landmark);
  }

  void require_landmark(int landmark) const {
    require_index(landmark, map_->landmark_names.size(), "number of a landmark");
  }

  void check_pair(int a, int b, size_t size, const char* what) const {
    require_index(a, size, what);
    require_index(b, size, what);
  }

  void require_index(int64_t index, size_t size, const char* what) const {
    require(index >= 0 && static_cast<size_t>(index) < size, what);
  }

  void require(bool good, const char* what) const {
    if (!good) database_->fail_damaged(std::string("its parts do not fit together: ") + what);
  }

  const Database* database_;
  const HybridMap* map_;
};

}  // namespace

void check_map(const Database& database, const HybridMap& map) {
  MapCheck(database, map).run();
}

}  // namespace hmt::submap
