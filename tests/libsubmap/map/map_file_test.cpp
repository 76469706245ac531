// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/map/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <thread>

#include "sample_map.hpp"

namespace hmt::submap {
namespace {

using test::sample_map;
using test::sample_observation;
using test::sample_origin;
using test::TemporaryFolder;
using test::write_sample_map;
using testing::HasSubstr;

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MapFile, GivesBackEveryRecordExactly) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  const HybridMap expected = sample_map();
  const MapFile file = MapFile::open(folder / "a.hmt");
  const HybridMap map = file.load_map();
  EXPECT_EQ(map.track, expected.track);
  EXPECT_EQ(map.constraints, expected.constraints);
  ASSERT_EQ(map.overlap.size(), 1u);
  EXPECT_EQ(map.overlap[0].b, 1);
  EXPECT_EQ(map.overlap[0].weight, 1.0 / 3);
  EXPECT_EQ(map.submap_of_keyframe, expected.submap_of_keyframe);
  EXPECT_EQ(map.submaps, expected.submaps);
  EXPECT_EQ(map.links, expected.links);
  EXPECT_EQ(map.loops, expected.loops);
  EXPECT_EQ(map.T_world_submap, expected.T_world_submap);
  EXPECT_EQ(map.covariance_world_submap, expected.covariance_world_submap);
  EXPECT_EQ(map.information_loss, expected.information_loss);
  EXPECT_EQ(map.chi2_initial, expected.chi2_initial);
  EXPECT_EQ(map.chi2, expected.chi2);
  EXPECT_EQ(file.origin(), sample_origin());
  EXPECT_EQ(file.num_observations(), 3);
  EXPECT_EQ(*file.load(2), sample_observation(2));
}

TEST(MapFile, KeepsNoMoreObservationsThanItsCacheHolds) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  MapFile file = MapFile::open(folder / "a.hmt");
  const auto first = file.load(0);
  file.load(1);
  EXPECT_EQ(file.load(0), first);
  file.set_cache_bytes(1);
  file.load(1);
  EXPECT_NE(file.load(0), first);
  EXPECT_EQ(*file.load(0), *first);
}

TEST(MapFile, KeepsTheSignOfAZero) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  const Track track = MapFile::open(folder / "a.hmt").load_track();
  EXPECT_TRUE(std::signbit(track.keyframes[1].T_track_robot.translation.y()));
}

TEST(MapFile, HoldsExactlyTheCommittedStages) {
  const TemporaryFolder folder;
  const auto path = folder / "a.hmt";
  const HybridMap map = sample_map();
  {
    MapFile file = MapFile::open_for_run(path, sample_origin(), MapFile::Existing::resume);
    StageWriter overlap = file.begin("overlap");
    overlap.put_overlap(map.overlap);
    overlap.commit();
    StageWriter unfinished = file.begin("partition");
    unfinished.put_partition(map.submap_of_keyframe);
    unfinished.put_overlap({});
  }
  MapFile file = MapFile::open_for_run(path, sample_origin(), MapFile::Existing::resume);
  EXPECT_EQ(file.stages(), std::vector<std::string>{"overlap"});
  EXPECT_TRUE(file.finished("overlap"));
  EXPECT_FALSE(file.finished("partition"));
  EXPECT_EQ(file.load_overlap().size(), 1u);
  EXPECT_THAT(error_of([&] { file.load_partition(); }), HasSubstr("not finished"));
  EXPECT_THAT(error_of([&] { file.begin("overlap"); }), HasSubstr("finished already"));
}

/// Runs an action that ends with raise(SIGKILL) in a process of its own; true if it got that far.
bool dies_in(const std::function<void()>& action) {
  const pid_t child = fork();
  if (child == 0) {
    action();
    _exit(1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
}

TEST(MapFile, AKilledStageLeavesTheStagesBeforeIt) {
  const TemporaryFolder folder;
  const auto path = folder / "a.hmt";
  ASSERT_TRUE(dies_in([&] {
    MapFile file = MapFile::open_for_run(path, sample_origin(), MapFile::Existing::resume);
    StageWriter first = file.begin("first");
    first.put_overlap(sample_map().overlap);
    first.commit();
    StageWriter second = file.begin("second");
    second.put_overlap({});
    // Beyond the page cache, so that part of it is in the file already.
    for (int64_t k = 0; k < 10000; ++k) second.add(sample_observation(k));
    raise(SIGKILL);
  }));
  EXPECT_TRUE(std::filesystem::exists(path.string() + "-journal"));
  EXPECT_EQ(MapFile::open(path).num_observations(), 0);
  MapFile file = MapFile::open_for_run(path, sample_origin(), MapFile::Existing::resume);
  EXPECT_EQ(file.stages(), std::vector<std::string>{"first"});
  EXPECT_EQ(file.load_overlap().size(), 1u);
}

TEST(MapFile, AFullDiskIsNamedAndLosesNothing) {
  const TemporaryFolder folder;
  const auto path = folder / "a.hmt";
  write_sample_map(path);
  MapFile file = MapFile::open_for_run(path, sample_origin(), MapFile::Existing::resume);
  // A limit on the size of files stands for the disk.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{std::filesystem::file_size(path) + 4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of([&] {
    StageWriter stage = file.begin("more");
    for (int64_t k = 100; k < 20000; ++k) stage.add(sample_observation(k));
    stage.commit();
  });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(error, HasSubstr(path.string()));
  EXPECT_FALSE(file.finished("more"));
  EXPECT_EQ(MapFile::open(path).load_map().submaps, sample_map().submaps);
}

