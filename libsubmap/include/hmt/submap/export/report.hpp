// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "hmt/submap/export/occupancy_image.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::submap {

/// One static HTML page, without scripts or links to other files: figures, a drawing of walls,
/// trajectory, submaps and links, and tables of submaps, links and loop closures. `walls` may be
/// null.
std::string report_html(const HybridMap& map, const MapOrigin& origin, const OccupancyImage* walls);

/// The drawing alone, as SVG: x to the right, y up.
std::string map_svg(const HybridMap& map, const OccupancyImage* walls);

}  // namespace hmt::submap
