// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "record_lines.hpp"

#include <stdexcept>

#include "text_fields.hpp"

namespace hmt::submap {

void note(LogReport& report, const std::string& what, const std::string& place) {
  ++report.notes[what];
  report.first_places.try_emplace(what, place);
}

void lose(LogReport& report, const std::string& what, const std::string& place) {
  ++report.losses[what];
  report.first_places.try_emplace(what, place);
}

RecordLines::RecordLines(const std::filesystem::path& path, LogReport& report)
    : lines_(path), report_(&report) {}

std::optional<std::string_view> RecordLines::next() {
  while (const auto line = lines_.next()) {
    if (!lines_.line_is_complete() && !lines_.damage().empty()) continue;
    const std::string_view record = without_comment(*line);
    if (!record.empty()) return record;
  }
  if (!lines_.damage().empty() && !report_->losses.contains(lines_.damage()))
    lose(*report_, lines_.damage(), lines_.place());
  return std::nullopt;
}

bool RecordLines::read(const std::string& name,
                       const std::function<void(std::string_view)>& parse) {
  while (const auto record = next()) {
    try {
      parse(*record);
      return true;
    } catch (const std::invalid_argument& error) {
      lose(*report_, "damaged " + name + " records: " + error.what(), lines_.place());
    }
  }
  return false;
}

}  // namespace hmt::submap