TEST(MapFile, IsOneFileOnceClosed) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  const auto entries = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  EXPECT_EQ(entries, 1);
}

TEST(MapFile, ANewPartitionRemovesWhatHungOnTheFormerOne) {
  const TemporaryFolder folder;
  const auto path = folder / "a.hmt";
  write_sample_map(path);
  MapFile file = MapFile::open_for_run(path, sample_origin(), MapFile::Existing::resume);
  StageWriter next = file.begin("round2.partition");
  next.put_partition({0, 0});
  next.commit();
  EXPECT_EQ(file.load_partition(), (graph::Labels{0, 0}));
  EXPECT_TRUE(file.load_submaps().empty());
  EXPECT_THAT(error_of([&] { file.load_links(); }), HasSubstr("not finished"));
  EXPECT_THAT(error_of([&] { file.load_solution(); }), HasSubstr("not finished"));
  EXPECT_EQ(file.load_loops(), sample_map().loops);
}

TEST(MapFile, KeepsOctreeAndEstimate) {
  const TemporaryFolder folder;
  MapFile file =
      MapFile::open_for_run(folder / "a.hmt", sample_origin(), MapFile::Existing::resume);
  StageWriter stage = file.begin("octrees");
  const std::string bytes("ot\0bytes", 8);
  stage.put_octree(3, bytes);
  stage.put_estimate(sample_map().T_world_submap);
  stage.commit();
  EXPECT_TRUE(file.has_octree(3));
  EXPECT_FALSE(file.has_octree(0));
  EXPECT_EQ(file.load_octree(3), bytes);
  EXPECT_EQ(file.load_estimate(), sample_map().T_world_submap);
  EXPECT_THAT(error_of([&] { file.load_octree(0); }), HasSubstr("octree of submap 0"));
}

TEST(MapFile, IsCompleteOnceEverySubmapHasAnOctree) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  MapFile file =
      MapFile::open_for_run(folder / "a.hmt", sample_origin(), MapFile::Existing::resume);
  for (int submap = 0; submap < 2; ++submap) {
    EXPECT_FALSE(file.complete());
    StageWriter stage = file.begin("octree" + std::to_string(submap));
    stage.put_octree(submap, "ot");
    stage.commit();
  }
  EXPECT_TRUE(file.complete());
}

/// What load_map says of the sample map after a change.
std::string error_of_map(const std::function<void(StageWriter&)>& change) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  MapFile file =
      MapFile::open_for_run(folder / "a.hmt", sample_origin(), MapFile::Existing::resume);
  StageWriter stage = file.begin("change");
  change(stage);
  stage.commit();
  return error_of([&] { file.load_map(); });
}

TEST(MapFile, RefusesPartsThatDoNotFitTogether) {
  const HybridMap map = sample_map();
  const auto links_with = [&](auto change) {
    return [&, change](StageWriter& stage) {
      std::vector<Link> links = map.links;
      change(links[0]);
      stage.put_links(links);
    };
  };
  EXPECT_EQ(error_of_map([](StageWriter&) {}), "");
  EXPECT_THAT(error_of_map(links_with([](Link& link) { link.b = 2; })), HasSubstr("link"));
  EXPECT_THAT(error_of_map(links_with([](Link& link) { link.evidence = {-1}; })),
              HasSubstr("evidence"));
  EXPECT_THAT(error_of_map([&](StageWriter& stage) {
                Submap submap = map.submaps[1];
                submap.keyframes = {0};
                stage.put_submap(submap);
              }),
              HasSubstr("keyframe of another one"));
  EXPECT_THAT(error_of_map([&](StageWriter& stage) { stage.put_constraints({}); }),
              HasSubstr("do not fit together"));
  EXPECT_THAT(error_of_map([&](StageWriter& stage) { stage.put_solution({}); }),
              HasSubstr("one pose a submap"));
}

TEST(MapFile, RefusesAnotherLogOrOtherOptions) {
  const TemporaryFolder folder;
  const auto path = folder / "a.hmt";
  write_sample_map(path);
  MapOrigin other_log = sample_origin();
  other_log.log_digest = "ffff";
  EXPECT_THAT(error_of([&] { MapFile::open_for_run(path, other_log, MapFile::Existing::resume); }),
              HasSubstr("another log"));
  MapOrigin other_options = sample_origin();
  other_options.options_json = R"({"partition":{"tau":0.7}})";
  EXPECT_THAT(
      error_of([&] { MapFile::open_for_run(path, other_options, MapFile::Existing::resume); }),
      HasSubstr("option partition/tau was 0.5 and is now 0.7"));
  EXPECT_TRUE(MapFile::open(path).finished("rest"));
  EXPECT_FALSE(
      MapFile::open_for_run(path, other_options, MapFile::Existing::replace).finished("rest"));
}

