// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "check_map.hpp"
#include "digest.hpp"
#include "map_file_impl.hpp"
#include "observation_codec.hpp"
#include "table.hpp"

namespace hmt::submap {
namespace {

// An octree of 5 cm cells that fills this would cover square kilometres.
constexpr size_t kMaxOctreeBytes = size_t{1} << 30;

LogReport read_log_report(Database& database, const TrackRecord& track) {
  LogReport report;
  report.observations = track.observations;
  report.odometry_records = track.odometry_records;
  for (const LogNote& note : read_list<LogNote>(database, "log_notes"))
    (note.loss != 0 ? report.losses : report.notes)[note.text] = note.count;
  return report;
}

void read_submap_keyframes(Database& database, Submap& submap, Digest& digest) {
  Statement select(database, "SELECT * FROM submap_keyframes WHERE submap = ? ORDER BY position");
  select.bind(1, int64_t{submap.id});
  while (select.step()) {
    RowReader row(select, digest);
    int64_t id = 0;
    int64_t position = 0;
    SubmapKeyframe record;
    row(id, position);
    fields(row, record);
    submap.keyframes.push_back(record.keyframe);
    submap.T_submap_keyframe.push_back(record.T_submap_keyframe);
    submap.covariances.push_back(record.covariance);
  }
}

void read_submap_constraints(Database& database, Submap& submap, Digest& digest) {
  Statement select(database, "SELECT * FROM submap_constraints WHERE submap = ? ORDER BY position");
  select.bind(1, int64_t{submap.id});
  while (select.step()) {
    RowReader row(select, digest);
    int64_t id = 0;
    int64_t position = 0;
    row(id, position, submap.constraints.emplace_back());
  }
}

void read_submap_landmarks(Database& database, Submap& submap, Digest& digest) {
  Statement select(database, "SELECT * FROM submap_landmarks WHERE submap = ? ORDER BY position");
  select.bind(1, int64_t{submap.id});
  while (select.step()) {
    RowReader row(select, digest);
    int64_t id = 0;
    int64_t position = 0;
    row(id, position);
    fields(row, submap.landmarks.emplace_back());
  }
}

/// The submap in the current row of table submaps.
Submap read_submap(Database& database, const Statement& select) {
  Digest digest;
  RowReader row(select, digest);
  Submap submap;
  int64_t keyframes = 0;
  int64_t constraints = 0;
  row(submap.id, submap.chi2, submap.degrees_of_freedom, keyframes, constraints);
  read_submap_keyframes(database, submap, digest);
  read_submap_constraints(database, submap, digest);
  read_submap_landmarks(database, submap, digest);
  if (select.integer(kSubmapDigestColumn) != static_cast<int64_t>(digest.value()))
    database.fail_damaged("submap " + std::to_string(submap.id) + " does not match its checksum");
  return submap;
}

}  // namespace

bool MapFile::complete() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->database.query_integer(
             "SELECT EXISTS (SELECT 1 FROM contents WHERE name = 'solution') AND NOT EXISTS "
             "(SELECT 1 FROM submaps WHERE id NOT IN (SELECT submap FROM octrees))") == 1;
}

Track MapFile::load_track() const {
  const std::lock_guard lock(impl_->mutex);
  Database& database = impl_->database;
  const auto records = read_list<TrackRecord>(database, "track");
  if (records.size() != 1) database.fail_damaged("table track has not one row");
  Track track;
  track.space = records[0].space;
  track.log = read_log_report(database, records[0]);
  track.keyframes = read_list<Keyframe>(database, "keyframes");
  for (size_t k = 0; k < track.keyframes.size(); ++k) track.keyframes[k].id = static_cast<int>(k);
  track.observations = read_list<TrackedObservation>(database, "tracked");
  track.odometry = read_list<Constraint>(database, "odometry");
  return track;
}

std::vector<Constraint> MapFile::load_constraints() const {
  const std::lock_guard lock(impl_->mutex);
  return read_list<Constraint>(impl_->database, "constraints");
}

std::vector<Sighting> MapFile::load_sightings() const {
  const std::lock_guard lock(impl_->mutex);
  return read_list<Sighting>(impl_->database, "sightings");
}

std::vector<int64_t> MapFile::load_landmark_names() const {
  const std::lock_guard lock(impl_->mutex);
  return read_list<int64_t>(impl_->database, "landmark_names");
}

std::vector<graph::Arc> MapFile::load_overlap() const {
  const std::lock_guard lock(impl_->mutex);
  return read_list<graph::Arc>(impl_->database, "overlap");
}

