// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// OctoMaps of all submaps of maps beside those that OctoMap's own tool graph2tree makes of the same
// points, poses and resolution, and how many cells both classify the same.
// Usage: octree_benchmark MAP.hmt... (of Debian's octomap-tools graph2tree is needed)

#include <sys/resource.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#define OCTOMAP_NODEBUGOUT
#include <octomap/OcTree.h>
#include <octomap/ScanGraph.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "hmt/submap/map/map_file.hpp"
#include "hmt/submap/map/octree.hpp"
#include "temporary_folder.hpp"

namespace hmt::test {
namespace {

namespace fs = std::filesystem;
using submap::PlacedObservation;

constexpr int kCores = 2;

/// The observations of a map as a scan graph can hold them: without the beams that met nothing.
class PointsAlone : public submap::ObservationStore {
 public:
  explicit PointsAlone(const submap::MapFile& map) : map_(map) {}
  std::shared_ptr<const submap::Observation> load(int64_t index) const override {
    auto observation = std::make_shared<submap::Observation>(*map_.load(index));
    for (submap::Reading& reading : observation->readings) reading.misses_sensor.clear();
    return observation;
  }

 private:
  const submap::MapFile& map_;
};

struct Seconds {
  double wall = 0;
  double cpu = 0;
};

double cpu_seconds(int who) {
  rusage usage{};
  getrusage(who, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Does work(k) for each k < count on both cores; `who` does the work, this process or its
/// children.
template <class Work>
Seconds time_all(size_t count, int who, Work&& work) {
  const double cpu = cpu_seconds(who);
  const auto start = std::chrono::steady_clock::now();
  tbb::task_arena arena(kCores);
  arena.execute([&] { tbb::parallel_for(size_t{0}, count, work); });
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {wall.count(), cpu_seconds(who) - cpu};
}

octomap::pose6d to_octomap(const submap::Pose& pose) {
  const Eigen::Vector3f t = pose.translation.cast<float>();
  const Eigen::Quaternionf q = pose.rotation.cast<float>();
  return {octomap::point3d(t.x(), t.y(), t.z()), octomath::Quaternion(q.w(), q.x(), q.y(), q.z())};
}

/// Moves planar scans, which have z = 0, from the lower side of their cells to the middle: there
/// the rounding of graph2tree would make rays leave the layer, and it aborts.
submap::Pose in_the_middle_of_cells(const submap::Pose& pose, submap::Space space,
                                    double resolution_m) {
  submap::Pose moved = pose;
  if (space == submap::Space::se2) moved.translation.z() = resolution_m / 2;
  return moved;
}

void write_scan_graph(const fs::path& file, const std::vector<PlacedObservation>& observations,
                      const submap::ObservationStore& store, submap::Space space,
                      double resolution_m) {
  octomap::ScanGraph graph;
  for (const PlacedObservation& placed : observations)
    for (const auto seen = store.load(placed.observation);
         const submap::Reading& reading : seen->readings) {
      auto cloud = std::make_unique<octomap::Pointcloud>();
      for (const Eigen::Vector3f& p : reading.points_sensor) cloud->push_back(p.x(), p.y(), p.z());
      const submap::Pose T_submap_sensor = placed.T_frame_robot * reading.T_robot_sensor;
      const auto pose = in_the_middle_of_cells(T_submap_sensor, space, resolution_m);
      graph.addNode(cloud.release(), to_octomap(pose));  // which owns the cloud from now on
    }
  graph.writeBinary(file.string());
}

void run_graph2tree(const fs::path& stem, double resolution_m) {
  const std::string command = "graph2tree -i " + stem.string() + ".graph -o " + stem.string() +
                              ".bt -res " + std::to_string(resolution_m) + " > /dev/null 2>&1";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
}

std::unique_ptr<octomap::OcTree> read_tree(std::istream& in) {
  std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(in));
  auto* read = dynamic_cast<octomap::OcTree*>(tree.get());
  if (read == nullptr) throw std::runtime_error("not an OcTree");
  tree.release();
  read->expand();
  return std::unique_ptr<octomap::OcTree>(read);
}

/// Cells that at least one of two trees knows, and those of them that are free in both or occupied
/// in both.
struct Agreement {
  size_t cells = 0;
  size_t same = 0;

  void add(const octomap::OcTree& a, const octomap::OcTree& b) {
    for (auto leaf = a.begin_leafs(); leaf != a.end_leafs(); ++leaf) {
      const octomap::OcTreeNode* other = b.search(leaf.getKey());
      ++cells;
      same += other != nullptr && b.isNodeOccupied(other) == a.isNodeOccupied(*leaf) ? 1 : 0;
    }
    for (auto leaf = b.begin_leafs(); leaf != b.end_leafs(); ++leaf)
      cells += a.search(leaf.getKey()) == nullptr ? 1 : 0;
  }
};

void compare_on(const fs::path& path) {
  const submap::MapFile file = submap::MapFile::open(path);
  const submap::HybridMap map = file.load_map();
  const PointsAlone store(file);
  const size_t count = map.submaps.size();
  const double resolution_m = submap::octree_resolution(file.load_octree(0));
  const TemporaryFolder folder;
  std::vector<fs::path> stems;
  std::vector<std::vector<PlacedObservation>> observations;
  for (const submap::Submap& submap : map.submaps) {
    stems.push_back(folder.path() / std::to_string(submap.id));
    observations.push_back(submap::observations_in_submap(map.track, submap));
    write_scan_graph(stems.back().string() + ".graph", observations.back(), store, map.track.space,
                     resolution_m);
  }
  const Seconds theirs =
      time_all(count, RUSAGE_CHILDREN, [&](size_t k) { run_graph2tree(stems[k], resolution_m); });
  std::vector<std::string> trees(count);
  const Seconds ours = time_all(count, RUSAGE_SELF, [&](size_t k) {
    trees[k] = submap::build_octree(observations[k], store, map.track.space, {resolution_m});
  });
  Agreement agreement;
  for (size_t k = 0; k < count; ++k) {
    std::istringstream our_tree(trees[k]);
    std::ifstream their_tree(stems[k].string() + ".bt.ot", std::ios::binary);
    agreement.add(*read_tree(our_tree), *read_tree(their_tree));
  }
  std::printf(
      "%-24s %4zu submaps, cells of %.2f m: graph2tree %7.2f s (%7.2f s cpu), hmtmap %6.2f s "
      "(%6.2f s cpu), ratio %.1f (%.1f cpu); %zu of %zu cells the same, %.4f %%\n",
      path.filename().c_str(), count, resolution_m, theirs.wall, theirs.cpu, ours.wall, ours.cpu,
      theirs.wall / ours.wall, theirs.cpu / ours.cpu, agreement.same, agreement.cells,
      100.0 * static_cast<double>(agreement.same) / static_cast<double>(agreement.cells));
  std::fflush(stdout);
}

}  // namespace
}  // namespace hmt::test

int main(int argc, char** argv) {
  for (int k = 1; k < argc; ++k) hmt::test::compare_on(argv[k]);
}