TEST(MapFile, LoadsFromManyThreads) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  const MapFile file = MapFile::open(folder / "a.hmt");
  std::vector<std::thread> threads;
  std::array<bool, 4> good{};
  for (size_t t = 0; t < good.size(); ++t)
    threads.emplace_back([&, t] {
      bool all = true;
      for (int64_t k = 0; k < 300; ++k) all = all && *file.load(k % 3) == sample_observation(k % 3);
      good[t] = all;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(good, testing::Each(true));
}

TEST(MapFile, OpensInAReadOnlyFolder) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  namespace fs = std::filesystem;
  fs::permissions(folder / "a.hmt", fs::perms::owner_read);
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(MapFile::open(folder / "a.hmt").load_map().submaps.size(), 2u);
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(MapFile, NamesWhatIsNotAMap) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { MapFile::open(folder / "absent.hmt"); }), HasSubstr("no such file"));
  EXPECT_THAT(error_of([&] { MapFile::open(folder.path()); }), HasSubstr("a folder"));
  std::ofstream(folder / "empty.hmt").flush();
  EXPECT_THAT(error_of([&] { MapFile::open(folder / "empty.hmt"); }), HasSubstr("empty file"));
  std::ofstream(folder / "text.hmt") << std::string(5000, 'x');
  EXPECT_THAT(error_of([&] { MapFile::open(folder / "text.hmt"); }), HasSubstr("not a database"));
  EXPECT_THAT(error_of([&] {
                MapFile::open_for_run(folder / "none/a.hmt", sample_origin(),
                                      MapFile::Existing::resume);
              }),
              HasSubstr("check the path"));
}

/// Overwrites bytes of a file.
void patch(const std::filesystem::path& path, std::streamoff at, const std::string& bytes) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(at);
  file << bytes;
}

// The SQLite header has user_version at byte 60 and application_id at byte 68, big endian.
TEST(MapFile, NamesAnotherApplicationAndOtherVersions) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.hmt");
  write_sample_map(folder / "b.hmt");
  patch(folder / "a.hmt", 68, "GPKG");
  EXPECT_THAT(error_of([&] { MapFile::open(folder / "a.hmt"); }), HasSubstr("not a map file"));
  patch(folder / "b.hmt", 60, std::string("\0\0\0\x63", 4));
  EXPECT_THAT(error_of([&] { MapFile::open(folder / "b.hmt"); }), HasSubstr("version 99 is newer"));
  patch(folder / "b.hmt", 60, std::string("\0\0\0\x01", 4));
  EXPECT_THAT(error_of([&] { MapFile::open(folder / "b.hmt"); }),
              HasSubstr("version 1 was written by an older program"));
}

/// Reads all of a map; true if it was read, false if it was refused with an InputError.
bool reads(const std::filesystem::path& path) {
  try {
    const MapFile file = MapFile::open(path);
    const HybridMap map = file.load_map();
    for (int64_t k = 0; k < 3; ++k) file.load(k);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

TEST(MapFile, RefusesATruncatedFile) {
  const TemporaryFolder folder;
  const auto path = folder / "a.hmt";
  write_sample_map(path);
  const auto size = std::filesystem::file_size(path);
  for (uintmax_t k = 1; k <= 20; ++k) {
    std::filesystem::resize_file(path, size * (20 - k) / 20);
    EXPECT_FALSE(reads(path)) << "cut to " << 20 - k << "/20";
  }
}

TEST(MapFile, NeverTakesFlippedBytesForGoodOnes) {
  const TemporaryFolder folder;
  const auto path = folder / "a.hmt";
  write_sample_map(path);
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(path));
  const HybridMap expected = sample_map();
  uint64_t random = 12345;
  for (int k = 0; k < 200; ++k) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    const auto at = static_cast<std::streamoff>(random >> 33) % size;
    const auto damaged = folder / "b.hmt";
    std::filesystem::copy_file(path, damaged, std::filesystem::copy_options::overwrite_existing);
    patch(damaged, at, std::string(1, static_cast<char>(random >> 25)));
    if (!reads(damaged)) continue;
    // The byte was unused, or the same as before.
    const HybridMap map = MapFile::open(damaged).load_map();
    EXPECT_EQ(map.track, expected.track) << "byte " << at;
    EXPECT_EQ(map.submaps, expected.submaps) << "byte " << at;
    EXPECT_EQ(map.links, expected.links) << "byte " << at;
    EXPECT_EQ(map.T_world_submap, expected.T_world_submap) << "byte " << at;
  }
}

TEST(LogDigest, SeesContentAndNotTheName) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a") << "one";
  std::ofstream(folder / "b") << "one";
  std::ofstream(folder / "c") << "onf";
  EXPECT_EQ(log_digest(folder / "a"), log_digest(folder / "b"));
  EXPECT_NE(log_digest(folder / "a"), log_digest(folder / "c"));
  EXPECT_THAT(error_of([&] { log_digest(folder / "d"); }), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace hmt::submap
