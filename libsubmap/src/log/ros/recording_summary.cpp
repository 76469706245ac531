// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/log/recording_summary.hpp"

#include <algorithm>
#include <set>

#include "../file_bytes.hpp"
#include "../line_source.hpp"
#include "../recording/recording.hpp"
#include "../report_book.hpp"

namespace hmt::submap {
namespace {

constexpr size_t kMaxFrames = 100;

/// What is gathered of one topic.
struct TopicCount {
  int64_t messages = 0;
  int64_t first_ns = 0;
  int64_t last_ns = 0;
  std::set<std::string> frames;

  void add_time(int64_t received_ns) {
    first_ns = messages == 0 ? received_ns : std::min(first_ns, received_ns);
    last_ns = messages == 0 ? received_ns : std::max(last_ns, received_ns);
    ++messages;
  }
  void add_frame(const std::string& frame) {
    if (frames.size() < kMaxFrames) frames.insert(frame);
  }
};

void add_frames(const RecordedTopic& topic, std::string_view data, TopicCount& count) {
  const MessageKind kind = topic.kind();
  if (kind == MessageKind::other) return;
  WireReader in(data, *topic.wire);
  if (kind == MessageKind::transforms) {
    for (const TransformMessage& transform : read_transforms(in).transforms)
      count.add_frame(transform.header.frame + " -> " + transform.child_frame);
  } else {
    const MessageHeader header = read_header(in);
    count.add_frame(kind == MessageKind::odometry ? header.frame + " -> " + frame_name(in.text())
                                                  : header.frame);
  }
}

TopicSummary summary_of(const RecordedTopic& topic, const TopicCount& count) {
  TopicSummary summary;
  summary.name = topic.name;
  summary.type = topic.type;
  summary.messages = count.messages;
  summary.first_s = static_cast<double>(count.first_ns) * 1e-9;
  summary.last_s = static_cast<double>(count.last_ns) * 1e-9;
  if (summary.last_s > summary.first_s)
    summary.rate_hz = static_cast<double>(count.messages - 1) / (summary.last_s - summary.first_s);
  summary.frames.assign(count.frames.begin(), count.frames.end());
  return summary;
}

bool is_recording_path(const std::filesystem::path& path) {
  return is_recording(path, std::filesystem::is_directory(path) ? "" : first_bytes(path));
}

}  // namespace

std::optional<RecordingSummary> summarize_recording(const std::filesystem::path& path,
                                                    const Run& run) {
  if (!is_recording_path(path)) return std::nullopt;
  const auto recording = open_recording(path);
  const auto bytes_total = static_cast<double>(file_bytes(path));
  std::vector<TopicCount> counts;
  RecordingSummary summary;
  while (const auto message = recording->next()) {
    if (run.stop_requested()) throw Interrupted{};
    if (counts.size() <= message->topic) counts.resize(message->topic + 1);
    const RecordedTopic& topic = recording->topics()[message->topic];
    counts[message->topic].add_time(message->received_ns);
    try {
      add_frames(topic, message->data, counts[message->topic]);
    } catch (const MessageError& error) {
      add_loss(summary.report, "damaged messages on " + topic.name + ": " + error.what(),
               path.string());
    }
    run.report({"read", static_cast<double>(recording->bytes_read()), bytes_total});
  }
  counts.resize(recording->topics().size());
  for (size_t k = 0; k < counts.size(); ++k)
    summary.topics.push_back(summary_of(recording->topics()[k], counts[k]));
  std::ranges::stable_sort(summary.topics, {}, &TopicSummary::name);
  summary.report.notes.insert(recording->report().notes.begin(), recording->report().notes.end());
  summary.report.losses.insert(recording->report().losses.begin(),
                               recording->report().losses.end());
  summary.report.first_places.insert(recording->report().first_places.begin(),
                                     recording->report().first_places.end());
  return summary;
}

}  // namespace hmt::submap
