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

/// Adds what another reader counted.
inline void add_report(const LogReport& other, LogReport& report) {
  report.observations += other.observations;
  report.odometry_records += other.odometry_records;
  for (const auto& [what, times] : other.notes) report.notes[what] += times;
  for (const auto& [what, times] : other.losses) report.losses[what] += times;
  report.first_places.insert(other.first_places.begin(), other.first_places.end());
}

/// For the end of an error text: a loss and where it was first, or nothing where none was counted.
inline std::string first_loss(const LogReport& report) {
  if (report.losses.empty()) return {};
  const std::string& what = report.losses.begin()->first;
  return "; first loss: " + report.first_places.at(what) + ": " + what;
}

}  // namespace hmt::submap
