// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/matrix_market.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

#include <fstream>
#include <string>

#include "hmt/graph/input_error.hpp"
#include "real_data.hpp"

namespace hmt::graph {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class MatrixMarket : public testing::Test {
 protected:
  MatrixMarket() {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    path_ = std::filesystem::path(testing::TempDir()) / ("matrix_market_" + name + ".mtx");
  }
  ~MatrixMarket() override { std::filesystem::remove(path_); }

  WeightedGraph read(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    return read_matrix_market(path_);
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  void write_gzip(const std::string& text) const {
    const gzFile file = gzopen(path_.c_str(), "wb");
    gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    gzclose(file);
  }

  std::filesystem::path path_;
};

const std::string kSymmetric = "%%MatrixMarket matrix coordinate real symmetric\n";
const std::string kGeneral = "%%MatrixMarket matrix coordinate real general\n";

TEST_F(MatrixMarket, ReadsASymmetricMatrixWithCommentsAndBlankLines) {
  const WeightedGraph graph =
      read(kSymmetric + "% a comment\n\n3 3 3\r\n2 1 0.5\n 3\t2 1e-3 \n%\n1 1 0\n");
  EXPECT_EQ(graph.num_nodes(), 3);
  EXPECT_EQ(graph.num_arcs(), 2);
  EXPECT_EQ(graph.weight(0, 1), 0.5);
  EXPECT_EQ(graph.weight(1, 2), 1e-3);
}

TEST_F(MatrixMarket, ReadsGeneralIntegerAndPattern) {
  EXPECT_EQ(read(kGeneral + "2 2 2\n1 2 0.25\n2 1 0.25").weight(0, 1), 0.25);
  EXPECT_EQ(read("%%MatrixMarket matrix coordinate integer symmetric\n2 2 1\n2 1 7\n").weight(0, 1),
            7);
  EXPECT_EQ(read("%%MatrixMarket MATRIX Coordinate Pattern symmetric\n2 2 1\n1 2\n").weight(0, 1),
            1);
  EXPECT_EQ(read(kSymmetric + "0 0 0\n").num_nodes(), 0);
}

TEST_F(MatrixMarket, ReadsGzip) {
  write_gzip(kSymmetric + "2 2 1\n2 1 0.5\n");
  EXPECT_TRUE(is_matrix_market(path_));
  EXPECT_EQ(read_matrix_market(path_).weight(0, 1), 0.5);
}

TEST_F(MatrixMarket, NamesFileAndLineOfABadEntry) {
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n2 1 nan\n"),
              AllOf(HasSubstr(path_.string() + ":3: "), HasSubstr("row 2, column 1"),
                    HasSubstr("not a finite")));
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n2 1 -0.5\n"),
              AllOf(HasSubstr(":3: "), HasSubstr("row 2, column 1"), HasSubstr("negative")));
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n3 1 1\n"), HasSubstr("outside the matrix of 2 rows"));
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n0 1 1\n"), HasSubstr("rows count from 1"));
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n2 2 1\n"), HasSubstr("diagonal"));
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n2 x 1\n"), HasSubstr("the column is 'x'"));
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n2 1\n"), HasSubstr("the weight is ''"));
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n2 1 1 1\n"), HasSubstr("more numbers"));
  EXPECT_THAT(refusal(kSymmetric + "2 2 1\n99999999999999999999 1 1\n"), HasSubstr("the row is"));
}

TEST_F(MatrixMarket, RefusesWhatIsNotSymmetric) {
  EXPECT_THAT(refusal(kGeneral + "2 2 1\n1 2 0.25\n"),
              AllOf(HasSubstr(":3: "), HasSubstr("row 1, column 2"), HasSubstr("symmetric")));
  EXPECT_THAT(refusal(kGeneral + "2 2 2\n1 2 0.25\n2 1 0.5\n"), HasSubstr("0.500000"));
  EXPECT_THAT(refusal(kGeneral + "2 2 2\n1 2 0.25\n1 2 0.25\n"), HasSubstr("in line 3"));
  EXPECT_THAT(refusal(kGeneral + "2 2 3\n1 2 1\n2 1 1\n2 1 1\n"), HasSubstr(":5: "));
  EXPECT_THAT(refusal(kSymmetric + "2 2 2\n1 2 0.25\n2 1 0.25\n"), HasSubstr("given before"));
}

TEST_F(MatrixMarket, RefusesHeadersThatLie) {
  EXPECT_THAT(refusal(""), HasSubstr("%%MatrixMarket"));
  EXPECT_THAT(refusal("hello"), HasSubstr("%%MatrixMarket"));
  EXPECT_THAT(refusal("%%MatrixMarket matrix array real general\n"), HasSubstr("array"));
  EXPECT_THAT(refusal("%%MatrixMarket matrix coordinate complex general\n"), HasSubstr("complex"));
  EXPECT_THAT(refusal("%%MatrixMarket matrix coordinate real hermitian\n"), HasSubstr("hermitian"));
  EXPECT_THAT(refusal(kSymmetric), HasSubstr("size line"));
  EXPECT_THAT(refusal(kSymmetric + "2 3 0\n"), HasSubstr("square"));
  EXPECT_THAT(refusal(kSymmetric + "2 2 0 0\n"), HasSubstr("more than three"));
  EXPECT_THAT(refusal(kSymmetric + "2000000000 2000000000 1\n2 1 1\n"), HasSubstr("10000000"));
  EXPECT_THAT(refusal(kSymmetric + "-1 -1 0\n"), HasSubstr("-1 rows"));
  EXPECT_THAT(refusal(kSymmetric + "2 2 5\n"), HasSubstr("cannot hold"));
  EXPECT_THAT(refusal(kSymmetric + "9999999 9999999 99999999999\n2 1 1\n"),
              HasSubstr("ends after 1 of 99999999999"));
  EXPECT_THAT(refusal(kSymmetric + "3 3 1\n2 1 1\n3 1 1\n"), HasSubstr(":4: more entries"));
}

TEST_F(MatrixMarket, RefusesTruncatedAndBinaryFiles) {
  write_gzip(kSymmetric + "2 2 1\n2 1 0.5\n");
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 12);
  EXPECT_THROW(read_matrix_market(path_), InputError);
  EXPECT_THAT(refusal(std::string(200'000, 'x')), HasSubstr("64 kB"));
  EXPECT_THROW(read_matrix_market(path_.string() + ".missing"), InputError);
  EXPECT_THROW(read_matrix_market(testing::TempDir()), InputError);
  EXPECT_FALSE(is_matrix_market(testing::TempDir()));
}

TEST(MatrixMarketRealData, ReadsARecordedMatrix) {
  HMT_REQUIRE_REAL_DATA("partitions/intel_mm.mtx.gz");
  const WeightedGraph graph =
      read_matrix_market(test::data_dir() / "partitions" / "intel_mm.mtx.gz");
  EXPECT_EQ(graph.num_nodes(), 899);
  EXPECT_EQ(graph.num_arcs(), 94305);
  EXPECT_EQ(graph.weight(0, 1), 0.386229303);
}

}  // namespace
}  // namespace hmt::graph
