// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "recording_plan.hpp"

#include <algorithm>
#include <array>

namespace hmt::submap {
namespace {

constexpr int64_t kScansAhead = 200;
constexpr uint64_t kBytesAhead = uint64_t{64} << 20;
/// Stamps of one clock are received later by much less.
constexpr int64_t kOneClock_ns = 1'000'000'000;
constexpr size_t kMaxDelays = 1000;
const std::string kNone = "none";
const std::array<std::string, 2> kRobotFrames = {"base_link", "base_footprint"};

/// What the first part of a recording shows of one topic.
struct SeenTopic {
  RecordedTopic topic;
  int64_t messages = 0;
  std::string frame;               ///< of its first message
  std::string child_frame;         ///< the same, of odometry
  std::vector<int64_t> delays_ns;  ///< from stamp to receipt
};

/// "odom" and what it is called with a robot's name before it, or by older drivers.
bool is_odometry_frame(const std::string& frame) {
  const std::string name = frame.substr(frame.rfind('/') + 1);
  return name == "odom" || name == "odom_combined";
}

std::optional<int64_t> median(std::vector<int64_t> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Looks at the first part of a recording.
class Survey {
 public:
  Survey(std::unique_ptr<Recording> recording, bool needs_odometry)
      : recording_(std::move(recording)), has_odometry_(!needs_odometry) {
    while (!has_enough()) {
      const auto message = recording_->next();
      if (!message) break;
      add(*message);
    }
    // Topics without a message in this part.
    seen_.resize(recording_->topics().size());
    for (size_t k = 0; k < seen_.size(); ++k) seen_[k].topic = recording_->topics()[k];
  }

  const std::vector<SeenTopic>& seen() const { return seen_; }
  const TransformTree& transforms() const { return transforms_; }

 private:
  bool has_enough() const {
    return (most_scans_ >= kScansAhead || (most_scans_ > 0 && bytes_ > kBytesAhead)) &&
           has_odometry_;
  }

  void add(const RecordedMessage& message) {
    if (seen_.size() <= message.topic) seen_.resize(message.topic + 1);
    SeenTopic& seen = seen_[message.topic];
    seen.topic = recording_->topics()[message.topic];
    ++seen.messages;
    bytes_ += message.data.size();
    try {
      look_into(message, seen);
    } catch (const MessageError&) {
      // Counted when the log is read.
    }
  }

  void look_into(const RecordedMessage& message, SeenTopic& seen) {
    const MessageKind kind = seen.topic.kind();
    if (kind == MessageKind::other) return;
    WireReader in(message.data, *seen.topic.wire);
    if (kind == MessageKind::transforms) {
      add_transforms(read_transforms(in), message.received_ns, seen);
      return;
    }
    const MessageHeader header = read_header(in);
    if (seen.frame.empty()) seen.frame = header.frame;
    if (kind == MessageKind::odometry) {
      has_odometry_ = true;
      if (seen.child_frame.empty()) seen.child_frame = frame_name(in.text());
    } else if (is_range_data(kind)) {
      most_scans_ = std::max(most_scans_, seen.messages);
    }
    add_delay(header.stamp_ns, message.received_ns, seen);
  }

  void add_transforms(const TransformMessages& message, int64_t received_ns, SeenTopic& seen) {
    for (const TransformMessage& transform : message.transforms) {
      transforms_.add(transform, is_static_topic(seen.topic.name));
      if (!is_odometry_frame(transform.header.frame)) continue;
      has_odometry_ = true;
      add_delay(transform.header.stamp_ns, received_ns, seen);
    }
  }

  static void add_delay(int64_t stamp_ns, int64_t received_ns, SeenTopic& seen) {
    if (stamp_ns != 0 && seen.delays_ns.size() < kMaxDelays)
      seen.delays_ns.push_back(static_cast<int64_t>(static_cast<uint64_t>(received_ns) -
                                                    static_cast<uint64_t>(stamp_ns)));
  }

  std::unique_ptr<Recording> recording_;
  std::vector<SeenTopic> seen_;
  TransformTree transforms_;
  int64_t most_scans_ = 0;
  bool has_odometry_ = false;
  uint64_t bytes_ = 0;
};

using Topics = std::vector<const SeenTopic*>;

std::string list_of(const Topics& topics) {
  constexpr size_t kMost = 30;
  std::string text;
  for (size_t k = 0; k < std::min(kMost, topics.size()); ++k)
    text += (k == 0 ? "" : ", ") + topics[k]->topic.name + " (" + topics[k]->topic.type + ")";
  if (topics.size() > kMost) text += " and " + std::to_string(topics.size() - kMost) + " more";
  return text.empty() ? "none" : text;
}

/// Chooses the topics of a recording.
class Choice {
 public:
  Choice(const std::filesystem::path& path, const LogOptions& options, const Survey& survey)
      : path_(path), options_(options), survey_(survey) {}

  RecordingPlan make() {
    plan_.transforms = survey_.transforms();
    const Topics landmarks = choose_landmarks();
    const Topics scans = choose_scans(!landmarks.empty());
    const Topics& first = scans.empty() ? landmarks : scans;
    const SeenTopic* odometry = options_.odometry_topic == kNone
                                    ? do_without_odometry(*first.front(), !landmarks.empty())
                                    : choose_odometry(*first.front());
    choose_imu();
    for (const SeenTopic* scan : first) {
      if (!scans.empty()) plan_.scan_topics.push_back(scan->topic.name);
      if (scan->topic.kind() == MessageKind::cloud) plan_.space = Space::se3;
      if (odometry != nullptr) compare_clocks(*scan, *odometry);
    }
    return std::move(plan_);
  }

 private:
  template <typename Kind>
  Topics of_kind(const Kind& is_wanted) const {
    Topics topics;
    for (const SeenTopic& seen : survey_.seen())
      if (is_wanted(seen.topic.kind())) topics.push_back(&seen);
    return topics;
  }

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(path_.string() + ": " + reason);
  }

  /// The topic of that name; throws if it is not there.
  const SeenTopic* named(const Topics& topics, const std::string& name, const char* what) const {
    const auto place = std::ranges::find(topics, name, [](auto* seen) { return seen->topic.name; });
    if (place == topics.end())
      refuse("no " + std::string(what) + " topic " + name + "; there are: " + list_of(topics));
    return *place;
  }

  /// Those with messages, or that were named: markers may come up later than the survey looks.
  Topics choose_landmarks() {
    plan_.landmark_topics = options_.landmark_topics;
    const Topics all = of_kind(is_landmark_data);
    Topics chosen;
    for (const std::string& name : plan_.landmark_topics)
      if (name != kNone) chosen.push_back(named(all, name, "landmark"));
    std::ranges::copy_if(all, std::back_inserter(chosen), [&](const SeenTopic* seen) {
      return plan_.landmark_topics.empty() && seen->messages > 0 &&
             takes_landmarks(seen->topic.name, seen->topic.kind(), {});
    });
    return chosen;
  }

  /// Empty where there are none, but landmarks.
  Topics choose_scans(bool has_landmarks) const {
    const Topics all = of_kind(is_range_data);
    Topics chosen;
    for (const std::string& name : options_.scan_topics) chosen.push_back(named(all, name, "scan"));
    if (!chosen.empty()) return chosen;
    std::ranges::copy_if(all, std::back_inserter(chosen), [](auto* s) { return s->messages > 0; });
    if (chosen.size() == 1 || (chosen.empty() && has_landmarks)) return chosen;
    if (chosen.empty())
      refuse("no scans (LaserScan, MultiEchoLaserScan or PointCloud2) in this recording; topics: " +
             list_of(of_kind([](MessageKind) { return true; })));
    refuse("scans on several topics; choose with --scan-topic: " + list_of(chosen));
  }

  const SeenTopic* choose_odometry(const SeenTopic& scan) {
    const Topics all = of_kind([](MessageKind kind) { return kind == MessageKind::odometry; });
    const Topics trees = of_kind([](MessageKind kind) { return kind == MessageKind::transforms; });
    const std::string& wanted = options_.odometry_topic;
    if (wanted.empty()
            ? std::ranges::none_of(all, &has_messages)
            : std::ranges::any_of(trees, [&](auto* s) { return s->topic.name == wanted; }))
      return choose_transforms(trees, scan);
    if (!wanted.empty()) return use_odometry(*named(all, wanted, "odometry"), scan);
    if (std::ranges::count_if(all, &has_messages) > 1)
      refuse("odometry on several topics; choose with --odom-topic: " + list_of(all));
    return use_odometry(**std::ranges::find_if(all, &has_messages), scan);
  }

  /// The scans alone tell how the robot moves; null.
  const SeenTopic* do_without_odometry(const SeenTopic& scan, bool has_landmarks) {
    if (has_landmarks)
      refuse("landmarks have to be carried to the scans next to them by odometry, which is none");
    plan_.has_odometry = false;
    find_robot_frame(scan);
    if (plan_.robot_frame.empty()) plan_.robot_frame = scan.frame;
    return nullptr;
  }

  static bool has_messages(const SeenTopic* seen) { return seen->messages > 0; }

  const SeenTopic* use_odometry(const SeenTopic& odometry, const SeenTopic& scan) {
    plan_.odometry_topic = odometry.topic.name;
    plan_.robot_frame = odometry.child_frame;
    find_robot_frame(scan);
    return &odometry;
  }

  /// Some drivers leave the frame empty or name one that no transform knows.
  void find_robot_frame(const SeenTopic& scan) {
    const auto reaches_scan = [&](const std::string& frame) {
      return plan_.transforms.find(frame, scan.frame, 0).has_value();
    };
    if (reaches_scan(plan_.robot_frame)) return;
    const auto other = std::ranges::find_if(kRobotFrames, reaches_scan);
    if (other != kRobotFrames.end()) plan_.robot_frame = *other;
  }

  /// The odometry is the transform from a frame `odom` above the scan's frame to its child.
  const SeenTopic* choose_transforms(const Topics& trees, const SeenTopic& scan) {
    const auto path = plan_.transforms.ancestry(scan.frame);
    const auto odom = std::ranges::find_if(path, is_odometry_frame);
    if (odom == path.end() || odom == path.begin())
      refuse(
          "no odometry: neither messages of nav_msgs/Odometry nor a transform from a frame odom "
          "towards the scan's frame " +
          scan.frame + "; --odom-topic none makes a map of the scans alone");
    plan_.odom_frame = *odom;
    plan_.robot_frame = *std::prev(odom);
    return *std::ranges::max_element(trees, {}, [](auto* s) { return s->delays_ns.size(); });
  }

  /// It only betters what the odometry says, so no one is asked which it shall be.
  void choose_imu() {
    Topics all = of_kind([](MessageKind kind) { return kind == MessageKind::imu; });
    std::erase_if(all, [](auto* seen) { return seen->messages == 0; });
    if (all.size() == 1) plan_.imu_topic = all.front()->topic.name;
  }

  void compare_clocks(const SeenTopic& scan, const SeenTopic& odometry) {
    const auto a = median(scan.delays_ns);
    const auto b = median(odometry.delays_ns);
    if (a && b && stamp_distance(*a, *b) > static_cast<uint64_t>(kOneClock_ns))
      plan_.uses_time_of_receipt = true;
  }

  const std::filesystem::path& path_;
  const LogOptions& options_;
  const Survey& survey_;
  RecordingPlan plan_;
};

}  // namespace

bool takes_landmarks(const std::string& topic, MessageKind kind,
                     const std::vector<std::string>& chosen) {
  if (!is_landmark_data(kind)) return false;
  // Detections may be of anything, people too.
  if (chosen.empty()) return kind != MessageKind::detections;
  return topic != kNone && std::ranges::find(chosen, topic) != chosen.end();
}

RecordingPlan plan_recording(const std::filesystem::path& path, const LogOptions& options) {
  const Survey survey(open_recording(path, options.further_parts), options.odometry_topic != kNone);
  return Choice(path, options, survey).make();
}

}  // namespace hmt::submap
