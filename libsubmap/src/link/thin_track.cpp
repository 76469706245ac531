// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/thin_track.hpp"

#include <string>

#include "../registration/information.hpp"

namespace hmt::submap {
namespace {

size_t at(int i) {
  return static_cast<size_t>(i);
}

void check(const Track& track, Hosts host, std::span<const Pose> T_world_keyframe) {
  const auto stays = [&](size_t k) { return at(host[k]) == k; };
  if (host.empty() || host.size() > track.keyframes.size() || !stays(0) || !stays(host.size() - 1))
    throw InputError("thin_track: the first and the last keyframe must stay");
  if (T_world_keyframe.size() != host.size())
    throw InputError("thin_track: " + std::to_string(host.size()) + " keyframes, but " +
                     std::to_string(T_world_keyframe.size()) + " poses");
  for (const int h : host)
    if (h < 0 || at(h) >= host.size() || !stays(at(h)))
      throw InputError("thin_track: a keyframe hangs on " + std::to_string(h) +
                       ", which does not stay");
}

/// From the keyframe `from` to the next one that stays, over those that do not.
Constraint chain(const Track& track, std::span<const int> number, int from) {
  Constraint step = track.odometry[at(from)];
  while (number[at(step.b)] < 0) {
    const Constraint& next = track.odometry[at(step.b)];
    step.information =
        compose_information(track.space, next.T_a_b, step.information, next.information);
    step.T_a_b = step.T_a_b * next.T_a_b;
    step.b = next.b;
  }
  step.a = number[at(step.a)];
  step.b = number[at(step.b)];
  return step;
}

}  // namespace

std::vector<int> numbers_of_kept(Hosts host, size_t num_keyframes) {
  std::vector<int> number(num_keyframes, -1);
  int kept = 0;
  for (size_t k = 0; k < num_keyframes; ++k)
    if (k >= host.size() || at(host[k]) == k) number[k] = kept++;
  return number;
}

Track thin_track(const Track& track, Hosts host, std::span<const Pose> T_world_keyframe) {
  check(track, host, T_world_keyframe);
  const std::vector<int> number = numbers_of_kept(host, track.keyframes.size());
  Track thinned;
  thinned.space = track.space;
  thinned.log = track.log;
  for (const Keyframe& keyframe : track.keyframes) {
    if (number[at(keyframe.id)] < 0) continue;
    thinned.keyframes.push_back(keyframe);
    thinned.keyframes.back().id = number[at(keyframe.id)];
    if (at(keyframe.id) < track.odometry.size())
      thinned.odometry.push_back(chain(track, number, keyframe.id));
  }
  thinned.observations = track.observations;
  for (TrackedObservation& observation : thinned.observations) {
    const int on = observation.keyframe;
    if (at(on) < host.size() && host[at(on)] != on) {
      observation.T_keyframe_robot =
          graph::relative_pose(T_world_keyframe[at(host[at(on)])], T_world_keyframe[at(on)]) *
          observation.T_keyframe_robot;
      observation.keyframe = host[at(on)];
    }
    observation.keyframe = number[at(observation.keyframe)];
  }
  return thinned;
}

std::vector<Constraint> thin_constraints(std::span<const Constraint> constraints,
                                         std::span<const int> number, const Track& thinned,
                                         size_t num_kept) {
  std::vector<Constraint> kept(
      thinned.odometry.begin(),
      thinned.odometry.begin() + static_cast<std::ptrdiff_t>(num_kept) - 1);
  for (Constraint c : constraints) {
    c.a = number[at(c.a)];
    c.b = number[at(c.b)];
    if (c.kind != ConstraintKind::odometry && c.a >= 0 && c.b >= 0) kept.push_back(c);
  }
  return kept;
}

std::vector<LoopCandidate> thin_loops(std::span<const LoopCandidate> loops,
                                      std::span<const int> number) {
  std::vector<LoopCandidate> kept;
  for (const LoopCandidate& loop : loops) {
    if (number[at(loop.a)] < 0 || number[at(loop.b)] < 0) continue;
    kept.push_back(loop);
    kept.back().a = number[at(loop.a)];
    kept.back().b = number[at(loop.b)];
  }
  return kept;
}

}  // namespace hmt::submap
