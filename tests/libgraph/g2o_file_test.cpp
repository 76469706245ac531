// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/g2o_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <numeric>

#include "hmt/graph/input_error.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace hmt::graph {
namespace {

using testing::HasSubstr;

constexpr char kPlanar[] =
    "VERTEX_SE2 0 0 0 0\n"
    "VERTEX_SE2 1 1.5 -2e-1 0.5\n"
    "EDGE_SE2 0 1 1 2 0.25 11 12 13 22 23 33\n";

constexpr char kSpatial[] =
    "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
    "VERTEX_SE3:QUAT 1 1 2 3 0 0 0.6 0.8\n"
    "EDGE_SE3:QUAT 0 1 1 2 3 0 0 0.6 0.8 10 0 0 0 0 0 10 0 0 0 0 10 0 0 0 40 0 0 40 0 40\n";

TEST(G2oFile, ReadsPlanarPosesAndEdges) {
  const G2oFile file = parse_g2o(kPlanar, "a.g2o");
  EXPECT_EQ(file.graph.space, Space::se2);
  ASSERT_EQ(file.graph.poses.size(), 2u);
  EXPECT_LT(boxminus(file.graph.poses[1], Pose::planar(1.5, -0.2, 0.5)).norm(), 1e-15);
  const PoseGraphEdge& edge = file.graph.edges.at(0);
  EXPECT_LT(boxminus(edge.T_from_to, Pose::planar(1, 2, 0.25)).norm(), 1e-15);
  EXPECT_EQ(edge.information(0, 0), 11);
  EXPECT_EQ(edge.information(1, 0), 12);
  EXPECT_EQ(edge.information(0, 5), 13);
  EXPECT_EQ(edge.information(5, 1), 23);
  EXPECT_EQ(edge.information(5, 5), 33);
}

// The second vertex is turned by 0.1 about x from where the edge puts it: vec(q) = sin(0.05), so
// chi2 by the format's definition is 40 sin^2(0.05).
TEST(G2oFile, SpatialChi2IsThatOfTheFormat) {
  G2oFile file = parse_g2o(kSpatial, "a.g2o");
  EXPECT_EQ(file.graph.edges[0].information(3, 3), 10);
  Pose& turned = file.graph.poses[1];
  turned.rotation = turned.rotation * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX());
  const double chi2 = optimize(file.graph, {}).report.chi2_initial;
  EXPECT_NEAR(chi2, 40 * std::pow(std::sin(0.05), 2), 1e-12);
}

TEST(G2oFile, WritesWhatItReads) {
  for (const char* text : {kPlanar, kSpatial}) {
    const G2oFile file = parse_g2o(text, "a.g2o");
    const G2oFile again = parse_g2o(format_g2o(file), "b.g2o");
    EXPECT_EQ(again.ids, file.ids);
    ASSERT_EQ(again.graph.poses.size(), file.graph.poses.size());
    for (size_t k = 0; k < file.graph.poses.size(); ++k)
      EXPECT_LT(boxminus(again.graph.poses[k], file.graph.poses[k]).norm(), 1e-15);
    EXPECT_EQ(again.graph.edges[0].information, file.graph.edges[0].information);
  }
}

TEST(G2oFile, NumbersNodesByAscendingIdWhateverTheOrderOfTheLines) {
  const G2oFile file = parse_g2o(
      "FIX 30\nEDGE_SE2 30 7 1 0 0 1 0 0 1 0 1\nVERTEX_SE2 30 5 0 0\n"
      "VERTEX_SE2 7 6 0 0\n# comment\n\nVERTEX_XY 99 1 1\n",
      "a.g2o");
  EXPECT_EQ(file.ids, (std::vector<int64_t>{7, 30}));
  EXPECT_EQ(file.graph.fixed, std::vector<int>{1});
  EXPECT_EQ(file.graph.edges[0].from, 1);
  EXPECT_EQ(file.graph.poses[0].translation.x(), 6);
  EXPECT_EQ(file.skipped.at("VERTEX_XY"), 1);
}

