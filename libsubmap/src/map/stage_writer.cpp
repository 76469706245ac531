// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "digest.hpp"
#include "map_file_impl.hpp"
#include "observation_codec.hpp"
#include "table.hpp"

namespace hmt::submap {
namespace {

void put_log_report(Database& database, const Track& track) {
  const TrackRecord record{track.space, track.log.observations, track.log.odometry_records};
  write_list<TrackRecord>(database, "track", {&record, 1});
  std::vector<LogNote> notes;
  for (const auto& [text, count] : track.log.notes) notes.push_back({0, text, count});
  for (const auto& [text, count] : track.log.losses) notes.push_back({1, text, count});
  write_list<LogNote>(database, "log_notes", notes);
}

void erase_submap(Database& database, int id) {
  for (const char* sql :
       {"DELETE FROM submaps WHERE id = ?", "DELETE FROM submap_keyframes WHERE submap = ?",
        "DELETE FROM submap_constraints WHERE submap = ?",
        "DELETE FROM submap_landmarks WHERE submap = ?"}) {
    Statement erase(database, sql);
    erase.bind(1, int64_t{id});
    erase.run();
  }
}

void erase_of_partition(Database& database) {
  for (const char* table :
       {"submaps", "submap_keyframes", "submap_constraints", "submap_landmarks", "links",
        "link_evidence", "link_landmarks", "solution", "submap_poses", "landmarks", "octrees"})
    erase_list(database, table);
}

void put_submap_keyframes(Database& database, const Submap& submap, Digest& digest) {
  Statement insert(database, insert_sql(database, "submap_keyframes"));
  for (size_t k = 0; k < submap.keyframes.size(); ++k) {
    const SubmapKeyframe record{submap.keyframes[k], submap.T_submap_keyframe.at(k),
                                submap.covariances.at(k)};
    RowWriter row(insert, digest);
    row(submap.id, static_cast<int64_t>(k));
    fields(row, record);
    insert.run();
  }
}

void put_submap_constraints(Database& database, const Submap& submap, Digest& digest) {
  Statement insert(database, insert_sql(database, "submap_constraints"));
  for (size_t k = 0; k < submap.constraints.size(); ++k) {
    RowWriter row(insert, digest);
    row(submap.id, static_cast<int64_t>(k), submap.constraints[k]);
    insert.run();
  }
}

void put_submap_landmarks(Database& database, const Submap& submap, Digest& digest) {
  Statement insert(database, insert_sql(database, "submap_landmarks"));
  for (size_t k = 0; k < submap.landmarks.size(); ++k) {
    RowWriter row(insert, digest);
    row(submap.id, static_cast<int64_t>(k));
    fields(row, submap.landmarks[k]);
    insert.run();
  }
}

}  // namespace

struct StageWriter::Impl {
  Impl(MapFile::Impl& map_file, std::string stage)
      : file(&map_file),
        lock(map_file.mutex),
        key(std::move(stage)),
        transaction(map_file.database) {
    lock.unlock();
  }

