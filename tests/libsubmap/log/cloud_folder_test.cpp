// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lzf.h>

#include <cmath>
#include <functional>
#include <limits>

#include "hmt/submap/log/log_check.hpp"
#include "log/cloud/cloud_file.hpp"
#include "log/natural_order.hpp"
#include "read_log.hpp"
#include "real_data.hpp"
#include "recordings/recording_writers.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using test::WireWriter;
using testing::HasSubstr;

using Points = std::vector<Eigen::Vector3f>;
const Points kPoints = {{1, 2, 3}, {-4, 5, -6}, {0.5, 0.25, 100}};

std::string pcd_header(const std::string& data, const std::string& counts) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS intensity x y z\n"
         "SIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\n" +
         counts + "VIEWPOINT 0 0 0 1 0 0 0\nDATA " + data + "\n";
}
const std::string kThree = "WIDTH 3\nHEIGHT 1\nPOINTS 3\n";

std::string binary_points(bool little_endian = true) {
  WireWriter out(Wire::ros1, little_endian);
  for (const auto& p : kPoints) out.number(7.F).number(p.x()).number(p.y()).number(p.z());
  return out.bytes();
}

/// Field by field, compressed by liblzf as PCL does.
std::string compressed_points() {
  WireWriter planes(Wire::ros1);
  for (size_t k = 0; k < kPoints.size(); ++k) planes.number(7.F);
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const auto& p : kPoints) planes.number(p[axis]);
  std::string packed(1000, '\0');
  const unsigned size =
      lzf_compress(planes.bytes().data(), static_cast<unsigned>(planes.bytes().size()),
                   packed.data(), static_cast<unsigned>(packed.size()));
  packed.resize(size);
  return WireWriter(Wire::ros1)
      .number(uint32_t{size})
      .number(static_cast<uint32_t>(planes.bytes().size()))
      .raw(packed)
      .bytes();
}

std::string ply_header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment c\nelement vertex 3\nproperty float intensity\nproperty float x\nproperty "
         "float y\nproperty float z\nelement face 0\nproperty list uchar int i\nend_header\n";
}

std::string ascii_points() {
  return "7 1 2 3\n7 -4 5 -6\r\n\n7 0.5 0.25 100\n";
}

std::string reason(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CloudFile, PcdOfEachKindOfDataGivesThePoints) {
  EXPECT_EQ(read_pcd(pcd_header("ascii", kThree) + ascii_points()).points, kPoints);
  EXPECT_EQ(read_pcd(pcd_header("binary", kThree) + binary_points()).points, kPoints);
  EXPECT_EQ(read_pcd(pcd_header("binary_compressed", kThree) + compressed_points()).points,
            kPoints);
}

TEST(CloudFile, PointsCountWhereWidthIsZero) {
  const std::string counts = "WIDTH 0\nHEIGHT 0\nPOINTS 3\n";
  EXPECT_EQ(read_pcd(pcd_header("binary", counts) + binary_points()).points, kPoints);
  EXPECT_EQ(read_pcd(pcd_header("binary", "WIDTH 3\nHEIGHT 1\n") + binary_points()).points,
            kPoints);
}

TEST(CloudFile, PlyOfEachFormatGivesThePoints) {
  EXPECT_EQ(read_ply(ply_header("ascii") + ascii_points()).points, kPoints);
  EXPECT_EQ(read_ply(ply_header("binary_little_endian") + binary_points()).points, kPoints);
  EXPECT_EQ(read_ply(ply_header("binary_big_endian") + binary_points(false)).points, kPoints);
}

TEST(CloudFile, KittiBinGivesThePoints) {
  WireWriter out(Wire::ros1);
  for (const auto& p : kPoints) out.number(p.x()).number(p.y()).number(p.z()).number(0.5F);
  EXPECT_EQ(read_kitti_bin(out.bytes()).points, kPoints);
  EXPECT_THAT(read_kitti_bin(out.bytes() + "abc").damage, HasSubstr("cut"));
}

