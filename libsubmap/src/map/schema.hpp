// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "database.hpp"

namespace hmt::submap {

/// Creates the tables of a map file in an empty database, within the caller's transaction.
void create_schema(Database& database);
/// Throws InputError unless the database is a map file of a version that this program knows, with
/// exactly its tables.
void check_schema(Database& database);

}  // namespace hmt::submap
