// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hmt/submap/map/hybrid_map.hpp"
#include "hmt/submap/observation/observation_store.hpp"

namespace hmt::submap {

/// What a map was made from. A run goes on with a map file only if log and options are the same.
struct MapOrigin {
  std::string log_path;  ///< as the user gave it; for information only
  std::string log_digest;
  std::string options_json;
  std::string program_version;  ///< for information only

  bool operator==(const MapOrigin&) const = default;
};

/// Digest of a log file, or of a folder's files with their names: sizes and contents. Of files
/// beyond 64 MB only evenly spread blocks are read. Throws InputError if it cannot be read.
std::string log_digest(const std::filesystem::path& log);

/// Where the submaps stand in the world, and what the submap graph says of itself.
struct MapSolution {
  std::vector<Pose> T_world_submap;
  std::vector<Matrix6d> covariance_world_submap;  ///< tangent of Pose, frame submap
  double information_loss = 0;
  double chi2_initial = 0;
  double chi2 = 0;
  DivisionCost division;
  double landmark_information_loss = 0;
  std::vector<PlacedLandmark> landmarks;  ///< in the world

  bool operator==(const MapSolution&) const = default;
};

class StageWriter;

/// The map file: one SQLite database (schema in libsubmap/README.md). Every stage commits its
/// result in one transaction, so that after a kill at any moment it holds exactly the finished
/// stages. A second process may read it meanwhile. Reading is safe from many threads at once;
/// writing is for one thread at a time, while others may load observations.
///
/// Every call throws InputError with path, reason and advice for a full disk, a read-only folder,
/// and a file that is damaged, of another program, or of a newer version.
class MapFile : public ObservationStore {
 public:
  /// What to do with a file that is already there.
  enum class Existing {
    resume,  ///< go on with it; refused with the reason unless log and options are the same
    replace  ///< delete it, whatever it is
  };

  /// Opens for reading.
  static MapFile open(const std::filesystem::path& path);
  /// Opens for a run: creates the file or goes on with it.
  static MapFile open_for_run(const std::filesystem::path& path, const MapOrigin& origin,
                              Existing existing);
  /// Closes the map and deletes it.
  static void discard(MapFile file);
  /// Opens a map that is there, to change it.
  static MapFile open_for_change(const std::filesystem::path& path);
  ~MapFile() override;
  MapFile(MapFile&&) noexcept;
  MapFile& operator=(MapFile&&) noexcept;

  const std::filesystem::path& path() const;
  MapOrigin origin() const;
  /// True if the stage of that key was committed.
  bool finished(std::string_view stage) const;
  /// Keys of the finished stages in the order of their commits.
  std::vector<std::string> stages() const;
  /// True once there is a solution and an octree for every submap, so that all can be loaded.
  bool complete() const;
  /// Begins a stage; nothing of it is in the file before its commit. One at a time; the map file
  /// must outlive it and stay where it is.
  StageWriter begin(const std::string& stage);

  /// From the file, through a cache of the recently used ones (64 MB unless set_cache_bytes()).
  std::shared_ptr<const Observation> load(int64_t index) const override;
  int64_t num_observations() const;
  /// What the observations kept in memory may take; the one last read stays in any case.
  void set_cache_bytes(size_t bytes);

  /// Each throws InputError where its stage has not been finished.
  Track load_track() const;
  std::vector<Constraint> load_constraints() const;
  std::vector<Sighting> load_sightings() const;
  std::vector<int64_t> load_landmark_names() const;
  std::vector<graph::Arc> load_overlap() const;
  graph::Labels load_partition() const;
  std::vector<Submap> load_submaps() const;
  std::vector<Link> load_links() const;
  std::vector<LoopCandidate> load_loops() const;
  MapSolution load_solution() const;
  /// T_world_keyframe as of the last put_estimate.
  std::vector<Pose> load_estimate() const;
  /// The OctoMap of a submap in OctoMap's .ot format.
  std::string load_octree(int submap) const;
  /// True if an octree is there for that submap.
  bool has_octree(int submap) const;
  /// All of the above but observations, octrees and the estimate; checks that they fit together.
  HybridMap load_map() const;

 private:
  friend class StageWriter;
  struct Impl;
  explicit MapFile(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The transaction of one stage. A value that is put replaces the former one. Destroyed without
/// commit it leaves the file as it was.
class StageWriter {
 public:
  ~StageWriter();
  StageWriter(StageWriter&&) noexcept;
  StageWriter& operator=(StageWriter&&) noexcept;

  /// Adds one observation; its index must be new.
  void add(const Observation& observation);
  void put_track(const Track& track);
  void put_constraints(std::span<const Constraint> constraints);
  void put_sightings(std::span<const Sighting> sightings);
  /// What the log calls landmark 0, 1, ..; kUnknownLandmark where it has no name for it.
  void put_landmark_names(std::span<const int64_t> names);
  void put_overlap(std::span<const graph::Arc> overlap);
  /// Also removes what belongs to the former partition: submaps, links, solution and octrees.
  void put_partition(const graph::Labels& submap_of_keyframe);
  /// One submap, by its id.
  void put_submap(const Submap& submap);
  void put_links(std::span<const Link> links);
  void put_loops(std::span<const LoopCandidate> loops);
  void put_solution(const MapSolution& solution);
  /// The best current poses of the keyframes, for a restart to go on from.
  void put_estimate(std::span<const Pose> T_world_keyframe);
  /// The OctoMap of a submap in OctoMap's .ot format.
  void put_octree(int submap, std::string_view ot_bytes);
  /// Forgets that the stages after the track are finished, and removes what belongs to the
  /// partition: the run goes on from the constraints, loops and estimate that are put now.
  void reopen();
  /// Records the stage as finished, together with all that was put.
  void commit();

 private:
  friend class MapFile;
  struct Impl;
  explicit StageWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace hmt::submap