TEST(G2oFile, ChainsMissingVerticesAlongTheEdges) {
  const G2oFile file = parse_g2o(
      "VERTEX_SE2 1 10 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 2 0 0 1 0 0 1 0 1\n"
      "EDGE_SE2 5 6 3 0 0 1 0 0 1 0 1\n",
      "a.g2o");
  EXPECT_EQ(file.created, (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(file.components, 2);
  const std::vector<double> x = {9, 10, 12, 0, 3};
  for (size_t k = 0; k < x.size(); ++k) EXPECT_DOUBLE_EQ(file.graph.poses[k].translation.x(), x[k]);
}

TEST(G2oFile, ReadsTheInformationOfToroInItsOwnOrder) {
  const G2oFile file =
      parse_g2o("VERTEX2 0 0 0 0\nVERTEX2 1 1 0 0\nEDGE2 0 1 1 0 0 11 12 22 33 13 23\n", "a.graph");
  const Matrix6d& information = file.graph.edges[0].information;
  EXPECT_EQ(information(0, 1), 12);
  EXPECT_EQ(information(1, 1), 22);
  EXPECT_EQ(information(5, 5), 33);
  EXPECT_EQ(information(0, 5), 13);
  EXPECT_EQ(information(1, 5), 23);
}

// Eigenvalues of [1 2; 2 1] are 3 and -1; without the negative one it is [1.5 1.5; 1.5 1.5].
TEST(G2oFile, ReplacesANegativeInformationAndKeepsASingularOne) {
  const std::string text =
      "EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 0\n"
      "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n";
  const G2oFile file = parse_g2o(text, "a.g2o");
  ASSERT_EQ(file.weak_edges.size(), 2u);
  EXPECT_EQ(file.weak_edges[0].line, 1);
  EXPECT_TRUE(file.weak_edges[0].replaced);
  EXPECT_NEAR(file.weak_edges[0].smallest, -1, 1e-12);
  EXPECT_NEAR(file.graph.edges[0].information(0, 1), 1.5, 1e-12);
  EXPECT_EQ(file.weak_edges[1].line, 2);
  EXPECT_FALSE(file.weak_edges[1].replaced);
  EXPECT_THAT(format_g2o(file), HasSubstr("EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n"));
  EXPECT_EQ(optimize(file.graph, {}).report.termination, Termination::converged);
}

TEST(G2oFile, ReplacesAFileOnlyWhole) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "a.g2o";
  const G2oFile file = parse_g2o(kPlanar, "a.g2o");
  write_g2o(path, file);
  write_g2o(path, file);
  EXPECT_EQ(read_g2o(path).ids, file.ids);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  EXPECT_THROW(write_g2o(folder.path() / "absent" / "a.g2o", file), InputError);
  EXPECT_THROW(read_g2o(folder.path() / "absent.g2o"), InputError);
  EXPECT_THROW(read_g2o(folder.path()), InputError);
}

struct Damage {
  const char* text;
  const char* message;
};

// Each text is one way in which a file goes wrong, with what its message must say.
const Damage kDamages[] = {
    {"", "a.g2o: holds no pose"},
    {"\n\n  \n", "holds no pose"},
    {"# only a comment\n", "holds no pose"},
    {"VERTEX_XY 0 1 2\n", "holds no pose"},
    {"FIX 0\n", "holds no pose"},
    {"VERTEX_SE2\n", "a.g2o:1: VERTEX_SE2 line ends too early"},
    {"VERTEX_SE2 0\n", "VERTEX_SE2 has 0 numbers after the ids instead of 3"},
    {"VERTEX_SE2 0 1 2", "has 2 numbers after the ids instead of 3"},
    {"VERTEX_SE2 0 1 2 3 4\n", "more than 3 numbers"},
    {"VERTEX_SE2 x 1 2 3\n", "'x' is not a vertex id"},
    {"VERTEX_SE2 -1 1 2 3\n", "'-1' is not a vertex id"},
    {"VERTEX_SE2 1.5 1 2 3\n", "'1.5' is not a vertex id"},
    {"VERTEX_SE2 99999999999999999999 1 2 3\n", "is not a vertex id"},
    {"VERTEX_SE2 1e3 1 2 3\n", "'1e3' is not a vertex id"},
    {"VERTEX_SE2 0 nan 2 3\n", "'nan' is not a finite number"},
    {"VERTEX_SE2 0 1 inf 3\n", "'inf' is not a finite number"},
    {"VERTEX_SE2 0 1 2 -inf\n", "'-inf' is not a finite number"},
    {"VERTEX_SE2 0 1e999 2 3\n", "'1e999' is not a finite number"},
    {"VERTEX_SE2 0 1,5 2 3\n", "'1,5' is not a number"},
    {"VERTEX_SE2 0 1.2.3 2 3\n", "'1.2.3' is not a number"},
    {"VERTEX_SE2 0 0x10 2 3\n", "'0x10' is not a number"},
    {"VERTEX_SE2 0 - 2 3\n", "'-' is not a number"},
    {"VERTEX_SE2 0 ++1 2 3\n", "'++1' is not a number"},
    {"VERTEX_SE2 0 one 2 3\n", "'one' is not a number"},
    {"VERTEX_SE2 0 1 2 3\nVERTEX_SE2 0 1 2 3\n",
     "a.g2o:2: vertex 0 is defined a second time "
     "(first in line 1)"},
    {"VERTEX_SE2 0 1 2 3VERTEX_SE2 1 1 2 3\n", "'3VERTEX_SE2' is not a number"},
    {"VERTEX_SE2 0 1 2 3\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n", "a.g2o:2: the file mixes"},
    {"VERTEX_SE2 0 1 2 3\nEDGE_SE3:QUAT 0 1 0 0 0 0 0 0 1\n", "a.g2o:2: the file mixes"},
    {"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 0\n", "the quaternion has length 0.000000"},
    {"VERTEX_SE3:QUAT 0 0 0 0 1 1 1 1\n", "the quaternion has length 2.000000"},
    {"VERTEX_SE3:QUAT 0 0 0 0 0 0 1\n", "has 6 numbers after the ids instead of 7"},
    {"VERTEX_SE3:QUAT 0 0 0 0 0 0 nan 1\n", "'nan' is not a finite number"},
    {"VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1e200\n", "the quaternion has length"},
    {"EDGE_SE2\n", "EDGE_SE2 line ends too early"},
    {"EDGE_SE2 0\n", "EDGE_SE2 line ends too early"},
    {"EDGE_SE2 0 1\n", "EDGE_SE2 has 0 numbers"},
    {"EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n", "has 8 numbers after the ids instead of 9"},
    {"EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1 7\n", "more than 9 numbers after the ids: '7'"},
    {"EDGE_SE2 0 0 1 0 0 1 0 0 1 0 1\n", "the edge joins vertex 0 to itself"},
    {"EDGE_SE2 0 -4 1 0 0 1 0 0 1 0 1\n", "'-4' is not a vertex id"},
    {"EDGE_SE2 0 1 nan 0 0 1 0 0 1 0 1\n", "'nan' is not a finite number"},
    {"EDGE_SE2 0 1 1 0 0 1 0 0 inf 0 1\n", "'inf' is not a finite number"},
    {"EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1e\n", "'1e' is not a number"},
    {"EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 1 0 0 0 0 0 1\n",
     "has 14 numbers after the ids instead of 28"},
    {"EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n",
     "the quaternion has length 0.000000"},
    {"EDGE_SE3:QUAT 3 3 1 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n",
     "joins vertex 3 to itself"},
    {"EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 nan\n",
     "'nan' is not a finite number"},
    {"EDGE2 0 1 1 0 0 1 0 0\n", "EDGE2 has 6 numbers"},
    {"VERTEX2 0 1 2 x\n", "VERTEX2: 'x' is not a number"},
    {"VERTEX_SE2 0 1 2 3\nFIX 8\n", "a.g2o:2: FIX of vertex 8, which the file does not hold"},
    {"VERTEX_SE2 0 1 2 3\nFIX\n", "FIX line ends too early"},
    {"VERTEX_SE2 0 1 2 3\nFIX a\n", "'a' is not a vertex id"},
    {"VERTEX_SE2 0 1 2 3\nFIX 0 9\n", "FIX of vertex 9"},
    {"0 1 2 3\n", "a.g2o:1: the line starts with '0' instead of a g2o tag"},
    {"1305031102.17 1.0 2.0 3.0 0 0 0 1\n", "starts with '1305031102.17' instead of a g2o tag"},
    {"VERTEX_SE2 0 1 2 3\n\x01\x02\x03\n", "a.g2o:2: the line starts with '?\?\?'"},
    {"{\"poses\": []}\n", "the line starts with '{\"poses\":'"},
    {"\xff\xfeV\n", "starts with '?\?V'"},
    {"VERTEX_SE2;0;1;2;3\n", "starts with 'VERTEX_SE2;0;1;2;3' instead of a g2o tag"},
    {"<html>\n", "starts with '<html>'"},
    {"-VERTEX_SE2 0 0 0 0\n", "starts with '-VERTEX_SE2'"},
    {"VERTEX_SE2 0 0 0 0\r\nVERTEX_SE2 0 0 0 0\r\n", "a.g2o:2: vertex 0 is defined a second time"},
};

TEST(G2oFile, NamesTheLineAndTheReasonOfEveryDamage) {
  EXPECT_GE(std::size(kDamages), 60u);
  for (const Damage& damage : kDamages) {
    SCOPED_TRACE(damage.text);
    try {
      parse_g2o(damage.text, "a.g2o");
      ADD_FAILURE() << "was read";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(damage.message));
    }
  }
}

