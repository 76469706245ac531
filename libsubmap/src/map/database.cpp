// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "database.hpp"

#include <sqlite3.h>

#include <limits>

#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

using graph::InputError;

// No observation and no octree comes near this; a file that claims more is damaged.
constexpr int kMaxBlobBytes = 1 << 30;
// Another command may be reading or writing for a moment.
constexpr int kBusyTimeoutMs = 5000;

const char* advice(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return "make room on the disk and run the same command again";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "wait for the other hmtmap that uses it, or stop that one";
    case SQLITE_READONLY:
      return "make the file and its folder writable, or copy both the map and its -journal file";
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
      return "check the path and its permissions";
    case SQLITE_NOTADB:
      return "give a map made by hmtmap map";
    case SQLITE_CORRUPT:
      return "the file is damaged: make the map again with --force";
    case SQLITE_TOOBIG:
      return "the file is damaged, or one observation is larger than 1 GB";
    default:
      return "check the disk and the file";
  }
}

}  // namespace

Database::Database(const std::filesystem::path& path, Access access) : path_(path) {
  // Reading also opens for writing where that is allowed: what a killed run left in the -journal
  // file has to be rolled back first. SQLite falls back to read only by itself.
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX |
                    (access == Access::write ? SQLITE_OPEN_CREATE : 0);
  const int code = sqlite3_open_v2(path.c_str(), &handle_, flags, nullptr);
  try {
    if (code != SQLITE_OK) fail(code);
    sqlite3_limit(handle_, SQLITE_LIMIT_LENGTH, kMaxBlobBytes);
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_busy_timeout(handle_, kBusyTimeoutMs);
    execute("PRAGMA cell_size_check = ON");
    execute(access == Access::read ? "PRAGMA query_only = ON" : "PRAGMA synchronous = NORMAL");
  } catch (...) {
    sqlite3_close(handle_);
    throw;
  }
}

Database::~Database() {
  sqlite3_close(handle_);
}

void Database::execute(const char* sql) {
  const int code = sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

int64_t Database::query_integer(const char* sql) {
  Statement statement(*this, sql);
  if (!statement.step()) fail_damaged("no answer to " + std::string(sql));
  return statement.integer(0);
}

void Database::fail(int code) const {
  std::string reason = handle_ ? sqlite3_errmsg(handle_) : sqlite3_errstr(code);
  if (handle_ && sqlite3_errcode(handle_) == SQLITE_OK) reason = sqlite3_errstr(code);
  throw InputError(path_.string() + ": " + reason + "; " + advice(code));
}

void Database::fail_damaged(const std::string& what) const {
  throw InputError(path_.string() + ": damaged map file: " + what +
                   "; make the map again with --force");
}

Statement::Statement(Database& database, const std::string& sql) : database_(&database) {
  const int code = sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &statement_, nullptr);
  if (code != SQLITE_OK) database.fail(code);
}

Statement::~Statement() {
  sqlite3_finalize(statement_);
}

void Statement::bind(int parameter, int64_t value) {
  if (const int code = sqlite3_bind_int64(statement_, parameter, value)) database_->fail(code);
}

void Statement::bind(int parameter, double value) {
  if (const int code = sqlite3_bind_double(statement_, parameter, value)) database_->fail(code);
}

void Statement::bind_text(int parameter, std::string_view text) {
  const int code = sqlite3_bind_text64(statement_, parameter, text.data(), text.size(),
                                       SQLITE_TRANSIENT, SQLITE_UTF8);
  if (code != SQLITE_OK) database_->fail(code);
}

void Statement::bind_blob(int parameter, std::string_view bytes) {
  // A null pointer would be stored as NULL instead of as an empty blob.
  const char* data = bytes.empty() ? "" : bytes.data();
  const int code = sqlite3_bind_blob64(statement_, parameter, data, bytes.size(), SQLITE_STATIC);
  if (code != SQLITE_OK) database_->fail(code);
}

bool Statement::step() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) database_->fail(code);
  return false;
}

void Statement::run() {
  step();
  reset();
}

void Statement::reset() {
  // Repeats the failure of the last step, which was thrown already.
  sqlite3_reset(statement_);
}

int Statement::columns() const {
  return sqlite3_column_count(statement_);
}

void Statement::require_type(int column, int type) const {
  if (sqlite3_column_type(statement_, column) != type)
    database_->fail_damaged("unexpected type in column " +
                            std::string(sqlite3_column_name(statement_, column)));
}

int64_t Statement::integer(int column) const {
  require_type(column, SQLITE_INTEGER);
  return sqlite3_column_int64(statement_, column);
}

double Statement::real(int column) const {
  // SQLite keeps a NaN as NULL.
  if (sqlite3_column_type(statement_, column) == SQLITE_NULL)
    return std::numeric_limits<double>::quiet_NaN();
  require_type(column, SQLITE_FLOAT);
  return sqlite3_column_double(statement_, column);
}

std::string_view Statement::text(int column) const {
  require_type(column, SQLITE_TEXT);
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  return {data, static_cast<size_t>(sqlite3_column_bytes(statement_, column))};
}

std::string_view Statement::blob(int column) const {
  require_type(column, SQLITE_BLOB);
  const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_, column));
  return {data ? data : "", static_cast<size_t>(sqlite3_column_bytes(statement_, column))};
}

Transaction::Transaction(Database& database) : database_(&database) {
  database.execute("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  // After some failures SQLite has rolled back already; then this does nothing.
  if (open_) sqlite3_exec(database_->handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  database_->execute("COMMIT");
  open_ = false;
}

}  // namespace hmt::submap
