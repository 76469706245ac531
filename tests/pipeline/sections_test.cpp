// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hmt/submap/export/carmen_file.hpp"
#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/log/simulation.hpp"
#include "hmt/submap/map/placed_observation.hpp"
#include "hmt/submap/pipeline.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

/// Four rounds through some rooms, gone through in sections of less than two rounds.
class Sections : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    Simulation simulation({.world = "rooms", .laps = 4});
    CarmenWriter writer(folder_->path() / "log");
    while (const auto scan = simulation.next()) {
      const Observation& o = scan->observation;
      writer.add(scan->ranges_m, o.T_odom_robot * o.readings.at(0).T_robot_sensor, o.T_odom_robot,
                 o.stamp_s);
      truth_.push_back({o.stamp_s, scan->T_world_robot});
    }
    writer.commit();
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static Options options() {
    Options options;
    options.sections = {.keyframes = 250};
    return options;
  }
  static HybridMap map(const std::string& name, const Options& options, const submap::Run& run) {
    return build_map(folder_->path() / "log", folder_->path() / name, options,
                     MapFile::Existing::resume, run)
        .file.load_map();
  }

  inline static std::unique_ptr<test::TemporaryFolder> folder_;
  inline static std::vector<StampedPose> truth_;
};

TEST_F(Sections, KeepAMapOfWhatIsThereAndATrajectoryOfAll) {
  const Track whole =
      track_log(*open_log(folder_->path() / "log"), {}, [](const auto&) {}, {}).track;
  const HybridMap thin = map("thin.hmt", options(), {});
  EXPECT_LT(thin.track.keyframes.size(), 0.8 * static_cast<double>(whole.keyframes.size()));
  const TrajectoryError error = evaluate_trajectory(stamped_trajectory(thin), truth_);
  EXPECT_EQ(error.matched, std::ssize(truth_));
  EXPECT_LT(error.ate_rmse_m, 0.03);
  for (size_t k = 0; k < thin.track.keyframes.size(); ++k)
    EXPECT_EQ(thin.track.keyframes[k].id, static_cast<int>(k));
  // Scans of keyframes that went belong to the submaps of those that they hang on.
  size_t observations = 0;
  for (const Submap& submap : thin.submaps)
    observations += observations_in_submap(thin.track, submap).size();
  EXPECT_EQ(observations, truth_.size());
}

TEST_F(Sections, GoOnAfterAStopAndEndWithTheSameMapOnTwoThreads) {
  const HybridMap expected = map("thin.hmt", options(), {});
  submap::Run run;
  run.threads = 2;
  bool stop = false;
  run.info = [&stop](const std::string& text) { stop = stop || text.starts_with("section1:"); };
  run.stop = [&stop] { return stop; };
  EXPECT_THROW(map("stopped.hmt", options(), run), Interrupted);
  {
    const MapFile file = MapFile::open(folder_->path() / "stopped.hmt");
    EXPECT_TRUE(file.finished("section1"));
    EXPECT_FALSE(file.finished("section2"));
    EXPECT_LT(file.load_estimate().size(), file.load_track().keyframes.size());
  }
  run.stop = nullptr;
  const HybridMap resumed = map("stopped.hmt", options(), run);
  EXPECT_EQ(resumed.track, expected.track);
  EXPECT_EQ(resumed.constraints, expected.constraints);
  EXPECT_EQ(resumed.loops, expected.loops);
  EXPECT_EQ(resumed.submaps, expected.submaps);
  EXPECT_EQ(resumed.T_world_submap, expected.T_world_submap);
}

TEST_F(Sections, RefuseSizesThatAreNone) {
  Options none;
  none.sections.keyframes = 0;
  EXPECT_THROW(map("none.hmt", none, {}), InputError);
}

}  // namespace
}  // namespace hmt::submap
