// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "hmt/submap/log/log_reader.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using testing::HasSubstr;

LogOptions of_robot(int robot) {
  LogOptions options;
  options.robot = robot;
  return options;
}

class LandmarkLogs : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
  }
  std::vector<Observation> read(const std::filesystem::path& path, const LogOptions& options = {}) {
    const auto log = open_log(path, options);
    std::vector<Observation> observations;
    while (auto observation = log->next()) observations.push_back(*observation);
    report_ = log->report();
    return observations;
  }
  std::string refusal(const std::filesystem::path& path, const LogOptions& options = {}) {
    try {
      read(path, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::filesystem::path text(const std::string& lines) {
    write("log.txt", lines);
    return folder_.path() / "log.txt";
  }
  void write_mrclam(const std::string& odometry, const std::string& measurements, int robot = 1) {
    write("Barcodes.dat", "# Subject Barcode\n 1 5\n 6 63\n 7 81\n");
    write("Robot" + std::to_string(robot) + "_Odometry.dat", odometry);
    write("Robot" + std::to_string(robot) + "_Measurement.dat", measurements);
  }

  test::TemporaryFolder folder_;
  LogReport report_;
};

TEST_F(LandmarkLogs, RelationsGiveEveryPoseWithItsMotionAndLandmarks) {
  const auto log =
      read(text("ODOMETRY 0 1 1 0 1.5707963267948966 0.04 0 0 0.09 0 0.01\n"
                "LANDMARK 1 9 2 0.5 0.4 0.1 0.3\n"
                "ODOMETRY 1 3 1 0 0 0.04 0 0 0.04 0 0.01\n"));
  ASSERT_EQ(log.size(), 3u);
  EXPECT_EQ(log[2].stamp_s, 3);
  EXPECT_LT((log[2].T_odom_robot.translation - Eigen::Vector3d(1, 1, 0)).norm(), 1e-12);
  EXPECT_FALSE(log[0].motion_covariance.has_value());
  EXPECT_EQ((*log[1].motion_covariance)(1, 1), 0.09);
  EXPECT_EQ((*log[1].motion_covariance)(5, 5), 0.01);
  EXPECT_EQ((*log[1].motion_covariance)(2, 2), 0);
  ASSERT_EQ(log[1].landmark_readings.size(), 1u);
  const Landmark& landmark = log[1].landmark_readings[0].landmarks.at(0);
  EXPECT_EQ(landmark.id, 9);
  EXPECT_EQ(landmark.position_sensor, Eigen::Vector3d(2, 0.5, 0));
  EXPECT_EQ(landmark.covariance_sensor(0, 1), 0.1);
  EXPECT_EQ(landmark.covariance_sensor(2, 2), 0);
  EXPECT_TRUE(report_.losses.empty());
}

TEST_F(LandmarkLogs, RelationsNeedNotSayWhichLandmarkItWas) {
  const auto log =
      read(text("ODOMETRY 0 1 1 0 0 0.04 0 0 0.04 0 0.01\n"
                "LANDMARK 1 - 2 0.5 0.4 0 0.3\n"
                "LANDMARK 1 -1 2 0.5 0.4 0 0.3\n"));
  ASSERT_EQ(log.size(), 2u);
  ASSERT_EQ(log[1].landmark_readings[0].landmarks.size(), 1u);
  EXPECT_EQ(log[1].landmark_readings[0].landmarks[0].id, kUnknownLandmark);
  EXPECT_EQ(report_.losses.size(), 1u);
}

TEST_F(LandmarkLogs, RelationsLeaveOutWhatIsDamagedAndSayWhere) {
  const auto log =
      read(text("ODOMETRY 0 1 1 0 0 0.04 0 0 0.04 0 0.01\n"
                "LANDMARK 1 9 nan 0.5 0.4 0 0.3\n"
                "LANDMARK 1 9 2 0.5 0 0 0\n"
                "LANDMARK 0 9 2 0.5 0.4 0 0.3\n"
                "LANDMARK 1 -9 2 0.5 0.4 0 0.3\n"
                "ODOMETRY 1 2 1 0 0 0.04 0 0 0.04\n"
                "nonsense\n"
                "ODOMETRY 2 3 1 0 0 0.04 0 0 0.04 0 0.01\n"));
  EXPECT_EQ(log.size(), 3u);
  EXPECT_EQ(report_.losses.size(), 7u);
  EXPECT_THAT(report_.first_places.at("damaged text records: x is not finite"),
              HasSubstr("log.txt:2"));
  // Nothing is known of the motion whose record is lost.
  EXPECT_GT((*log[2].motion_covariance)(0, 0), 1);
  EXPECT_THAT(refusal(text("ODOMETRY 0\n")), HasSubstr("no usable"));
}

TEST_F(LandmarkLogs, MrclamDrivesArcsAndGroupsMeasurementsOfOneStamp) {
  // A quarter of a circle of radius 1 m in 1 s, then rest.
  write_mrclam("10 1.5707963267948966 1.5707963267948966\n11 0 0\n",
               "11 63 2 0\n11 81 1 1.5707963267948966\n11.5 5 1 0\n12 63 2 0\n");
  const auto log = read(folder_.path());
  ASSERT_FALSE(log.empty());
  const auto seen = std::find_if(log.begin(), log.end(),
                                 [](const Observation& o) { return !o.landmark_readings.empty(); });
  ASSERT_NE(seen, log.end());
  EXPECT_EQ(seen->stamp_s, 11);
  EXPECT_LT((seen->T_odom_robot.translation - Eigen::Vector3d(1, 1, 0)).norm(), 1e-9);
  const auto& landmarks = seen->landmark_readings.at(0).landmarks;
  ASSERT_EQ(landmarks.size(), 2u);
  EXPECT_EQ(landmarks[0].id, 6);
  EXPECT_EQ(landmarks[1].id, 7);
  EXPECT_LT((landmarks[1].position_sensor - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_TRUE(landmarks[0].covariance_sensor.isZero());
  EXPECT_EQ(report_.notes.at("measurements of other robots left out"), 1);
}

TEST_F(LandmarkLogs, MrclamLeavesOutWhatIsDamaged) {
  write_mrclam("10 0 0\n9 0 0\n11 nan 0\n",
               "10 63 2 0\n9 63 2 0\n11 44 2 0\n12 63 -1 0\n13 63 2\n14 63 2 0\n");
  EXPECT_EQ(read(folder_.path()).size(), 2u);
  EXPECT_EQ(report_.losses.size(), 6u);
  EXPECT_THAT(report_.first_places.at("damaged Measurement records: unknown barcode"),
              HasSubstr("Robot1_Measurement.dat:3"));
}

TEST_F(LandmarkLogs, MrclamAsksForTheRobotWhereThereAreSeveral) {
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("without files of a known log format"));
  write_mrclam("10 0 0\n", "10 63 2 0\n", 1);
  EXPECT_EQ(read(folder_.path()).size(), 1u);
  write_mrclam("10 0 0\n", "10 63 2 0\n", 3);
  EXPECT_THAT(refusal(folder_.path()), HasSubstr("robots 1, 3; choose one with --robot N"));
  EXPECT_EQ(read(folder_.path(), of_robot(3)).size(), 1u);
  EXPECT_THAT(refusal(folder_.path(), of_robot(2)), HasSubstr("no robot 2; there is 1, 3"));
  EXPECT_THAT(refusal(text("ODOMETRY 0 1 1 0 0 1 0 0 1 0 1\n"), of_robot(1)),
              HasSubstr("holds one robot"));
  std::filesystem::remove(folder_.path() / "Barcodes.dat");
  EXPECT_THAT(refusal(folder_.path(), of_robot(1)), HasSubstr("Barcodes.dat: no such file"));
}

TEST_F(LandmarkLogs, RealOnesAreReadWithoutLoss) {
  HMT_REQUIRE_REAL_DATA("landmarks/victoria_park.txt");
  EXPECT_EQ(read(test::data_dir() / "landmarks/victoria_park.txt").size(), 6969u);
  EXPECT_TRUE(report_.losses.empty());
  EXPECT_GT(read(test::data_dir() / "landmarks/mrclam7", of_robot(1)).size(), 1600u);
  EXPECT_TRUE(report_.losses.empty());
}

}  // namespace
}  // namespace hmt::submap