TEST(G2oFile, ReadsUnusualButValidTexts) {
  for (const char* text :
       {"VERTEX_SE2 0 +1 2 3", "VERTEX_SE2\t0\t1\t2\t3\r\n", "  VERTEX_SE2 0 1 2 3 # note\n",
        "VERTEX_SE2 0 1e-400 2 3\n", "VERTEX_SE2 9223372036854775807 1 2 3\n",
        "VERTEX_SE3:QUAT 0 0 0 0 0 0 0.001 -0.9999\n"})
    EXPECT_EQ(parse_g2o(text, "a.g2o").graph.poses.size(), 1u) << text;
}

TEST(G2oFile, CutAnywhereIsReadOrRefusedButNeverBreaks) {
  const std::string text = std::string(kPlanar) + "FIX 0\n";
  for (size_t length = 0; length < text.size(); ++length) {
    try {
      EXPECT_LE(parse_g2o(std::string_view(text).substr(0, length), "a.g2o").graph.poses.size(),
                2u);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("a.g2o"));
    }
  }
}

struct Reference {
  const char* name;
  double chi2;
};

// Best known optima by the definition of the format.
const Reference kReferences[] = {
    {"intel", 45.004696},    {"CSAIL", 40.555129},          {"manhattan", 3549.0368},
    {"kitti_00", 98.322012}, {"city10000", 511.98516},      {"sphere2500", 727.14967},
    {"torus3D", 14574.746},  {"parking-garage", 1.2386906},
};

TEST(StandardGraphs, ReachTheBestKnownOptimumFromTheFileAndWithoutItsGuess) {
  for (const Reference& reference : kReferences) {
    const std::string relative = "pose_graphs/" + std::string(reference.name) + ".g2o";
    HMT_REQUIRE_REAL_DATA(relative);
    SCOPED_TRACE(reference.name);
    G2oFile file = read_g2o(hmt::test::data_dir() / relative);
    PoseOptimizerOptions options;
    options.initialization = Initialization::best;
    for (int guess = 0; guess < 2; ++guess) {
      const PoseOptimizerReport report = optimize(file.graph, options).report;
      EXPECT_EQ(report.termination, Termination::converged);
      EXPECT_NEAR(report.chi2, reference.chi2, 1e-6 * reference.chi2);
      for (Pose& pose : file.graph.poses) pose = Pose{};
    }
  }
}

}  // namespace
}  // namespace hmt::graph
