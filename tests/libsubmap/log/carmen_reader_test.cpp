// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include "hmt/submap/log/log_reader.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using std::numbers::pi;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

struct Whole {
  std::vector<Observation> observations;
  LogReport report;
};

class CarmenReader : public testing::Test {
 protected:
  Whole read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    const auto reader = open_log(path_);
    Whole whole;
    while (auto observation = reader->next()) whole.observations.push_back(std::move(*observation));
    whole.report = reader->report();
    return whole;
  }
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "a.log";
};

template <typename... Parts>
std::string join(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

/// A scan of three beams to the right, ahead and to the left; laser and robot at (x, 0, 0).
std::string flaser(const std::string& ranges, int x, const std::string& stamps = "5.5 host 0.5") {
  return join("FLASER 3 ", ranges, " ", x, " 0 0 ", x, " 0 0 ", stamps, "\n");
}

Eigen::Vector3f at(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y), 0};
}

TEST_F(CarmenReader, TakesPosesStampsAndBeams) {
  const Whole log = read("FLASER 3 1 2 4  1.1 2 0.5  1 2 0.5  5.5 host 0.5\n");
  ASSERT_EQ(log.observations.size(), 1u);
  const Observation& observation = log.observations[0];
  EXPECT_EQ(observation.stamp_s, 5.5);
  EXPECT_EQ(observation.T_odom_robot, Pose::planar(1, 2, 0.5));
  ASSERT_EQ(observation.readings.size(), 1u);
  const Reading& reading = observation.readings[0];
  EXPECT_LT((reading.T_robot_sensor.translation -
             Eigen::Vector3d(0.1 * std::cos(0.5), -0.1 * std::sin(0.5), 0))
                .norm(),
            1e-12);
  EXPECT_NEAR(reading.beam_step_rad, pi / 2, 1e-12);
  ASSERT_EQ(reading.points_sensor.size(), 3u);
  EXPECT_LT((reading.points_sensor[0] - at(0, -1)).norm(), 1e-6);
  EXPECT_LT((reading.points_sensor[1] - at(2, 0)).norm(), 1e-6);
  EXPECT_LT((reading.points_sensor[2] - at(0, 4)).norm(), 1e-6);
}

TEST_F(CarmenReader, SpreadsBeamsAsSickScannersDo) {
  const auto angles = [&](int beams) {
    std::string ranges;
    for (int i = 0; i < beams; ++i) ranges += " 1";
    const Whole log = read(join("FLASER ", beams, ranges, " 0 0 0 0 0 0 1 h 1\n"));
    const auto& points = log.observations.at(0).readings.at(0).points_sensor;
    const auto degrees = [](const Eigen::Vector3f& p) {
      return std::round(std::atan2(p.y(), p.x()) * 180 / pi * 100) / 100;
    };
    return std::pair(degrees(points.front()), degrees(points.back()));
  };
  EXPECT_THAT(angles(180), Pair(-90, 89));
  EXPECT_THAT(angles(181), Pair(-90, 90));
  EXPECT_THAT(angles(360), Pair(-90, 89.5));
  EXPECT_THAT(angles(361), Pair(-90, 90));
  EXPECT_THAT(angles(401), Pair(-50, 50));
  EXPECT_THAT(angles(19), Pair(-90, 90));
  EXPECT_THAT(angles(1), Pair(0, 0));
}

TEST_F(CarmenReader, TakesFarRangesForMissesAndDropsImpossibleOnes) {
  const Whole log = read(flaser("81.91 2 80", 0) + flaser("nan 0 -1", 1) + flaser("inf 1 1", 2));
  ASSERT_EQ(log.observations.size(), 3u);
  const Reading& first = log.observations[0].readings[0];
  EXPECT_EQ(first.max_range_m, 80);
  ASSERT_EQ(first.misses_sensor.size(), 2u);
  EXPECT_LT((first.misses_sensor[0] - at(0, -1)).norm(), 1e-6);
  EXPECT_EQ(first.points_sensor.size(), 1u);
  EXPECT_TRUE(log.observations[1].readings[0].points_sensor.empty());
  EXPECT_EQ(log.observations[2].readings[0].misses_sensor.size(), 1u);
  EXPECT_EQ(log.report.notes.at("ranges left out: not a number"), 1);
  EXPECT_EQ(log.report.notes.at("ranges left out: zero or negative"), 2);
  EXPECT_TRUE(log.report.losses.empty());
}

