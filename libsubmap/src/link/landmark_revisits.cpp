// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_revisits.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "../registration/seen_through.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/register_surface.hpp"

namespace hmt::submap {
namespace {

/// Share of what is in view that is looked through at a wrong place; at the right one a door that
/// was opened, or people, are less.
constexpr double kImpossibleShare = 0.3;
/// Keyframes farther apart see too little in common.
constexpr double kNear_m = 3;
/// Visits that a visit is compared with: the largest, so that the work grows with the rounds.
constexpr size_t kMostCompared = 8;

/// How a landmark was seen on one visit.
struct Visit {
  std::vector<int> keyframes;  ///< increasing
  int sightings = 0;
};

/// `keyframes`: of each sighting, in order.
std::vector<Visit> visits(const std::vector<int>& keyframes) {
  std::vector<Visit> all;
  for (const int keyframe : keyframes) {
    if (all.empty() || keyframe - all.back().keyframes.back() > kVisitGap) all.emplace_back();
    Visit& visit = all.back();
    if (visit.keyframes.empty() || visit.keyframes.back() != keyframe)
      visit.keyframes.push_back(keyframe);
    ++visit.sightings;
  }
  return all;
}

class RevisitCheck {
 public:
  RevisitCheck(const Track& track, std::span<const Pose> T_world_keyframe,
               const ObservationStore& observations)
      : track_(track), T_world_keyframe_(T_world_keyframe), observations_(observations) {}

  /// Whether the two keyframes of two visits that are most alike look through what the other saw.
  bool contradict(const Visit& left, const Visit& right) const {
    int a = -1, b = -1;
    double least = kNear_m;
    for (const int l : left.keyframes)
      for (const int r : right.keyframes) {
        const Pose T = T_between(l, r);
        const double distance = T.translation.norm() + std::abs(T.yaw_rad());  // a radian: a metre
        if (distance >= least) continue;
        least = distance;
        a = l;
        b = r;
      }
    return a >= 0 && contradict(a, b);
  }

 private:
  Pose T_between(int a, int b) const {
    return graph::relative_pose(T_world_keyframe_[static_cast<size_t>(a)],
                                T_world_keyframe_[static_cast<size_t>(b)]);
  }
  Surface surface(int keyframe) const {
    return make_surface(
        *observations_.load(track_.keyframes[static_cast<size_t>(keyframe)].observation));
  }
  bool contradict(int a, int b) const {
    const Surface surface_a = surface(a);
    const Surface surface_b = surface(b);
    const RegistrationTarget::Placed placed_a[] = {{Pose{}, &surface_a}};
    const RegistrationTarget::Placed placed_b[] = {{Pose{}, &surface_b}};
    const RegistrationTarget target_a(placed_a);
    const RegistrationTarget target_b(placed_b);
    RegistrationOptions options;
    options.space = track_.space;
    const Registration found = register_surface(surface_b, target_a, T_between(a, b), options);
    const Pose& T_a_b = found.T_target_source;
    return std::max(seen_through_share(surface_b, target_a, T_a_b),
                    seen_through_share(surface_a, target_b, T_a_b.inverse())) >= kImpossibleShare;
  }

  const Track& track_;
  std::span<const Pose> T_world_keyframe_;
  const ObservationStore& observations_;
};

/// For each visit whether it is to the place where most sightings were made.
std::vector<bool> at_one_place(const RevisitCheck& check, const std::vector<Visit>& all) {
  std::vector<size_t> by_size(all.size());
  for (size_t k = 0; k < all.size(); ++k) by_size[k] = k;
  std::stable_sort(by_size.begin(), by_size.end(),
                   [&](size_t l, size_t r) { return all[l].sightings > all[r].sightings; });
  std::vector<bool> is_there(all.size(), false);
  std::vector<size_t> largest;
  for (const size_t k : by_size) {
    is_there[k] = std::none_of(largest.begin(), largest.end(),
                               [&](size_t other) { return check.contradict(all[other], all[k]); });
    if (is_there[k] && largest.size() < kMostCompared) largest.push_back(k);
  }
  return is_there;
}

}  // namespace

LandmarkRevisits check_revisits(const Track& track, std::span<const Pose> T_world_keyframe,
                                std::span<const Sighting> sightings,
                                const ObservationStore& observations) {
  LandmarkRevisits result;
  result.kept.assign(sightings.begin(), sightings.end());
  if (track.space == Space::se3) return result;
  std::map<int, std::vector<int>> keyframes_of;  // by landmark
  for (const Sighting& s : sightings) keyframes_of[s.landmark].push_back(s.keyframe);
  const RevisitCheck check(track, T_world_keyframe, observations);
  std::vector<std::pair<int, int>> left_out;  // landmark and keyframe
  for (auto& [landmark, keyframes] : keyframes_of) {
    std::sort(keyframes.begin(), keyframes.end());
    const std::vector<Visit> all = visits(keyframes);
    const std::vector<bool> is_there = at_one_place(check, all);
    for (size_t k = 0; k < all.size(); ++k) {
      if (is_there[k]) continue;
      ++result.contradicted;
      for (const int keyframe : all[k].keyframes) left_out.emplace_back(landmark, keyframe);
    }
  }
  std::sort(left_out.begin(), left_out.end());
  std::erase_if(result.kept, [&](const Sighting& s) {
    return std::binary_search(left_out.begin(), left_out.end(), std::pair(s.landmark, s.keyframe));
  });
  return result;
}

}  // namespace hmt::submap