TEST(CloudFile, CountsThatLieCostWhatIsMissingAndNoMemory) {
  const std::string lie = "WIDTH 4000000000\nHEIGHT 4000000000\nPOINTS 9000000000000000000\n";
  for (const auto& bytes :
       {pcd_header("ascii", lie) + ascii_points(), pcd_header("binary", lie) + binary_points()}) {
    const CloudPoints cloud = read_pcd(bytes);
    EXPECT_EQ(cloud.points, kPoints);
    EXPECT_THAT(cloud.damage, HasSubstr("fewer points"));
  }
  EXPECT_THAT(reason([&] { read_pcd(pcd_header("binary_compressed", lie) + compressed_points()); }),
              HasSubstr("number of points"));
  std::string bomb = pcd_header("binary_compressed", kThree) + compressed_points();
  const size_t sizes = bomb.find("DATA binary_compressed\n") + 23;
  bomb.replace(sizes + 4, 4, "\xff\xff\xff\x7f");
  EXPECT_THAT(reason([&] { read_pcd(bomb); }), HasSubstr("no LZF data"));
}

TEST(CloudFile, CutFilesGiveTheirFirstPointsOrAReason) {
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    const std::string whole = pcd_header(data, kThree) + (data[0] == 'a'   ? ascii_points()
                                                          : data[6] == '_' ? compressed_points()
                                                                           : binary_points());
    // Of a number in text nobody can tell that its end is missing.
    const size_t last_digits = data[0] == 'a' ? 4 : 1;
    for (size_t size = 0; size + last_digits < whole.size(); ++size) {
      const std::string_view cut = std::string_view(whole).substr(0, size);
      CloudPoints cloud;
      const std::string refused = reason([&] { cloud = read_pcd(cut); });
      EXPECT_TRUE(!refused.empty() || !cloud.damage.empty() || cloud.not_finite > 0) << size;
      EXPECT_LE(cloud.points.size(), 3u);
    }
  }
}

TEST(CloudFile, WhatIsNoCloudIsRefusedWithTheReason) {
  EXPECT_THAT(reason([] { read_pcd("hello\n"); }), HasSubstr("no PCD file"));
  EXPECT_THAT(reason([] { read_ply("hello\n"); }), HasSubstr("no PLY file"));
  EXPECT_THAT(reason([] { read_pcd("FIELDS x y\nDATA ascii\n"); }),
              HasSubstr("x, y or z is missing"));
  EXPECT_THAT(reason([] { read_pcd("FIELDS x y z\nTYPE I F F\nDATA ascii\n"); }),
              HasSubstr("no floating-point"));
  EXPECT_THAT(reason([] { read_pcd("FIELDS x y z\nCOUNT -1 1 1\nDATA ascii\n"); }),
              HasSubstr("COUNT"));
  EXPECT_THAT(reason([] { read_pcd(pcd_header("rot13", kThree)); }), HasSubstr("rot13"));
}

TEST(NaturalOrder, NumbersCountByValue) {
  std::vector<std::string> names = {"10.pcd", "9.pcd", "a10b2", "a10b10", "a9", "09.pcd", "a", "b"};
  std::ranges::sort(names, natural_less);
  EXPECT_EQ(names, (std::vector<std::string>{"09.pcd", "9.pcd", "10.pcd", "a", "a9", "a10b2",
                                             "a10b10", "b"}));
}

class CloudFolderLog : public testing::Test {
 protected:
  CloudFolderLog() {
    for (const char* name : {"9.pcd", "10.pcd", "11.pcd"})
      test::write_file(folder_.path() / name, pcd_header("binary", kThree) + binary_points());
  }
  void odometry(const std::string& text) { test::write_file(odometry_file(), text); }
  std::string odometry_file() const { return folder_.path() / "odometry.txt"; }
  LogSummary summary() {
    const auto log = open_log(folder_.path(), {{}, "", odometry_file()});
    return summarize_log(*log, submap::Run{});
  }
  static constexpr const char* kTum =
      "# a comment\n1.5 0 0 0 0 0 0 1\n2.5 1 0 0 0 0 0 1\n3.5 2 0 0 0 0 1 0\n";