TEST_F(CarmenReader, TakesTheMaximumFromTheParameters) {
  const Whole log = read("PARAM robot_front_laser_max 50.0 1 h 1\n" + flaser("49 50 51", 0));
  EXPECT_EQ(log.observations.at(0).readings[0].misses_sensor.size(), 2u);
}

TEST_F(CarmenReader, FindsTheCodeOfAnUnknownScanner) {
  // A scanner that says 5.6 where it meets nothing, in each of its 20 beams by turns.
  std::string text;
  for (int i = 0; i < 20; ++i) {
    text += "FLASER 20";
    for (int beam = 0; beam < 20; ++beam) text += beam % 4 == i % 4 ? " 5.6" : " 3";
    text += join(" ", 0.2 * i, " 0 0 ", 0.2 * i, " 0 0 1 h 1\n");
  }
  for (const Observation& observation : read(text).observations) {
    EXPECT_EQ(observation.readings[0].misses_sensor.size(), 5u);
    EXPECT_NEAR(observation.readings[0].max_range_m, 5.6, 0.01);
  }
}

TEST_F(CarmenReader, TakesAFarWallForAWall) {
  // The same far wall in many beams, but its range changes with the robot.
  std::string text;
  for (int i = 0; i < 20; ++i) {
    text += "FLASER 20";
    for (int beam = 0; beam < 20; ++beam) text += join(" ", 9 - 0.2 * i);
    text += join(" ", 0.2 * i, " 0 0 ", 0.2 * i, " 0 0 1 h 1\n");
  }
  for (const Observation& observation : read(text).observations)
    EXPECT_EQ(observation.readings[0].points_sensor.size(), 20u);
}

TEST_F(CarmenReader, ReadsTheGeometryOfEachRobotlaser) {
  const std::string tail = " 1 2 0.1  1 2 0.1  0.3 0 1 1 0  7.25 host 0.1\n";
  const Whole log = read("ROBOTLASER1 0 -0.5 1.0 0.5 30 0.01 2  3 1 30 2  3 9 9 9" + tail +
                         "ROBOTLASER1 0 -1 2 0 20 0.01 0  2 1 1  0" + tail);
  ASSERT_EQ(log.observations.size(), 2u);
  EXPECT_EQ(log.observations[0].stamp_s, 7.25);
  const Reading& first = log.observations[0].readings[0];
  EXPECT_EQ(first.max_range_m, 30);
  EXPECT_EQ(first.beam_step_rad, 0.5);
  ASSERT_EQ(first.points_sensor.size(), 2u);
  ASSERT_EQ(first.misses_sensor.size(), 1u);
  EXPECT_LT((first.points_sensor[0] - at(std::cos(0.5), -std::sin(0.5))).norm(), 1e-6);
  EXPECT_LT((first.misses_sensor[0] - at(1, 0)).norm(), 1e-6);
  const Reading& second = log.observations[1].readings[0];
  EXPECT_EQ(second.beam_step_rad, 2);
  EXPECT_EQ(second.max_range_m, 20);
}

TEST_F(CarmenReader, HangsTheRearLaserOnTheFrontOne) {
  const Whole log = read(flaser("1 1 1", 0, "1.0 h 1") +
                         "RLASER 3 2 2 2  -0.2 0 3.14159265358979  0 0 0  1.05 h 1\n" +
                         flaser("1 1 1", 1, "2.0 h 2"));
  ASSERT_EQ(log.observations.size(), 2u);
  ASSERT_EQ(log.observations[0].readings.size(), 2u);
  const Reading& rear = log.observations[0].readings[1];
  EXPECT_EQ(rear.sensor, 1);
  EXPECT_LT((rear.T_robot_sensor * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(-1.2, 0, 0)).norm(),
            1e-9);
  EXPECT_EQ(log.observations[1].readings.size(), 1u);
}

