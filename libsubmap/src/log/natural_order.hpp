// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace hmt::submap {

/// Whether name `a` comes before `b`: numbers in them by value, so that "9.pcd" < "10.pcd"; all
/// else by its bytes. A strict order: names that differ are never equal.
bool natural_less(std::string_view a, std::string_view b);

/// The files directly in a folder whose names end in one of these, in natural order.
std::vector<std::filesystem::path> files_in_natural_order(
    const std::filesystem::path& folder, std::initializer_list<std::string_view> extensions);

}  // namespace hmt::submap
