// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <vector>

#include "hmt/submap/registration/register_surface.hpp"

namespace hmt::submap {

/// A full turn in steps of 0.35 rad makes 18 keyframes; some more join it with the way there.
inline constexpr size_t kLocalMapKeyframes = 30;

/// The surfaces of the latest keyframes: what an observation is registered against. It forgets the
/// oldest ones, so its memory is bounded.
class LocalMap {
 public:
  void add(const Pose& T_track_robot, Surface surface);
  /// Nothing is left but what is added from now on.
  void forget() { surfaces_.clear(); }
  /// In the track's frame.
  const RegistrationTarget& target() const { return target_; }
  /// What it is made of, in the same frame; holds until the next add().
  std::vector<RegistrationTarget::Placed> surfaces() const;

 private:
  struct Placed {
    Pose T_track_robot;
    Surface surface;
  };
  std::deque<Placed> surfaces_;
  RegistrationTarget target_{{}};
};

}  // namespace hmt::submap