TEST_F(CarmenReader, ReadsOneMessageForOneLaser) {
  const Whole log =
      read(flaser("1 1 1", 0) +
           "ROBOTLASER1 0 -1.57 3.14 1.57 80 0 0 3 1 1 1 0 0 0 0 0 0 0 0 0 0 0 0 5.5 h 0.5\n");
  EXPECT_EQ(log.observations.size(), 1u);
  EXPECT_THAT(log.report.notes,
              ElementsAre(Pair("ROBOTLASER1 records left out: the same laser as FLASER", 1)));
}

TEST_F(CarmenReader, CountsWhatItDoesNotKnowAndSkipsTheRest) {
  const Whole log = read(
      "message formats defined: PARAM FLASER\n# comment\n\nSYNC x\nTRUEPOS 1\n"
      "ODOM 0 0 0 0 0 0 1 h 1\r\nGPS 1 2\n" +
      flaser("1 1 1", 0));
  EXPECT_EQ(log.observations.size(), 1u);
  EXPECT_EQ(log.report.odometry_records, 1);
  EXPECT_THAT(log.report.notes, ElementsAre(Pair("lines of unknown messages left out", 2)));
  EXPECT_EQ(log.report.first_places.at("lines of unknown messages left out"),
            path_.string() + ":1");
}

TEST_F(CarmenReader, SkipsDamagedRecordsAndNamesTheFirst) {
  const std::string good = flaser("1 1 1", 0);
  const Whole log =
      read(good + "FLASER 3 1 1\n" + good + "FLASER 3 1 x 1 0 0 0 0 0 0 1 h 1\n" + "FLASER -3\n" +
           "FLASER 99999999999 1\n" + "FLASER 3 1 1 1 0 0 0 0 0 0 1 h 1 1\n" +
           "FLASER 3 1 1 1 0 0 nan 0 0 0 1 h 1\n" + good);
  EXPECT_EQ(log.observations.size(), 3u);
  EXPECT_THAT(log.report.losses,
              ElementsAre(Pair("damaged FLASER records: laser pose is not finite", 1),
                          Pair("damaged FLASER records: line ends before range", 1),
                          Pair("damaged FLASER records: number of readings is not a count", 2),
                          Pair("damaged FLASER records: range is not a number", 1),
                          Pair("damaged FLASER records: too many fields", 1)));
  EXPECT_EQ(log.report.first_places.at("damaged FLASER records: line ends before range"),
            path_.string() + ":2");
}

TEST_F(CarmenReader, DoesNotTakeACutStampForAStamp) {
  const Whole log = read(flaser("1 1 1", 0) + "FLASER 3 1 1 1 0 0 0 0 0 0 5");
  EXPECT_EQ(log.observations.size(), 1u);
  EXPECT_THAT(log.report.losses,
              ElementsAre(Pair("damaged FLASER records: wrong number of fields", 1)));
}

TEST_F(CarmenReader, NotesStampsThatAreNoClock) {
  EXPECT_EQ(read(flaser("1 1 1", 0, "") + flaser("1 1 1", 0, "")).report.notes.at("stamps absent"),
            2);
  const Whole log =
      read(flaser("1 1 1", 0, "2 h 1") + flaser("1 1 1", 0, "2 h 1") + flaser("1 1 1", 0, "1 h 1"));
  EXPECT_THAT(log.report.notes,
              ElementsAre(Pair("stamps repeated", 1), Pair("stamps run backwards", 1)));
  EXPECT_EQ(log.observations[2].stamp_s, 1);
}

