// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <ostream>
#include <string>

#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/pipeline.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

/// Largest errors that a log may have with the default options.
struct Bound {
  const char* log;
  double trans_mean_m;  ///< of the relations; 0 where the log has none
  double rot_mean_deg;
  double ate_m;  ///< against the reference
};

std::ostream& operator<<(std::ostream& out, const Bound& bound) {
  return out << bound.log;
}

class RealLog : public testing::TestWithParam<Bound> {};

TEST_P(RealLog, IsMappedWithinItsBounds) {
  const Bound& bound = GetParam();
  const std::string stem = std::string("laser2d/") + bound.log;
  HMT_REQUIRE_REAL_DATA(stem + ".clf.bz2");
  const test::TemporaryFolder folder;
  hmt::submap::Run run;
  run.threads = 2;
  const BuildResult result =
      build_map(test::data_dir() / (stem + ".clf.bz2"), folder.path() / "map.hmt", {},
                MapFile::Existing::resume, run);
  const auto trajectory = stamped_trajectory(result.file.load_map());
  if (bound.trans_mean_m > 0) {
    const auto relations = read_relations(test::data_dir() / (stem + ".relations"));
    const RelationsError error = evaluate_relations(trajectory, relations);
    EXPECT_EQ(error.relations_used, static_cast<int64_t>(relations.size()));
    EXPECT_LT(error.trans_mean_m, bound.trans_mean_m);
    EXPECT_LT(error.rot_mean_rad * 180 / std::numbers::pi, bound.rot_mean_deg);
  }
  const auto reference = read_tum(test::data_dir() / (stem + ".keyframes.tum"));
  EXPECT_LT(evaluate_trajectory(trajectory, reference).ate_rmse_m, bound.ate_m);
}

INSTANTIATE_TEST_SUITE_P(Laser2d, RealLog,
                         testing::Values(Bound{"intel", 0.05, 1.0, 0.5},
                                         Bound{"fr079", 0.07, 0.9, 0.5},
                                         Bound{"mit-csail", 0, 0, 0.5}, Bound{"fr101", 0, 0, 0.5},
                                         Bound{"seattle", 0, 0, 0.5}),
                         [](const auto& param_info) {
                           std::string name = param_info.param.log;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace hmt::submap