  test::TemporaryFolder folder_;
};

TEST_F(CloudFolderLog, PairsCloudsInNaturalOrderWithTheLines) {
  odometry(kTum);
  const auto log = open_log(folder_.path(), {{}, "", odometry_file()});
  EXPECT_EQ(log->space(), Space::se3);
  for (int k = 0; k < 3; ++k) {
    const auto observation = log->next();
    ASSERT_TRUE(observation);
    EXPECT_EQ(observation->index, k);
    EXPECT_EQ(observation->stamp_s, 1.5 + k);
    EXPECT_EQ(observation->T_odom_robot.translation.x(), k);
    EXPECT_EQ(observation->readings.at(0).points_sensor, kPoints);
  }
  EXPECT_FALSE(log->next());
}

TEST_F(CloudFolderLog, KittiPosesTakeTheirStampsFromTimes) {
  odometry("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n0 -1 0 2 1 0 0 0 0 0 1 0\n");
  EXPECT_EQ(summary().report.notes.at("stamps absent"), 3);
  test::write_file(folder_.path() / "times.txt", "0.0\n0.1\n0.2\n");
  const LogSummary log = summary();
  EXPECT_TRUE(log.report.notes.empty());
  EXPECT_EQ(log.last_stamp_s, 0.2);
  EXPECT_EQ(log.path_m, 2);
}

TEST_F(CloudFolderLog, LossesAreCountedAndTheRestIsUsed) {
  odometry("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 0\n");
  EXPECT_EQ(summary().report.observations, 1);
  EXPECT_EQ(summary().report.losses.at("lines of the odometry file that are no pose"), 1);
  EXPECT_EQ(summary().report.losses.at("clouds behind the end of the odometry"), 1);
  odometry(kTum);
  test::write_file(folder_.path() / "10.pcd", "");
  test::write_file(folder_.path() / "11.pcd", "x");
  const LogSummary damaged = summary();
  EXPECT_EQ(damaged.report.observations, 1);
  EXPECT_EQ(damaged.report.losses.at("clouds that cannot be read: the file is empty"), 1);
}

TEST_F(CloudFolderLog, NeedsNoOdometry) {
  const std::vector<Observation> all = test::read_log(folder_.path());
  ASSERT_EQ(all.size(), 3);
  for (const Observation& observation : all) EXPECT_EQ(observation.T_odom_robot, Pose{});
}

TEST_F(CloudFolderLog, WhatDoesNotFitIsRefused) {
  const auto refused = [&] { return reason([&] { summary(); }); };
  odometry("1 2 3\n");
  EXPECT_THAT(refused(), HasSubstr("neither a pose of TUM"));
  odometry(std::string(kTum) + "9 0 0 0 0 0 0 1\n");
  EXPECT_THAT(refused(), HasSubstr("3 clouds and 4 poses"));
  test::write_file(folder_.path() / "a.ply", "ply");
  EXPECT_THAT(refused(), HasSubstr("several formats"));
}

TEST(RealClouds, NcltIsReadWhole) {
  HMT_REQUIRE_REAL_DATA("lidar3d/nclt_20130110");
  const auto folder = test::data_dir() / "lidar3d/nclt_20130110";
  const auto log = open_log(folder, {{}, "", folder / "lidar_odometry.tum"});
  const LogSummary summary = summarize_log(*log, submap::Run{});
  EXPECT_EQ(summary.report.observations, 1141);
  EXPECT_TRUE(summary.report.losses.empty());
  EXPECT_NEAR(summary.path_m, 1133, 5);
  EXPECT_GT(summary.sensors.at(0).points, 1141 * 500);
}

}  // namespace
}  // namespace hmt::submap
