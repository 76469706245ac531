// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hmt/submap/log/log_reader.hpp"
#include "real_data.hpp"

namespace hmt::submap {
namespace {

struct RealLog {
  const char* name;
  int64_t scans;
  size_t beams;
  double beam_step_deg;
  double laser_x_m;
  double first_stamp_s;
};

void PrintTo(const RealLog& log, std::ostream* out) {
  *out << log.name;
}

class RealLogs : public testing::TestWithParam<RealLog> {};

TEST_P(RealLogs, ReadWholeWithTheirGeometry) {
  const RealLog& log = GetParam();
  const std::string file = std::string("laser2d/") + log.name + ".clf.bz2";
  HMT_REQUIRE_REAL_DATA(file);
  const auto reader = open_log(test::data_dir() / file);
  int64_t count = 0;
  int64_t misses = 0;
  while (const auto observation = reader->next()) {
    if (count == 0) {
      EXPECT_NEAR(observation->stamp_s, log.first_stamp_s, 1e-6);
    }
    EXPECT_EQ(observation->index, count++);
    ASSERT_EQ(observation->readings.size(), 1u);
    const Reading& reading = observation->readings.front();
    ASSERT_EQ(reading.points_sensor.size() + reading.misses_sensor.size(), log.beams);
    EXPECT_NEAR(reading.beam_step_rad, log.beam_step_deg * std::numbers::pi / 180, 1e-12);
    EXPECT_NEAR(reading.T_robot_sensor.translation.x(), log.laser_x_m, 2e-6);
    EXPECT_NEAR(reading.T_robot_sensor.translation.y(), 0, 2e-6);
    misses += static_cast<int64_t>(reading.misses_sensor.size());
    for (const Eigen::Vector3f& p_sensor : reading.points_sensor) ASSERT_LT(p_sensor.norm(), 75);
  }
  EXPECT_EQ(count, log.scans);
  EXPECT_GT(misses, 0);
  EXPECT_EQ(reader->report().observations, log.scans);
  EXPECT_TRUE(reader->report().losses.empty());
  EXPECT_EQ(reader->bytes_read(), reader->bytes_total());
  EXPECT_EQ(reader->space(), Space::se2);
}

INSTANTIATE_TEST_SUITE_P(Logs, RealLogs,
                         testing::Values(RealLog{"intel", 13631, 180, 1, 0, 976052857.337530},
                                         RealLog{"fr079", 4934, 360, 0.5, -0.04, 1211.520329},
                                         RealLog{"mit-csail", 1988, 361, 0.5, 0, 1134864629.895182},
                                         RealLog{"fr101", 292, 360, 0.5, 0, 158.415},
                                         RealLog{"seattle", 241, 361, 0.5, 0, 1244.18}),
                         [](const auto& param_info) {
                           std::string name = param_info.param.name;
                           std::erase(name, '-');
                           return name;
                         });

TEST(RealLogs, IntelStampsRunBackwards631Times) {
  HMT_REQUIRE_REAL_DATA("laser2d/intel.clf.bz2");
  const auto reader = open_log(test::data_dir() / "laser2d/intel.clf.bz2");
  while (reader->next()) {
  }
  EXPECT_EQ(reader->report().notes.at("stamps run backwards"), 631);
  EXPECT_EQ(reader->report().odometry_records, 26915);
}

}  // namespace
}  // namespace hmt::submap
