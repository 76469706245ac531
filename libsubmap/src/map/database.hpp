// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace hmt::submap {

/// One connection to an SQLite file. Every failure becomes an InputError with the path, the reason
/// and what to do. Not safe for several threads: the owner locks.
class Database {
 public:
  enum class Access { read, write };

  /// Opens the file; with `write` it is created where it is absent.
  Database(const std::filesystem::path& path, Access access);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void execute(const char* sql);
  /// The integer in the first column of the first row, e.g. of a pragma.
  int64_t query_integer(const char* sql);
  /// Throws InputError for an SQLite result code that means failure.
  [[noreturn]] void fail(int code) const;
  /// Throws InputError: the contents are not what a map file holds.
  [[noreturn]] void fail_damaged(const std::string& what) const;

  const std::filesystem::path& path() const { return path_; }
  sqlite3* handle() const { return handle_; }

 private:
  std::filesystem::path path_;
  sqlite3* handle_ = nullptr;
};

/// One prepared statement. Parameters count from 1 and columns from 0, as in SQLite.
class Statement {
 public:
  Statement(Database& database, const std::string& sql);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  void bind(int parameter, int64_t value);
  void bind(int parameter, double value);
  void bind_text(int parameter, std::string_view text);
  /// The bytes must live until the statement was run.
  void bind_blob(int parameter, std::string_view bytes);

  /// Next row; false at the end.
  bool step();
  /// Runs a statement that gives no rows and makes it ready for the next values.
  void run();
  /// Makes it ready for the next values.
  void reset();

  /// Number of columns of a result row.
  int columns() const;
  /// Values of the current row; a column of another type throws InputError (damaged file).
  int64_t integer(int column) const;
  double real(int column) const;
  /// Valid until the next step or reset.
  std::string_view text(int column) const;
  std::string_view blob(int column) const;

  Database& database() const { return *database_; }

 private:
  void require_type(int column, int type) const;

  Database* database_;
  sqlite3_stmt* statement_ = nullptr;
};

/// BEGIN ... COMMIT; rolled back at the end of its scope unless committed.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database* database_;
  bool open_ = true;
};

}  // namespace hmt::submap
