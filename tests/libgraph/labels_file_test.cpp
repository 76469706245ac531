// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/labels_file.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class LabelsFile : public testing::Test {
 protected:
  LabelsFile() {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    path_ = std::filesystem::path(testing::TempDir()) / ("labels_file_" + name + ".txt");
  }
  ~LabelsFile() override { std::filesystem::remove(path_); }

  Labels read(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return read_labels(path_);
  }

  std::filesystem::path path_;
};

TEST_F(LabelsFile, HoldsTheGroupOfOneNodeALine) {
  EXPECT_EQ(labels_text({0, 0, 1}), "0\n0\n1\n");
  EXPECT_THAT(read(labels_text({0, 0, 1})), ElementsAre(0, 0, 1));
  EXPECT_TRUE(is_labels_file(path_));
}

TEST_F(LabelsFile, MayNumberGroupsInAnyWay) {
  EXPECT_THAT(read("18\r\n 20\n18\n-3"), ElementsAre(0, 1, 0, 2));
  EXPECT_THAT(read(""), IsEmpty());
}

TEST_F(LabelsFile, MayBeAPartitionTable) {
  EXPECT_THAT(read("keyframe,stamp_s,submap\n0,12.5,4\n1,13.5,4\n2,15,0\n"), ElementsAre(0, 0, 1));
  EXPECT_TRUE(is_labels_file(path_));
}

TEST_F(LabelsFile, IsRefusedNamingTheLineWhereItHoldsNoNumber) {
  for (const char* text :
       {"0\n\n1\n", "0\nx\n", "0\n1 2\n", "0\n99999999999\n", "keyframe,stamp_s,submap\n0;1;2\n"}) {
    try {
      read(text);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(path_.string() + ":2: "));
    }
  }
  std::ofstream(path_) << "1.0 2.0 3.0 4.0 0 0 0 1\n";
  EXPECT_FALSE(is_labels_file(path_));
  EXPECT_FALSE(is_labels_file(path_.string() + ".missing"));
}

}  // namespace
}  // namespace hmt::graph
