// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// Throws InputError naming an option that is out of range.
void validate(const TrackOptions& options);

}  // namespace hmt::submap
