// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hmt::paper {

/// Something that the paper reports, and whether it came out here.
struct Claim {
  std::string text;
  bool holds = false;
};

/// Each writes its figures (SVG) and their numbers (CSV) to the folder, which must exist, and
/// returns what of the paper they show.

/// Fig. 5: 14 scans in three rooms.
std::vector<Claim> draw_three_rooms(const std::filesystem::path& folder);

/// Fig. 8: information loss along a straight path, over that many runs; `sensitivity` also varies
/// each parameter that the paper leaves open (a run takes some 0.1 s for each value).
std::vector<Claim> draw_straight_path(const std::filesystem::path& folder, int runs,
                                      bool sensitivity, int threads);

/// Fig. 9 with a simulated robot of two lasers and a stereo camera, in worlds of `hmtmap simulate`.
std::vector<Claim> draw_sensors(const std::filesystem::path& folder,
                                const std::vector<std::string>& worlds, int threads);

/// Fig. 9 with a real log (NAME.clf.bz2 and NAME.keyframes.tum in `data`) whose field of view is
/// cut.
std::vector<Claim> draw_real_log(const std::filesystem::path& folder,
                                 const std::filesystem::path& data, const std::string& name,
                                 int threads);

}  // namespace hmt::paper
