// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "partition_input.hpp"

#include <spdlog/spdlog.h>
#include <stdlib.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <system_error>

#include "console.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/matrix_market.hpp"
#include "hmt/submap/local/optimize_submap.hpp"
#include "hmt/submap/pipeline.hpp"
#include "trajectory_input.hpp"

namespace hmt::apps {
namespace {

/// A folder that is removed at the end with all in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hmtmap-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw graph::InputError("cannot make the folder " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void add_information(const submap::HybridMap& map, const std::vector<int>& keyframes,
                     const std::vector<graph::Pose>& T_world_keyframe, PartitionInput& input) {
  graph::PoseGraph graph = submap::keyframe_graph(map.track.space, keyframes, T_world_keyframe,
                                                  map.constraints, map.sightings);
  input.information.emplace(graph);
  if (graph.points.empty()) return;
  graph.fixed = {0};
  input.landmark_information.emplace(graph);
  input.keyframes_of_landmark.resize(graph.points.size());
  for (const graph::PointEdge& edge : graph.point_edges)
    input.keyframes_of_landmark[static_cast<size_t>(edge.point)].push_back(edge.node);
}

PartitionInput from_map(const submap::HybridMap& map) {
  const auto n = map.track.keyframes.size();
  PartitionInput input;
  input.overlap = graph::WeightedGraph(static_cast<int>(n), map.overlap);
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  std::vector<graph::Pose> T_world_keyframe;
  for (const int k : all) T_world_keyframe.push_back(submap::world_pose(map, k));
  add_information(map, all, T_world_keyframe, input);
  for (size_t k = 0; k < n; ++k) {
    const size_t last = k > 0 ? k - 1 : 0;
    const double way_m =
        (T_world_keyframe[k].translation - T_world_keyframe[last].translation).norm();
    const double time_s =
        std::max(0.0, map.track.keyframes[k].stamp_s - map.track.keyframes[last].stamp_s);
    input.metres.push_back(k > 0 ? input.metres.back() + way_m : 0);
    input.seconds.push_back(k > 0 ? input.seconds.back() + time_s : 0);
  }
  return input;
}

}  // namespace

std::optional<double> PartitionInput::information_loss(const graph::Labels& labels) const {
  if (!information) return std::nullopt;
  return information->loss(labels).total;
}

std::optional<PartitionInput::LandmarkLoss> PartitionInput::landmark_loss(
    const graph::Labels& labels) const {
  if (!landmark_information) return std::nullopt;
  double copies = 0;
  std::vector<std::vector<int>> groups_of_landmark;
  for (const std::vector<int>& keyframes : keyframes_of_landmark) {
    std::set<int> groups;
    for (const int keyframe : keyframes) groups.insert(labels[static_cast<size_t>(keyframe)]);
    groups_of_landmark.emplace_back(groups.begin(), groups.end());
    copies += static_cast<double>(groups.size());
  }
  return LandmarkLoss{landmark_information->loss(groups_of_landmark),
                      copies / static_cast<double>(groups_of_landmark.size())};
}

PartitionInput read_partition_input(const std::filesystem::path& path, const Globals& globals) {
  if (is_map_file(path)) return from_map(submap::MapFile::open(path).load_map());
  if (graph::is_matrix_market(path)) {
    PartitionInput input;
    input.overlap = graph::read_matrix_market(path);
    return input;
  }
  if (!std::filesystem::exists(path)) throw graph::InputError(path.string() + ": no such file");
  spdlog::info("{}: neither a map nor a matrix; mapping it as a log", path.string());
  const TemporaryFolder folder;
  return from_map(submap::build_map(path, folder.path() / "log.hmt", submap::Options{},
                                    submap::MapFile::Existing::replace, make_run(globals))
                      .file.load_map());
}

}  // namespace hmt::apps