  MapFile::Impl* file;
  std::unique_lock<std::mutex> lock;  // held only while the database is used
  std::string key;
  Transaction transaction;
  std::optional<Statement> insert_observation;
};

StageWriter::StageWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StageWriter::StageWriter(StageWriter&&) noexcept = default;
StageWriter& StageWriter::operator=(StageWriter&&) noexcept = default;

StageWriter::~StageWriter() {
  if (!impl_) return;
  // The rollback of an unfinished transaction uses the database too.
  const std::lock_guard lock(impl_->file->mutex);
  impl_.reset();
}

StageWriter MapFile::begin(const std::string& stage) {
  StageWriter writer(std::make_unique<StageWriter::Impl>(*impl_, stage));
  if (finished(stage))
    throw InputError(path().string() + ": stage " + stage +
                     " is finished already; is another hmtmap writing this map?");
  return writer;
}

void StageWriter::add(const Observation& observation) {
  // Encoding takes most of the time and needs no lock.
  const std::string frame = encode_sensed(observation);
  const std::lock_guard lock(impl_->file->mutex);
  Database& database = impl_->file->database;
  if (!impl_->insert_observation)
    impl_->insert_observation.emplace(database, insert_sql(database, "observations"));
  Statement& insert = *impl_->insert_observation;
  Digest digest;
  RowWriter row(insert, digest);
  row(observation.index, observation.stamp_s, observation.T_odom_robot);
  digest.add(std::string_view(frame));
  insert.bind(kObservationDigestColumn + 1, static_cast<int64_t>(digest.value()));
  insert.bind_blob(kObservationDigestColumn + 2, frame);
  insert.run();
}

void StageWriter::put_track(const Track& track) {
  const std::lock_guard lock(impl_->file->mutex);
  Database& database = impl_->file->database;
  put_log_report(database, track);
  write_list<Keyframe>(database, "keyframes", track.keyframes);
  write_list<TrackedObservation>(database, "tracked", track.observations);
  write_list<Constraint>(database, "odometry", track.odometry);
}

void StageWriter::put_constraints(std::span<const Constraint> constraints) {
  const std::lock_guard lock(impl_->file->mutex);
  write_list(impl_->file->database, "constraints", constraints);
}

void StageWriter::put_sightings(std::span<const Sighting> sightings) {
  const std::lock_guard lock(impl_->file->mutex);
  write_list(impl_->file->database, "sightings", sightings);
}

void StageWriter::put_landmark_names(std::span<const int64_t> names) {
  const std::lock_guard lock(impl_->file->mutex);
  write_list(impl_->file->database, "landmark_names", names);
}

void StageWriter::put_overlap(std::span<const graph::Arc> overlap) {
  const std::lock_guard lock(impl_->file->mutex);
  write_list(impl_->file->database, "overlap", overlap);
}

void StageWriter::put_partition(const graph::Labels& submap_of_keyframe) {
  const std::lock_guard lock(impl_->file->mutex);
  Database& database = impl_->file->database;
  write_list<int>(database, "partition_labels", submap_of_keyframe);
  erase_of_partition(database);
}

void StageWriter::put_submap(const Submap& submap) {
  const std::lock_guard lock(impl_->file->mutex);
  Database& database = impl_->file->database;
  erase_submap(database, submap.id);
  Statement insert(database, insert_sql(database, "submaps"));
  Digest digest;
  RowWriter row(insert, digest);
  row(submap.id, submap.chi2, submap.degrees_of_freedom,
      static_cast<int64_t>(submap.keyframes.size()),
      static_cast<int64_t>(submap.constraints.size()));
  put_submap_keyframes(database, submap, digest);
  put_submap_constraints(database, submap, digest);
  put_submap_landmarks(database, submap, digest);
  insert.bind(kSubmapDigestColumn + 1, static_cast<int64_t>(digest.value()));
  insert.run();
}

void StageWriter::put_links(std::span<const Link> links) {
  const std::lock_guard lock(impl_->file->mutex);
  std::vector<LinkEvidence> evidence;
  for (size_t k = 0; k < links.size(); ++k)
    for (const int constraint : links[k].evidence)
      evidence.push_back({static_cast<int>(k), constraint});
  write_list(impl_->file->database, "links", links);
  write_list<LinkEvidence>(impl_->file->database, "link_evidence", evidence);
  std::vector<LinkEvidence> landmarks;
  for (size_t k = 0; k < links.size(); ++k)
    for (const int landmark : links[k].landmarks)
      landmarks.push_back({static_cast<int>(k), landmark});
  write_list<LinkEvidence>(impl_->file->database, "link_landmarks", landmarks);
}

void StageWriter::put_loops(std::span<const LoopCandidate> loops) {
  const std::lock_guard lock(impl_->file->mutex);
  write_list(impl_->file->database, "loop_candidates", loops);
}

void StageWriter::put_solution(const MapSolution& solution) {
  const std::lock_guard lock(impl_->file->mutex);
  const SolutionRecord record{solution.information_loss, solution.chi2_initial, solution.chi2,
                              solution.division, solution.landmark_information_loss};
  write_list<SolutionRecord>(impl_->file->database, "solution", {&record, 1});
  std::vector<SubmapPose> poses;
  for (size_t k = 0; k < solution.T_world_submap.size(); ++k)
    poses.push_back({solution.T_world_submap[k], solution.covariance_world_submap.at(k)});
  write_list<SubmapPose>(impl_->file->database, "submap_poses", poses);
  write_list<PlacedLandmark>(impl_->file->database, "landmarks", solution.landmarks);
}

void StageWriter::put_estimate(std::span<const Pose> T_world_keyframe) {
  const std::lock_guard lock(impl_->file->mutex);
  write_list(impl_->file->database, "estimate", T_world_keyframe);
}

void StageWriter::put_octree(int submap, std::string_view ot_bytes) {
  const std::string frame = compress(ot_bytes);
  const std::lock_guard lock(impl_->file->mutex);
  Statement insert(impl_->file->database, "INSERT OR REPLACE INTO octrees VALUES (?, ?, ?, ?)");
  insert.bind(1, int64_t{submap});
  insert.bind(2, static_cast<int64_t>(ot_bytes.size()));
  insert.bind(3, static_cast<int64_t>(digest_of(frame)));
  insert.bind_blob(4, frame);
  insert.run();
}

void StageWriter::reopen() {
  const std::lock_guard lock(impl_->file->mutex);
  Database& database = impl_->file->database;
  database.execute(
      "DELETE FROM stages WHERE key LIKE 'round%' OR key LIKE 'octomap%' OR key IN ('settled', "
      "'observations')");
  erase_list(database, "partition_labels");
  erase_of_partition(database);
}

void StageWriter::commit() {
  const std::lock_guard lock(impl_->file->mutex);
  Database& database = impl_->file->database;
  Statement insert(database,
                   "INSERT INTO stages SELECT coalesce(max(position), 0) + 1, ? FROM stages");
  insert.bind_text(1, impl_->key);
  insert.run();
  impl_->insert_observation.reset();
  impl_->transaction.commit();
}

}  // namespace hmt::submap