TEST_F(CarmenReader, DoesNotTakeACorrectedPoseForTheMount) {
  // The first pose of each line is one of a mapper, far off the odometry.
  std::string text;
  for (int i = 0; i < 9; ++i) text += join("FLASER 1 1  ", 9 * i, " 7 1  ", i, " 0 0  1 h 1\n");
  const Whole log = read(text);
  for (const Observation& observation : log.observations)
    EXPECT_EQ(observation.readings[0].T_robot_sensor, Pose{});
  EXPECT_EQ(log.observations[3].T_odom_robot, Pose::planar(3, 0, 0));
  EXPECT_EQ(log.report.notes.size(), 2u);  // the stamps are equal, too
}

TEST_F(CarmenReader, TakesTheLaserPoseWhereTheRobotPoseStandsStill) {
  const Whole log = read("FLASER 1 1  0 0 0  0 0 0  1 h 1\nFLASER 1 1  1 2 0  0 0 0  2 h 2\n");
  EXPECT_EQ(log.observations[1].T_odom_robot, Pose::planar(1, 2, 0));
  EXPECT_EQ(log.observations[1].readings[0].T_robot_sensor, Pose{});
}

TEST_F(CarmenReader, KeepsAScanWithoutBeams) {
  const Whole log = read("FLASER 0  1 2 0  1 2 0  1 h 1\n");
  ASSERT_EQ(log.observations.size(), 1u);
  EXPECT_TRUE(log.observations[0].readings[0].points_sensor.empty());
  EXPECT_EQ(log.report.notes.at("scans without beams"), 1);
}

TEST_F(CarmenReader, SurvivesRandomDamage) {
  std::string good = "PARAM robot_front_laser_max 50 1 h 1\n";
  for (int i = 0; i < 4; ++i) {
    good += flaser("1 2 3.5", i);
    good += "RLASER 2 1 1  1 0 3.1  1 0 0  5.5 h 1\n";
    good +=
        "ROBOTLASER1 0 -1.57 3.14 0.785 80 0.1 0  5 1 2 3 4 5  0  1 2 0 1 2 0 0 0 0 0 0 5 h 1\n";
  }
  std::mt19937 random(7);
  int read_whole = 0;
  for (int round = 0; round < 400; ++round) {
    std::string text = good;
    for (int change = 0; change < 4; ++change)
      text[random() % text.size()] = "0123456789-+.e \n\t#nNaA\xff"[random() % 23];
    text.resize(text.size() - random() % 20);
    try {
      for (const Observation& observation : read(text).observations) {
        ASSERT_TRUE(observation.T_odom_robot.translation.allFinite());
        for (const Reading& reading : observation.readings) {
          ASSERT_TRUE(reading.T_robot_sensor.translation.allFinite());
          for (const Eigen::Vector3f& p_sensor : reading.points_sensor)
            ASSERT_TRUE(p_sensor.allFinite());
        }
      }
      ++read_whole;
    } catch (const InputError&) {
      // nothing usable is left
    }
  }
  EXPECT_GT(read_whole, 380);
}

TEST_F(CarmenReader, RefusesWhatIsNoLog) {
  EXPECT_THAT(refusal(""), HasSubstr("the file is empty"));
  EXPECT_THAT(refusal("# CARMEN\nODOM 0 0 0 0 0 0 1 h 1\n"), HasSubstr("2 lines and no usable"));
  EXPECT_THAT(refusal("FLASER 3 1\n"),
              HasSubstr(join("first loss: ", path_.string(), ":1: damaged")));
  EXPECT_THAT(refusal(std::string(5 << 20, 'a')), HasSubstr(":1: the line is longer than"));
  std::string words;
  for (int i = 0; i < 2000; ++i) words += "words\n";
  EXPECT_THAT(refusal(words), HasSubstr("unknown log format"));
  for (const char* line : {"VERTEX_SE2 0 0 0 0\n", "# graph\nEDGE_SE3:QUAT 0 1\n", "FIX 0\n"})
    EXPECT_THAT(refusal(line), HasSubstr("--method submaps"));
  EXPECT_THROW(open_log(folder_.path()), InputError);
  EXPECT_THROW(open_log(folder_.path() / "no_such_file"), InputError);
}

}  // namespace
}  // namespace hmt::submap
