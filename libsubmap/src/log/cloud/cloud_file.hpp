// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "point_layout.hpp"

namespace hmt::submap {

// Files of one cloud each. Their headers are believed only as far as the file is long, so memory is
// bounded by the file. Each read_x gives the points that are there, with `damage` where fewer are
// there than told, and throws InputError with the reason for a file without usable points.

/// Reads a cloud by the end of the file's name: .pcd, .ply or .bin.
CloudPoints read_cloud_file(const std::filesystem::path& path);

/// Point Cloud Data of PCL, version 0.6 and 0.7: ascii, binary and binary_compressed. The count is
/// POINTS, or WIDTH x HEIGHT where that is absent. VIEWPOINT is not used: writers do not agree on
/// whether the points are seen from there or already moved.
CloudPoints read_pcd(std::string_view file);
/// Polygon files with an element `vertex` in front: ascii and binary of either byte order.
CloudPoints read_ply(std::string_view file);
/// KITTI's scans: x, y, z and reflectance as little-endian floats.
CloudPoints read_kitti_bin(std::string_view file);

}  // namespace hmt::submap
