// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "hmt/graph/input_error.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using graph::InputError;
using graph::Pose;

class Tum : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) {
    const auto path = folder_.path() / "a.tum";
    std::ofstream(path) << text;
    return path;
  }
  std::string refusal(const std::string& text) {
    try {
      read_tum(file(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  test::TemporaryFolder folder_;
};

TEST_F(Tum, ReadsPosesAndSkipsComments) {
  const auto poses = read_tum(file("# stamp x y z qx qy qz qw\n\n1.5 1 2 3 0 0 1 0 # turned\r\n"));
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].stamp_s, 1.5);
  EXPECT_EQ(poses[0].T_world_robot.translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(std::abs(poses[0].T_world_robot.yaw_rad()), 3.14159265358979, 1e-12);
}

TEST_F(Tum, KeepsEveryStampBitByBit) {
  const std::vector<StampedPose> written = {{976052857.337530, Pose::planar(1, 2, 0.3)},
                                            {0.1 + 0.2, Pose::planar(-1, 0, -3)},
                                            {-5, Pose{}},
                                            {1357847247.3968640001, Pose{}}};
  const auto path = folder_.path() / "b.tum";
  write_tum(path, written);
  const auto read = read_tum(path);
  ASSERT_EQ(read.size(), written.size());
  for (size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp_s, written[i].stamp_s);
    EXPECT_LT(boxminus(read[i].T_world_robot, written[i].T_world_robot).norm(), 3e-9);
  }
}

TEST_F(Tum, WritesSixDecimalsOfAStampAtLeast) {
  const auto path = folder_.path() / "c.tum";
  write_tum(path, std::vector<StampedPose>{{158.415, Pose{}}, {7, Pose{}}});
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line,
            "158.415000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 0.000000000 "
            "1.000000000");
  std::getline(in, line);
  EXPECT_THAT(line, testing::StartsWith("7.000000 "));
}

TEST_F(Tum, NamesFileAndLineOfWhatItRefuses) {
  EXPECT_THAT(refusal("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 1\n"),
              testing::HasSubstr("a.tum:2: line ends"));
  EXPECT_THAT(refusal("1 0 0 0 0 0 0 1 9\n"), testing::HasSubstr("more than 8"));
  EXPECT_THAT(refusal("1 0 x 0 0 0 0 1\n"), testing::HasSubstr("position is not a number"));
  EXPECT_THAT(refusal("1 0 nan 0 0 0 0 1\n"), testing::HasSubstr("not finite"));
  EXPECT_THAT(refusal("1 0 0 0 0 0 0 0\n"), testing::HasSubstr("length zero"));
  EXPECT_THAT(refusal("# nothing\n"), testing::HasSubstr("no poses"));
  EXPECT_THAT(refusal(""), testing::HasSubstr("empty"));
}

TEST_F(Tum, LeavesNothingBehindWhereItCannotWrite) {
  EXPECT_THROW(write_tum(folder_.path() / "no/folder/a.tum", {}), InputError);
  EXPECT_THROW(write_tum(folder_.path(), {}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace hmt::submap
