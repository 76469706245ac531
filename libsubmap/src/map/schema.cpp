// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "schema.hpp"

#include <array>
#include <string>

#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

constexpr int64_t kApplicationId = 0x484d5431;  // "HMT1"
constexpr int64_t kVersion = 3;

struct Table {
  const char* name;
  const char* columns;
};

// Columns of numbers have no type on purpose: SQLite then keeps every number as it was given, the
// sign of a zero included. Documented in libsubmap/README.md.
#define HMT_POSE(p) p "_x, " p "_y, " p "_z, " p "_qx, " p "_qy, " p "_qz, " p "_qw"
constexpr std::array kTables = {
    Table{"meta", "key TEXT PRIMARY KEY, value TEXT NOT NULL"},
    Table{"stages", "position INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE"},
    Table{"contents", "name TEXT PRIMARY KEY, records INTEGER NOT NULL, digest INTEGER NOT NULL"},
    Table{"observations",
          "id INTEGER PRIMARY KEY, stamp_s, " HMT_POSE("odom") ", digest, readings BLOB"},
    Table{"track", "id INTEGER PRIMARY KEY, space, observations, odometry_records"},
    Table{"log_notes", "id INTEGER PRIMARY KEY, loss, text, count"},
    Table{"keyframes", "id INTEGER PRIMARY KEY, observation, stamp_s, " HMT_POSE("track")},
    Table{"tracked",
          "id INTEGER PRIMARY KEY, observation, stamp_s, keyframe, " HMT_POSE("keyframe_robot")},
    Table{"odometry", "id INTEGER PRIMARY KEY, a, b, kind, " HMT_POSE("ab") ", information BLOB"},
    Table{"constraints",
          "id INTEGER PRIMARY KEY, a, b, kind, " HMT_POSE("ab") ", information BLOB"},
    Table{"sightings",
          "id INTEGER PRIMARY KEY, observation, place, keyframe, landmark, keyframe_x, keyframe_y, "
          "keyframe_z, information BLOB"},
    Table{"landmark_names", "landmark INTEGER PRIMARY KEY, name"},
    Table{"overlap", "id INTEGER PRIMARY KEY, a, b, weight"},
    Table{"partition_labels", "keyframe INTEGER PRIMARY KEY, submap"},
    Table{"submaps",
          "id INTEGER PRIMARY KEY, chi2, degrees_of_freedom, keyframes, constraints, "
          "digest"},
    Table{"submap_keyframes",
          "submap, position, keyframe, " HMT_POSE(
              "submap_keyframe") ", "
                                 "covariance BLOB, PRIMARY KEY (submap, position)"},
    Table{"submap_constraints", "submap, position, constraint_id, PRIMARY KEY (submap, position)"},
    Table{"submap_landmarks",
          "submap, position, landmark, submap_x, submap_y, submap_z, covariance BLOB, PRIMARY KEY "
          "(submap, position)"},
    Table{"links", "id INTEGER PRIMARY KEY, a, b, " HMT_POSE("ab") ", covariance BLOB, ncut, "
                                                                   "information_loss"},
    Table{"link_evidence", "id INTEGER PRIMARY KEY, link, constraint_id"},
    Table{"link_landmarks", "id INTEGER PRIMARY KEY, link, landmark"},
    Table{"loop_candidates",
          "id INTEGER PRIMARY KEY, a, b, submap_a, submap_b, "
          "predicted_distance_m, predicted_sigma_m, " HMT_POSE(
              "ab") ", "
                    "information BLOB, score, second_score, inlier_fraction, "
                    "rmse_m, free_space_conflict, "
                    "mahalanobis, chi2_rise, verdict, reason TEXT"},
    Table{"solution",
          "id INTEGER PRIMARY KEY, information_loss, chi2_initial, chi2, chi2_hybrid, "
          "chi2_refined, chi2_flat, landmark_information_loss"},
    Table{"landmarks",
          "id INTEGER PRIMARY KEY, landmark, world_x, world_y, world_z, covariance BLOB"},
    Table{"submap_poses", "submap INTEGER PRIMARY KEY, " HMT_POSE("world") ", covariance BLOB"},
    Table{"estimate", "keyframe INTEGER PRIMARY KEY, " HMT_POSE("world")},
    Table{"octrees", "submap INTEGER PRIMARY KEY, bytes, digest, ot_zstd BLOB"},
};
#undef HMT_POSE

std::string create_text(const Table& table) {
  return std::string("CREATE TABLE ") + table.name + "(" + table.columns + ")";
}

}  // namespace

void create_schema(Database& database) {
  for (const Table& table : kTables) database.execute(create_text(table).c_str());
  const std::string marks = "PRAGMA application_id = " + std::to_string(kApplicationId) +
                            "; PRAGMA user_version = " + std::to_string(kVersion);
  database.execute(marks.c_str());
}

void check_schema(Database& database) {
  const std::string path = database.path().string();
  if (database.query_integer("PRAGMA application_id") != kApplicationId)
    throw graph::InputError(path +
                            ": a database, but not a map file; give a map made by hmtmap map");
  const int64_t version = database.query_integer("PRAGMA user_version");
  if (version > kVersion)
    throw graph::InputError(path + ": map file version " + std::to_string(version) +
                            " is newer than this program, which knows version " +
                            std::to_string(kVersion) + "; use a newer hmtmap");
  if (version < 1) database.fail_damaged("version " + std::to_string(version));
  if (version < kVersion)
    throw graph::InputError(path + ": map file version " + std::to_string(version) +
                            " was written by an older program, this one knows version " +
                            std::to_string(kVersion) + "; make the map again from its log");
  Statement find(database, "SELECT sql FROM sqlite_schema WHERE name = ?");
  for (const Table& table : kTables) {
    find.bind_text(1, table.name);
    if (!find.step() || find.text(0) != create_text(table))
      database.fail_damaged(std::string("table ") + table.name + " is not as it should be");
    find.reset();
  }
}

}  // namespace hmt::submap
