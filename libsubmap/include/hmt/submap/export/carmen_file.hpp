// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "hmt/graph/pose.hpp"

namespace hmt::submap {

/// Writes a CARMEN log, one scan after the other in constant memory; compressed if the name ends in
/// .gz, .bz2 or .zst. The file appears whole with commit() or not at all.
class CarmenWriter {
 public:
  /// Throws InputError where the file cannot be written; so do the other calls.
  explicit CarmenWriter(const std::filesystem::path& path);
  ~CarmenWriter();
  CarmenWriter(CarmenWriter&&) noexcept;
  CarmenWriter& operator=(CarmenWriter&&) noexcept;

  /// One FLASER line and its ODOM line. A reader tells the angles of the beams from their number:
  /// 181 are from -90 to 90 deg.
  void add(std::span<const double> ranges_m, const graph::Pose& T_odom_laser,
           const graph::Pose& T_odom_robot, double stamp_s);
  void commit();

 private:
  struct Stream;
  std::unique_ptr<Stream> stream_;
};

}  // namespace hmt::submap
