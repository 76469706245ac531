// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "hmt/submap/pipeline.hpp"

namespace hmt::submap {

// The stages of a run in their order. Each reads what the earlier ones left in the file and commits
// its own result under the name `stage`; see build_map().

/// The stage after which no further round is made.
inline const std::string kSettled = "settled";

/// Reads the log once: keyframes, odometry, landmarks and their sightings, a first estimate: of all
/// keyframes of a log of landmarks, of the first one of others, which are gone through in sections.
void read_and_track(MapFile& file, const std::string& stage, const std::filesystem::path& log,
                    const Options& options, const Run& run);

/// Of a log of scans with landmarks: the keyframes where odometry and landmarks put them, without
/// the sightings that the others contradict, or the scans.
void place_by_landmarks(MapFile& file, const Track& track, const std::string& stage,
                        const Run& run);

/// Adds the next section of a track to the keyframes that are estimated: overlap, registrations and
/// loop closures among its keyframes and with those before, in rounds. Loops come first: what is
/// registered before they are closed may be drawn to the wrong side of a wall. Then its
/// keyframes that show nothing new cease to be keyframes: they and what hangs on them hang on the
/// one that shows most of what they do. So a robot that goes its rounds for hours keeps a map of
/// the size of what it saw, as in reduced pose graphs [Johannsson 2013]. Returns the track as the
/// file has it now.
Track add_section(MapFile& file, const Track& track, const std::string& stage,
                  const Options& options, const Run& run);

/// Overlap of the keyframes at the present poses, and the registrations that it suggests. Those of
/// earlier rounds stay: where they ended does not depend on the poses they were started from.
void find_overlap(MapFile& file, const Track& track, const std::string& stage,
                  const Options& options, const Run& run);

/// Cuts the keyframes into submaps, optimizes each on its own, links them and places them in the
/// world.
void make_submaps(MapFile& file, const Track& track, const std::string& stage,
                  const Options& options, const Run& run);

/// Searches for loop closures. Where there are new ones, the next round starts from the poses that
/// they give; otherwise all keyframes are refined together, and the rounds end, as stage kSettled,
/// if that moves none of them by much or if this was the last round.
void close_loops(MapFile& file, const std::string& stage, bool last_round, const Run& run);

/// The last word on a log of landmarks: all its observations, as they were measured, optimized
/// together from the poses of the map. The keyframes carry sightings of the observations that hang
/// on them by odometry alone; here nothing is carried.
void refine_observations(MapFile& file, const std::string& stage, const Run& run);

}  // namespace hmt::submap
