// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "records.hpp"
#include "row.hpp"

namespace hmt::submap {

/// "INSERT INTO table VALUES (?, ...)" with a mark for each column.
inline std::string insert_sql(Database& database, const std::string& table) {
  const int columns = Statement(database, "SELECT * FROM " + table).columns();
  std::string sql = "INSERT INTO " + table + " VALUES (?";
  for (int k = 1; k < columns; ++k) sql += ", ?";
  return sql + ")";
}

/// Forgets a list: its rows and that it was there.
inline void erase_list(Database& database, const std::string& table) {
  database.execute(("DELETE FROM " + table).c_str());
  Statement forget(database, "DELETE FROM contents WHERE name = ?");
  forget.bind_text(1, table);
  forget.run();
}

/// Replaces the rows of a table: record i under key i. The number of records and their checksum go
/// to table `contents`.
template <class Record>
void write_list(Database& database, const std::string& table, std::span<const Record> records) {
  erase_list(database, table);
  Statement insert(database, insert_sql(database, table));
  Digest digest;
  for (size_t k = 0; k < records.size(); ++k) {
    RowWriter row(insert, digest);
    row(static_cast<int64_t>(k));
    fields(row, records[k]);
    insert.run();
  }
  Statement note(database, "INSERT INTO contents VALUES (?, ?, ?)");
  note.bind_text(1, table);
  note.bind(2, static_cast<int64_t>(records.size()));
  note.bind(3, static_cast<int64_t>(digest.value()));
  note.run();
}

/// The records of a table; throws InputError if it was never written or is damaged.
template <class Record>
std::vector<Record> read_list(Database& database, const std::string& table) {
  Statement find(database, "SELECT records, digest FROM contents WHERE name = ?");
  find.bind_text(1, table);
  if (!find.step())
    throw graph::InputError(database.path().string() + ": the map is not finished, it has no " +
                            table + " yet; run the same hmtmap map command again");
  Statement select(database, "SELECT * FROM " + table + " ORDER BY 1");
  std::vector<Record> records;
  Digest digest;
  while (select.step()) {
    RowReader row(select, digest);
    int64_t key = 0;
    row(key);
    if (key != static_cast<int64_t>(records.size()))
      database.fail_damaged("a record is missing in table " + table);
    fields(row, records.emplace_back());
  }
  if (find.integer(0) != static_cast<int64_t>(records.size()) ||
      find.integer(1) != static_cast<int64_t>(digest.value()))
    database.fail_damaged("table " + table + " does not match its checksum");
  return records;
}

}  // namespace hmt::submap
