// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "../map/scan_caster.hpp"
#include "hmt/submap/export/occupancy_image.hpp"

namespace hmt::submap {

/// The parts of a cloud's beams that run between the heights of the band over the origin of the
/// robot, laid down onto the plane z = 0; ends in cells. A beam hits where its point lies inside.
std::vector<Beam> beams_in_band(const Reading& cloud, const Pose& T_frame_robot,
                                const HeightBand& band, double resolution_m);

}  // namespace hmt::submap
