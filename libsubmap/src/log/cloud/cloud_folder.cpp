// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_folder.hpp"

#include <set>

#include "../file_bytes.hpp"
#include "../natural_order.hpp"
#include "../report_book.hpp"
#include "cloud_file.hpp"
#include "complete_cloud.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> clouds_of(const fs::path& folder) {
  return files_in_natural_order(folder, {".pcd", ".ply", ".bin"});
}

std::string count_text(size_t clouds, size_t poses) {
  return std::to_string(clouds) + " clouds and " + std::to_string(poses) + " poses";
}

}  // namespace

bool CloudFolder::is(const fs::path& folder) {
  return fs::is_directory(folder) && !clouds_of(folder).empty();
}

CloudFolder::CloudFolder(const fs::path& folder, const LogOptions& options)
    : clouds_(clouds_of(folder)) {
  std::set<std::string> formats;
  for (const fs::path& cloud : clouds_) {
    formats.insert(cloud.extension().string());
    bytes_total_ += file_bytes(cloud);
  }
  if (formats.size() > 1)
    throw InputError(folder.string() + ": clouds of several formats; keep those of one");
  if (options.odometry_file.empty())
    poses_.assign(clouds_.size(), {.stamp_s = std::nullopt, .T = Pose{}});
  else
    pair_with_odometry(options.odometry_file);
  read_times(folder / "times.txt");
}

void CloudFolder::pair_with_odometry(const std::string& odometry_file) {
  poses_ = read_pose_lines(odometry_file, report_);
  report_.odometry_records = static_cast<int64_t>(poses_.size());
  if (poses_.size() > clouds_.size())
    throw InputError(odometry_file + ": " + count_text(clouds_.size(), poses_.size()) +
                     "; line N must be the pose of cloud N");
  if (poses_.size() < clouds_.size())
    add_loss(report_, "clouds behind the end of the odometry", clouds_[poses_.size()].string(),
             static_cast<int64_t>(clouds_.size() - poses_.size()));
}

void CloudFolder::read_times(const fs::path& times) {
  if (poses_.empty() || poses_.front().stamp_s || !fs::exists(times)) return;
  const std::vector<double> stamps = read_stamps(times);
  if (stamps.size() != clouds_.size())
    throw InputError(times.string() + ": " + std::to_string(stamps.size()) + " stamps of " +
                     std::to_string(clouds_.size()) + " clouds");
  for (size_t k = 0; k < poses_.size(); ++k) poses_[k].stamp_s = stamps[k];
}

std::optional<Observation> CloudFolder::next() {
  while (next_ < poses_.size()) {
    const size_t cloud = next_++;
    bytes_read_ += file_bytes(clouds_[cloud]);
    if (auto result = observation(cloud)) return result;
  }
  return std::nullopt;
}

std::optional<Observation> CloudFolder::observation(size_t cloud) {
  const std::string place = clouds_[cloud].string();
  // Counted when the poses were read.
  if (!poses_[cloud].T) return std::nullopt;
  Observation observation;
  Reading reading;
  try {
    CloudPoints points = read_cloud_file(clouds_[cloud]);
    if (!points.damage.empty()) add_loss(report_, points.damage, place);
    note_cloud(report_, points, place);
    reading.points_sensor = std::move(points.points);
  } catch (const InputError& error) {
    add_loss(report_, std::string("clouds that cannot be read: ") + error.what(), place);
    return std::nullopt;
  }
  complete_cloud(reading);
  if (!poses_[cloud].stamp_s) add_note(report_, "stamps absent", place);
  observation.index = report_.observations++;
  observation.stamp_s = poses_[cloud].stamp_s.value_or(0);
  observation.T_odom_robot = *poses_[cloud].T;
  observation.readings.push_back(std::move(reading));
  return observation;
}

}  // namespace hmt::submap
