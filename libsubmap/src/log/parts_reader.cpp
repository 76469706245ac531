// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "parts_reader.hpp"

#include <utility>

#include "file_bytes.hpp"
#include "hmt/graph/input_error.hpp"
#include "report_book.hpp"

namespace hmt::submap {

PartsReader::PartsReader(std::vector<std::filesystem::path> parts, Open open)
    : parts_(std::move(parts)), open_(std::move(open)), part_(open_(parts_.front())) {
  for (const std::filesystem::path& part : parts_) bytes_total_ += file_bytes(part);
}

std::optional<Observation> PartsReader::next() {
  std::optional<Observation> observation = part_->next();
  bool begins_part = false;
  while (!observation && open_next()) {
    begins_part = true;
    observation = part_->next();
  }
  if (begins_part && observation && observation->stamp_s < last_stamp_s_)
    add_note(closed_, "stamps run backwards", parts_[next_part_ - 1].string());
  report_ = report_of_all();
  if (!observation) return std::nullopt;
  last_stamp_s_ = observation->stamp_s;
  observation->index = report_.observations - 1;
  return observation;
}

bool PartsReader::open_next() {
  while (next_part_ < parts_.size()) {
    const std::filesystem::path& path = parts_[next_part_++];
    try {
      std::unique_ptr<LogReader> part = open_(path);
      closed_ = report_of_all();
      bytes_before_ += part_->bytes_read();
      part_ = std::move(part);
      return true;
    } catch (const graph::InputError& error) {
      add_loss(closed_, "parts that cannot be read", error.what());
      bytes_before_ += file_bytes(path);
    }
  }
  return false;
}

LogReport PartsReader::report_of_all() const {
  LogReport report = closed_;
  add_report(part_->report(), report);
  return report;
}

}  // namespace hmt::submap
