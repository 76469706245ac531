// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/log/log_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

namespace hmt::submap {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A log in memory.
class MemoryLog : public LogReader {
 public:
  explicit MemoryLog(std::vector<Observation> observations)
      : observations_(std::move(observations)) {}
  std::optional<Observation> next() override {
    if (next_ == observations_.size()) return std::nullopt;
    ++report_.observations;
    return observations_[next_++];
  }
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return static_cast<int64_t>(next_); }
  int64_t bytes_total() const override { return static_cast<int64_t>(observations_.size()); }
  Space space() const override { return Space::se2; }

  LogReport report_;

 private:
  std::vector<Observation> observations_;
  size_t next_ = 0;
};

/// A robot that drives 0.5 m ahead each second; each reading has three points and a miss.
std::vector<Observation> drive(int64_t count) {
  std::vector<Observation> observations;
  for (int64_t i = 0; i < count; ++i) {
    const auto k = static_cast<double>(i);
    Reading reading;
    reading.T_robot_sensor = Pose::planar(0.1, 0, 0);
    reading.max_range_m = 80;
    reading.beam_step_rad = 0.01;
    reading.points_sensor.assign(3, {1, 2, 0});
    reading.misses_sensor.assign(1, {1, 0, 0});
    observations.push_back({i, 100 + k, Pose::planar(0.5 * k, 0, 0), std::nullopt, {reading}, {}});
  }
  return observations;
}

LogSummary summarize(const std::vector<Observation>& observations) {
  MemoryLog log(observations);
  return summarize_log(log, submap::Run{});
}

TEST(LogSummary, OfAGoodLogHasNoFindings) {
  const LogSummary summary = summarize(drive(21));
  EXPECT_THAT(summary.findings, IsEmpty());
  EXPECT_EQ(summary.report.observations, 21);
  EXPECT_EQ(summary.first_stamp_s, 100);
  EXPECT_EQ(summary.last_stamp_s, 120);
  EXPECT_EQ(summary.period_s, 1);
  EXPECT_NEAR(summary.path_m, 10, 1e-12);
  ASSERT_EQ(summary.sensors.size(), 1u);
  EXPECT_EQ(summary.sensors[0].readings, 21);
  EXPECT_EQ(summary.sensors[0].points, 63);
  EXPECT_EQ(summary.sensors[0].misses, 21);
  EXPECT_EQ(summary.sensors[0].max_range_m, 80);
}

TEST(LogSummary, FindsGapsOfTenPeriods) {
  auto observations = drive(21);
  for (size_t i = 10; i < 21; ++i) observations[i].stamp_s += 8.9;
  EXPECT_EQ(summarize(observations).gaps, 0);
  for (size_t i = 10; i < 21; ++i) observations[i].stamp_s += 0.2;
  const LogSummary summary = summarize(observations);
  EXPECT_EQ(summary.gaps, 1);
  EXPECT_THAT(summary.findings, Contains(HasSubstr("1 gaps in time, the longest of 10.1 s")));
}

TEST(LogSummary, FindsAJumpOfTheOdometryAndLeavesItOutOfThePath) {
  auto observations = drive(21);
  for (size_t i = 10; i < 21; ++i) observations[i].T_odom_robot.translation.y() += 100;
  const LogSummary summary = summarize(observations);
  EXPECT_EQ(summary.odometry_jumps, 1);
  EXPECT_EQ(summary.first_jump, 10);
  EXPECT_NEAR(summary.largest_jump_m, 100, 0.01);
  EXPECT_NEAR(summary.path_m, 9.5, 1e-12);
  EXPECT_THAT(summary.findings, Contains(HasSubstr("jumps of the odometry")));
}

TEST(LogSummary, FindsChangesOfTheMount) {
  auto observations = drive(21);
  for (size_t i = 10; i < 15; ++i)
    observations[i].readings[0].T_robot_sensor = Pose::planar(0.2, 0, 0);
  const LogSummary summary = summarize(observations);
  EXPECT_EQ(summary.sensors[0].mount_changes, 2);
  EXPECT_THAT(summary.findings, Contains(HasSubstr("its mount changes 2 times")));
}

TEST(LogSummary, FindsSensorsThatSeeLittle) {
  auto observations = drive(4);
  observations[3].readings[0].points_sensor.clear();
  EXPECT_THAT(summarize(observations).findings, Contains(HasSubstr("25 % of the readings")));
  for (Observation& observation : observations) observation.readings[0].points_sensor.clear();
  EXPECT_THAT(summarize(observations).findings, Contains(HasSubstr("no points at all")));
}

TEST(LogSummary, TellsLossesAndNotesOfTheReader) {
  MemoryLog log(drive(3));
  log.report_.losses["damaged lines"] = 2;
  log.report_.notes["stamps repeated"] = 1;
  log.report_.first_places = {{"damaged lines", "a:7"}, {"stamps repeated", "a:9"}};
  EXPECT_THAT(summarize_log(log, submap::Run{}).findings,
              testing::ElementsAre("loss: damaged lines (2, first at a:7)",
                                   "stamps repeated (1, first at a:9)"));
}

TEST(LogSummary, FindsAClockThatStandsStill) {
  auto observations = drive(3);
  for (Observation& observation : observations) observation.stamp_s = 5;
  EXPECT_THAT(summarize(observations).findings, Contains(HasSubstr("all stamps are equal")));
}

TEST(LogSummary, StopsWhenAsked) {
  MemoryLog log(drive(3));
  submap::Run run;
  run.stop = [] { return true; };
  EXPECT_THROW(summarize_log(log, run), Interrupted);
}

}  // namespace
}  // namespace hmt::submap
