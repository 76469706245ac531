// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "hmt/submap/log/log_reader.hpp"
#include "line_source.hpp"

namespace hmt::submap {

/// Counts a harmless peculiarity, and where the first of its kind was.
void note(LogReport& report, const std::string& what, const std::string& place);
/// Counts what was left out, and where the first of its kind was.
void lose(LogReport& report, const std::string& what, const std::string& place);

/// The lines of a text log that hold a record: without comments and empty lines, and without what
/// the end of a damaged archive leaves of a line.
class RecordLines {
 public:
  /// `report` gets the damage and must outlive it.
  RecordLines(const std::filesystem::path& path, LogReport& report);

  /// The next record, valid until the next call; nothing at the end.
  std::optional<std::string_view> next();
  /// Calls `parse` with the next record; one that throws std::invalid_argument is left out as a
  /// loss "damaged NAME records" and the next one is tried. False at the end.
  bool read(const std::string& name, const std::function<void(std::string_view)>& parse);
  const LineSource& source() const { return lines_; }

 private:
  LineSource lines_;
  LogReport* report_;
};

}  // namespace hmt::submap
