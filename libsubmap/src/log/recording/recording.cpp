// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "recording.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "../line_source.hpp"
#include "../natural_order.hpp"
#include "../report_book.hpp"
#include "mcap_file.hpp"
#include "ros1_bag.hpp"
#include "sqlite_bag.hpp"
#include "topic_table.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

template <typename Format>
std::unique_ptr<Recording> make(const fs::path& path) {
  return std::make_unique<Format>(path);
}

struct Format {
  bool (*begins_with)(std::string_view head);
  std::unique_ptr<Recording> (*open)(const fs::path& path);
};

constexpr std::array kFormats = {Format{Ros1Bag::begins_with, make<Ros1Bag>},
                                 Format{McapFile::begins_with, make<McapFile>},
                                 Format{SqliteBag::begins_with, make<SqliteBag>}};

/// A file itself, of a folder its files.
std::vector<fs::path> parts_of(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  return files_in_natural_order(path, {".bag", ".mcap", ".db3"});
}

std::unique_ptr<Recording> open_file(const fs::path& path) {
  const std::string head = first_bytes(path);
  for (const Format& format : kFormats)
    if (format.begins_with(head)) return format.open(path);
  throw InputError(path.string() + ": no ROS 1 bag, MCAP file or ROS 2 sqlite3 bag");
}

/// The files of a split recording, one after the other.
class SplitRecording : public Recording {
 public:
  explicit SplitRecording(std::vector<fs::path> parts) : parts_(std::move(parts)) { open_next(); }

  std::optional<RecordedMessage> next() override {
    while (part_) {
      auto message = part_->next();
      if (message) {
        message->topic = own_topic(message->topic);
        return message;
      }
      close_part();
      while (!part_ && next_part_ < parts_.size()) open_next_or_lose();
    }
    return std::nullopt;
  }
  const std::vector<RecordedTopic>& topics() const override { return topics_.topics(); }
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return bytes_before_ + (part_ ? part_->bytes_read() : 0); }

 private:
  void open_next() {
    part_ = open_file(parts_[next_part_++]);
    topic_of_part_.clear();
    for (size_t k = 0; k < part_->topics().size(); ++k) own_topic(k);
  }

  void open_next_or_lose() {
    try {
      open_next();
    } catch (const InputError& error) {
      add_loss(report_, "parts that cannot be read", error.what());
    }
  }

  /// Topics are the same in all parts if name, type and encoding are.
  size_t own_topic(size_t topic) {
    const auto [place, is_new] = topic_of_part_.try_emplace(topic, 0);
    if (!is_new) return place->second;
    place->second = topics_.add(part_->topics()[topic]);
    return place->second;
  }

  void close_part() {
    add_report(part_->report(), report_);
    bytes_before_ += part_->bytes_read();
    part_.reset();
  }

  std::vector<fs::path> parts_;
  size_t next_part_ = 0;
  std::unique_ptr<Recording> part_;
  std::map<size_t, size_t> topic_of_part_;
  TopicTable topics_;
  LogReport report_;
  int64_t bytes_before_ = 0;
};

}  // namespace

bool is_recording(const fs::path& path, std::string_view head) {
  if (fs::is_directory(path)) return !parts_of(path).empty();
  return std::ranges::any_of(kFormats, [&](const Format& f) { return f.begins_with(head); });
}

std::unique_ptr<Recording> open_recording(const fs::path& path,
                                          const std::vector<fs::path>& further_parts) {
  if (!fs::is_directory(path) && further_parts.empty()) return open_file(path);
  std::vector<fs::path> parts = parts_of(path);
  for (const fs::path& further : further_parts)
    std::ranges::move(parts_of(further), std::back_inserter(parts));
  return std::make_unique<SplitRecording>(std::move(parts));
}

}  // namespace hmt::submap
