// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "hmt/submap/log/log_reader.hpp"

namespace hmt::submap {

/// Counts what a reader found odd (notes) and could not use (losses), each with its first place.
inline void add_note(LogReport& report, const std::string& what, const std::string& place,
                     int64_t times = 1) {
  if (times == 0) return;
  report.notes[what] += times;
  report.first_places.try_emplace(what, place);
}
inline void add_loss(LogReport& report, const std::string& what, const std::string& place,
                     int64_t times = 1) {
  if (times == 0) return;
  report.losses[what] += times;
  report.first_places.try_emplace(what, place);
}

}  // namespace hmt::submap
