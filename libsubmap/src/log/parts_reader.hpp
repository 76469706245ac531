// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "hmt/submap/log/log_reader.hpp"

namespace hmt::submap {

/// The parts of a split log, one after the other, as one log.
class PartsReader : public LogReader {
 public:
  using Open = std::function<std::unique_ptr<LogReader>(const std::filesystem::path&)>;

  /// At least one part. Throws InputError as `open` does for the first; later ones that cannot be
  /// opened are losses.
  PartsReader(std::vector<std::filesystem::path> parts, Open open);

  std::optional<Observation> next() override;
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return bytes_before_ + part_->bytes_read(); }
  int64_t bytes_total() const override { return bytes_total_; }
  Space space() const override { return part_->space(); }
  bool has_landmarks_only() const override { return part_->has_landmarks_only(); }

 private:
  bool open_next();
  LogReport report_of_all() const;

  std::vector<std::filesystem::path> parts_;
  Open open_;
  std::unique_ptr<LogReader> part_;
  size_t next_part_ = 1;
  LogReport closed_;  ///< of the parts before
  LogReport report_;  ///< of all so far
  double last_stamp_s_ = 0;
  int64_t bytes_before_ = 0;
  int64_t bytes_total_ = 0;
};

}  // namespace hmt::submap
