// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "recording.hpp"

namespace hmt::submap {

/// The topics of a recording in the order in which they were met, each once, however many
/// publishers it has.
class TopicTable {
 public:
  /// Where the topic stands; a new one is added at the end.
  size_t add(const RecordedTopic& topic) {
    const auto [place, is_new] =
        places_.try_emplace({topic.name, topic.type, topic.wire}, topics_.size());
    if (is_new) topics_.push_back(topic);
    return place->second;
  }
  const std::vector<RecordedTopic>& topics() const { return topics_; }

 private:
  std::vector<RecordedTopic> topics_;
  std::map<std::tuple<std::string, std::string, std::optional<Wire>>, size_t> places_;
};

}  // namespace hmt::submap