graph::Labels MapFile::load_partition() const {
  const std::lock_guard lock(impl_->mutex);
  return read_list<int>(impl_->database, "partition_labels");
}

std::vector<Submap> MapFile::load_submaps() const {
  const std::lock_guard lock(impl_->mutex);
  Statement select(impl_->database, "SELECT * FROM submaps ORDER BY id");
  std::vector<Submap> submaps;
  while (select.step()) submaps.push_back(read_submap(impl_->database, select));
  return submaps;
}

std::vector<Link> MapFile::load_links() const {
  const std::lock_guard lock(impl_->mutex);
  Database& database = impl_->database;
  auto links = read_list<Link>(database, "links");
  for (const auto& [table, numbers] :
       {std::pair{"link_evidence", &Link::evidence}, {"link_landmarks", &Link::landmarks}})
    for (const LinkEvidence& e : read_list<LinkEvidence>(database, table)) {
      if (e.link < 0 || static_cast<size_t>(e.link) >= links.size())
        database.fail_damaged("evidence of a link that is not there");
      (links[static_cast<size_t>(e.link)].*numbers).push_back(e.number);
    }
  return links;
}

std::vector<LoopCandidate> MapFile::load_loops() const {
  const std::lock_guard lock(impl_->mutex);
  return read_list<LoopCandidate>(impl_->database, "loop_candidates");
}

MapSolution MapFile::load_solution() const {
  const std::lock_guard lock(impl_->mutex);
  Database& database = impl_->database;
  const auto records = read_list<SolutionRecord>(database, "solution");
  if (records.size() != 1) database.fail_damaged("table solution has not one row");
  MapSolution solution;
  solution.information_loss = records[0].information_loss;
  solution.chi2_initial = records[0].chi2_initial;
  solution.chi2 = records[0].chi2;
  solution.division = records[0].division;
  solution.landmark_information_loss = records[0].landmark_information_loss;
  solution.landmarks = read_list<PlacedLandmark>(database, "landmarks");
  for (const SubmapPose& pose : read_list<SubmapPose>(database, "submap_poses")) {
    solution.T_world_submap.push_back(pose.T_world_submap);
    solution.covariance_world_submap.push_back(pose.covariance);
  }
  return solution;
}

std::vector<Pose> MapFile::load_estimate() const {
  const std::lock_guard lock(impl_->mutex);
  return read_list<Pose>(impl_->database, "estimate");
}

bool MapFile::has_octree(int submap) const {
  const std::lock_guard lock(impl_->mutex);
  Statement find(impl_->database, "SELECT 1 FROM octrees WHERE submap = ?");
  find.bind(1, int64_t{submap});
  return find.step();
}

std::string MapFile::load_octree(int submap) const {
  const std::lock_guard lock(impl_->mutex);
  Database& database = impl_->database;
  const std::string name = "the octree of submap " + std::to_string(submap);
  Statement find(database, "SELECT digest, ot_zstd FROM octrees WHERE submap = ?");
  find.bind(1, int64_t{submap});
  if (!find.step())
    throw InputError(database.path().string() + ": the map is not finished, it has not yet " +
                     name + "; run the same hmtmap map command again");
  const std::string_view frame = find.blob(1);
  if (static_cast<int64_t>(digest_of(frame)) != find.integer(0))
    database.fail_damaged(name + " does not match its checksum");
  std::optional<std::string> bytes = decompress(frame, kMaxOctreeBytes);
  if (!bytes) database.fail_damaged(name + " cannot be decoded");
  return std::move(*bytes);
}

HybridMap MapFile::load_map() const {
  HybridMap map;
  map.track = load_track();
  map.constraints = load_constraints();
  map.sightings = load_sightings();
  map.landmark_names = load_landmark_names();
  map.overlap = load_overlap();
  map.submap_of_keyframe = load_partition();
  map.submaps = load_submaps();
  map.links = load_links();
  map.loops = load_loops();
  MapSolution solution = load_solution();
  map.T_world_submap = std::move(solution.T_world_submap);
  map.covariance_world_submap = std::move(solution.covariance_world_submap);
  map.information_loss = solution.information_loss;
  map.chi2_initial = solution.chi2_initial;
  map.chi2 = solution.chi2;
  map.division = solution.division;
  map.landmark_information_loss = solution.landmark_information_loss;
  map.landmarks = std::move(solution.landmarks);
  check_map(impl_->database, map);
  return map;
}

}  // namespace hmt::submap
