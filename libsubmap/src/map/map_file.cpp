// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/map/map_file.hpp"

#include <sqlite3.h>

#include <nlohmann/json.hpp>

#include "digest.hpp"
#include "map_file_impl.hpp"
#include "observation_codec.hpp"
#include "row.hpp"
#include "schema.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

void require_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(path.string() + ": no such file");
  if (fs::is_directory(status))
    throw InputError(path.string() + ": a folder; give a map made by hmtmap map");
  if (!fs::is_regular_file(status)) throw InputError(path.string() + ": not a regular file");
  if (fs::file_size(path, error) == 0 && !error)
    throw InputError(path.string() + ": an empty file; give a map made by hmtmap map");
}

/// What a killed run may have left beside the map belongs to it.
void remove_map(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error))
    throw InputError(path.string() + ": a folder, which is not replaced; give a file name");
  fs::remove(path, error);
  if (!error) fs::remove(path.string() + "-journal", error);
  if (error) throw InputError(path.string() + ": cannot be replaced: " + error.message());
}

std::string meta_value(Database& database, const char* key) {
  Statement find(database, "SELECT value FROM meta WHERE key = ?");
  find.bind_text(1, key);
  if (!find.step()) database.fail_damaged(std::string("no ") + key + " in table meta");
  return std::string(find.text(0));
}

void put_meta(Database& database, const char* key, const std::string& value) {
  Statement insert(database, "INSERT INTO meta VALUES (?, ?)");
  insert.bind_text(1, key);
  insert.bind_text(2, value);
  insert.run();
}

MapOrigin read_origin(Database& database) {
  return {meta_value(database, "log_path"), meta_value(database, "log_digest"),
          meta_value(database, "options"), meta_value(database, "program_version")};
}

void create_map(Database& database, const MapOrigin& origin) {
  Transaction transaction(database);
  create_schema(database);
  put_meta(database, "log_path", origin.log_path);
  put_meta(database, "log_digest", origin.log_digest);
  put_meta(database, "options", origin.options_json);
  put_meta(database, "program_version", origin.program_version);
  transaction.commit();
}

/// "tau was 0.5 and is now 0.7" for the first option that differs.
std::string option_difference(const std::string& before, const std::string& now) {
  const auto old_options = nlohmann::json::parse(before, nullptr, false);
  const auto new_options = nlohmann::json::parse(now, nullptr, false);
  if (old_options.is_discarded() || new_options.is_discarded()) return "the options differ";
  const auto patch = nlohmann::json::diff(old_options, new_options);
  if (patch.empty()) return "";
  const nlohmann::json::json_pointer at(patch[0].at("path").get<std::string>());
  const auto text = [&](const nlohmann::json& options) {
    return options.contains(at) ? options.at(at).dump() : std::string("absent");
  };
  return "option " + at.to_string().substr(1) + " was " + text(old_options) + " and is now " +
         text(new_options);
}

void require_same_origin(Database& database, const MapOrigin& now) {
  const MapOrigin before = read_origin(database);
  std::string reason;
  if (before.log_digest != now.log_digest)
    reason = "it was made from another log (" + before.log_path + ") than " + now.log_path;
  else if (before.options_json != now.options_json)
    reason = option_difference(before.options_json, now.options_json);
  if (!reason.empty())
    throw InputError(database.path().string() + ": not continued, " + reason +
                     "; give another output file, or --force to replace it");
}

}  // namespace

MapFile::MapFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MapFile::~MapFile() = default;
MapFile::MapFile(MapFile&&) noexcept = default;
MapFile& MapFile::operator=(MapFile&&) noexcept = default;

MapFile MapFile::open(const fs::path& path) {
  require_file(path);
  auto impl = std::make_unique<Impl>(path, Database::Access::read);
  check_schema(impl->database);
  return MapFile(std::move(impl));
}

MapFile MapFile::open_for_run(const fs::path& path, const MapOrigin& origin, Existing existing) {
  if (existing == Existing::replace) remove_map(path);
  auto impl = std::make_unique<Impl>(path, Database::Access::write);
  Database& database = impl->database;
  if (sqlite3_db_readonly(database.handle(), "main") == 1) database.fail(SQLITE_READONLY);
  // A run that was killed before its first commit leaves a database without pages.
  if (database.query_integer("PRAGMA page_count") == 0) {
    create_map(database, origin);
  } else {
    check_schema(database);
    require_same_origin(database, origin);
  }
  return MapFile(std::move(impl));
}

void MapFile::discard(MapFile file) {
  const fs::path path = file.path();
  file.impl_.reset();
  remove_map(path);
}

MapFile MapFile::open_for_change(const fs::path& path) {
  require_file(path);
  auto impl = std::make_unique<Impl>(path, Database::Access::write);
  if (sqlite3_db_readonly(impl->database.handle(), "main") == 1)
    impl->database.fail(SQLITE_READONLY);
  check_schema(impl->database);
  return MapFile(std::move(impl));
}

const fs::path& MapFile::path() const {
  return impl_->database.path();
}

MapOrigin MapFile::origin() const {
  const std::lock_guard lock(impl_->mutex);
  return read_origin(impl_->database);
}

bool MapFile::finished(std::string_view stage) const {
  const std::lock_guard lock(impl_->mutex);
  Statement find(impl_->database, "SELECT 1 FROM stages WHERE key = ?");
  find.bind_text(1, stage);
  return find.step();
}

std::vector<std::string> MapFile::stages() const {
  const std::lock_guard lock(impl_->mutex);
  Statement select(impl_->database, "SELECT key FROM stages ORDER BY position");
  std::vector<std::string> keys;
  while (select.step()) keys.emplace_back(select.text(0));
  return keys;
}

int64_t MapFile::num_observations() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->database.query_integer("SELECT count(*) FROM observations");
}

std::string MapFile::Impl::read_observation(int64_t index, Observation& observation) {
  if (!select_observation)
    select_observation.emplace(database, "SELECT * FROM observations WHERE id = ?");
  select_observation->reset();
  select_observation->bind(1, index);
  if (!select_observation->step())
    throw InputError(database.path().string() + ": no observation " + std::to_string(index) +
                     " in the map");
  Digest digest;
  RowReader row(*select_observation, digest);
  row(observation.index, observation.stamp_s, observation.T_odom_robot);
  const int64_t expected = select_observation->integer(kObservationDigestColumn);
  std::string frame(select_observation->blob(kObservationDigestColumn + 1));
  select_observation->reset();
  digest.add(std::string_view(frame));
  if (static_cast<int64_t>(digest.value()) != expected)
    database.fail_damaged("observation " + std::to_string(index) + " does not match its checksum");
  return frame;
}

void MapFile::set_cache_bytes(size_t bytes) {
  impl_->cache.set_most_bytes(bytes);
}

std::shared_ptr<const Observation> MapFile::load(int64_t index) const {
  if (auto cached = impl_->cache.find(index)) return cached;
  auto observation = std::make_shared<Observation>();
  std::string frame;
  {
    const std::lock_guard lock(impl_->mutex);
    frame = impl_->read_observation(index, *observation);
  }
  if (!decode_sensed(frame, *observation))
    impl_->database.fail_damaged("observation " + std::to_string(index) + " cannot be decoded");
  impl_->cache.insert(index, observation, size_in_memory(*observation));
  return observation;
}

}  // namespace hmt::submap
