// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/export_map.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <mutex>

#include "hmt/submap/export/atomic_file.hpp"
#include "hmt/submap/export/landmarks_file.hpp"
#include "hmt/submap/export/occupancy_image.hpp"
#include "hmt/submap/export/report.hpp"
#include "hmt/submap/export/submap_cloud.hpp"
#include "hmt/submap/export/topology.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/map/octree.hpp"
#include "number_text.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(folder.string() + ": cannot be made a folder" +
                     (error ? ": " + error.message() : "") + "; give another -o");
}

/// One export: what all its parts draw on.
class Export {
 public:
  Export(const MapFile& file, const fs::path& folder, const ExportOptions& options, const Run& run)
      : file_(file), folder_(folder), options_(options), run_(run), map_(file.load_map()) {}

  void trajectory() const {
    const std::vector<Pose> T_world_robot = world_trajectory(map_);
    std::vector<StampedPose> poses;
    for (size_t k = 0; k < T_world_robot.size(); ++k)
      poses.push_back({map_.track.observations[k].stamp_s, T_world_robot[k]});
    write_tum(folder_ / "trajectory.tum", poses);
  }

  void partition() const { write("partition.csv", partition_csv(map_)); }

  void topology() const {
    write("topology.json", topology_json(map_));
    write("topology.graphml", topology_graphml(map_));
    write("topology.dot", topology_dot(map_));
  }

  void pose_graph() const { write("pose_graph.g2o", pose_graph_g2o(map_)); }

  void map() {
    write("map.pgm", to_pgm(image()));
    write("map.yaml", to_map_yaml(image(), "map.pgm"));
  }

  void submaps() const {
    make_folder(folder_ / "submaps");
    size_t done = 0;
    bool stopped = false;
    std::mutex mutex;
    tbb::task_arena arena(run_.threads);
    arena.execute([&] {
      tbb::parallel_for(size_t{0}, map_.submaps.size(), [&](size_t id) {
        {
          const std::lock_guard lock(mutex);
          stopped = stopped || run_.stop_requested();
          if (stopped) return;
        }
        write_submap(map_.submaps[id]);
        const std::lock_guard lock(mutex);
        run_.report(
            {"submaps", static_cast<double>(++done), static_cast<double>(map_.submaps.size())});
      });
    });
    if (stopped) throw Interrupted{};
  }

  void landmarks() const { write("landmarks.csv", landmarks_csv(map_)); }

  void loops() const { write("loops.jsonl", loops_jsonl(map_)); }

  void report() {
    const OccupancyImage* walls = has_surfaces() ? &image() : nullptr;
    write("report.html", report_html(map_, file_.origin(), walls));
  }

  const HybridMap& hybrid_map() const { return map_; }
  /// Whether a range sensor saw anything.
  bool has_surfaces() const {
    const auto has_readings = [this](const Keyframe& keyframe) {
      return !file_.load(keyframe.observation)->readings.empty();
    };
    return std::any_of(map_.track.keyframes.begin(), map_.track.keyframes.end(), has_readings);
  }
  bool planar() const { return map_.track.space == Space::se2; }

 private:
  void write(const std::string& name, std::string_view bytes) const {
    write_file(folder_ / name, bytes);
  }

  void write_submap(const Submap& submap) const {
    const std::string ot = file_.load_octree(submap.id);
    const auto cloud = submap_cloud(observations_in_submap(map_.track, submap), file_, ot);
    const std::string name = submap_file(submap.id);
    write(name + ".ot", ot);
    write(name + ".bt", octree_to_bt(ot));
    write(name + ".ply", to_ply(cloud));
    write(name + ".pcd", to_pcd(cloud));
  }

  HeightBand height_band(const std::vector<PlacedObservation>& observations) const {
    HeightBand band = find_height_band(observations, file_);
    if (const auto& asked = options_.height_band_m) {
      band.min_m = (*asked)[0];
      band.max_m = (*asked)[1];
    }
    return band;
  }

  /// Drawn once, for the map and for the report.
  const OccupancyImage& image() {
    if (!image_.cells.empty()) return image_;
    const auto observations = observations_in_world(map_);
    std::optional<HeightBand> band;
    if (!planar()) band = height_band(observations);
    const double resolution_m = options_.map_resolution_m.value_or(planar() ? 0.05 : 0.2);
    image_ = draw_occupancy(observations, file_, band, resolution_m, run_);
    if (band)
      run_.log_info("map.pgm shows heights from " + fixed_text(band->min_m, 2) + " to " +
                    fixed_text(band->max_m, 2) + " m over the origin of the robot");
    return image_;
  }

 public:
  /// submaps/0012 for submap 12.
  static std::string submap_file(int id) {
    const std::string digits = std::to_string(id);
    return "submaps/" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
  }

 private:
  const MapFile& file_;
  const fs::path& folder_;
  const ExportOptions& options_;
  const Run& run_;
  HybridMap map_;
  OccupancyImage image_;
};

std::vector<std::string> submap_files(const HybridMap& map) {
  std::vector<std::string> files;
  for (const Submap& submap : map.submaps)
    for (const char* ending : {".bt", ".ot", ".pcd", ".ply"})
      files.push_back(Export::submap_file(submap.id) + ending);
  return files;
}

struct Part {
  const char* name;
  std::vector<std::string> (*files)(const HybridMap& map);
  void (*write)(Export& work);
};

using Files = std::vector<std::string>;
const std::vector<Part>& parts() {
  static const std::vector<Part> kParts = {
      {"trajectory", [](const HybridMap&) { return Files{"trajectory.tum"}; },
       [](Export& work) { work.trajectory(); }},
      {"partition", [](const HybridMap&) { return Files{"partition.csv"}; },
       [](Export& work) { work.partition(); }},
      {"topology",
       [](const HybridMap&) {
         return Files{"topology.json", "topology.graphml", "topology.dot"};
       },
       [](Export& work) { work.topology(); }},
      {"pose_graph", [](const HybridMap&) { return Files{"pose_graph.g2o"}; },
       [](Export& work) { work.pose_graph(); }},
      {"map",
       [](const HybridMap&) {
         return Files{"map.pgm", "map.yaml"};
       },
       [](Export& work) { work.map(); }},
      {"submaps", submap_files, [](Export& work) { work.submaps(); }},
      {"landmarks", [](const HybridMap&) { return Files{"landmarks.csv"}; },
       [](Export& work) { work.landmarks(); }},
      {"loops", [](const HybridMap&) { return Files{"loops.jsonl"}; },
       [](Export& work) { work.loops(); }},
      {"report", [](const HybridMap&) { return Files{"report.html"}; },
       [](Export& work) { work.report(); }},
  };
  return kParts;
}

const Part& part_named(const std::string& name) {
  for (const Part& part : parts())
    if (name == part.name) return part;
  throw InputError("unknown part " + name + "; see hmtmap export --help");
}

/// Parts that only logs of scans and clouds can have.
bool is_of_surfaces(const std::string& name) {
  return name == "map" || name == "submaps";
}

/// Why the map does not have that part; empty if it does.
std::string what_lacks(const std::string& part, const Export& work) {
  if (part == "landmarks" && work.hybrid_map().landmarks.empty()) return "the map has none";
  if (is_of_surfaces(part) && !work.has_surfaces()) return "a map of landmarks has no surfaces";
  return "";
}

std::vector<const Part*> chosen_parts(const ExportOptions& options, const Export& work) {
  if (options.height_band_m && work.planar())
    throw InputError("a height band is for maps of clouds, and this map is planar");
  std::vector<const Part*> chosen;
  for (const std::string& name : options.parts) {
    chosen.push_back(&part_named(name));
    if (const std::string lack = what_lacks(name, work); !lack.empty())
      throw InputError("part " + name + ": " + lack);
  }
  if (!options.parts.empty()) return chosen;
  for (const Part& part : parts())
    if (what_lacks(part.name, work).empty()) chosen.push_back(&part);
  return chosen;
}

void prepare_folder(const fs::path& folder, const std::vector<std::string>& files, bool overwrite) {
  make_folder(folder);
  if (overwrite) return;
  std::error_code error;
  for (const std::string& file : files)
    if (fs::exists(folder / file, error))
      throw InputError((folder / file).string() +
                       ": is there already; give another -o, or --force to replace it");
}

}  // namespace

std::vector<std::string> export_parts() {
  std::vector<std::string> names;
  for (const Part& part : parts()) names.emplace_back(part.name);
  return names;
}

std::vector<std::string> export_map(const MapFile& file, const fs::path& folder,
                                    const ExportOptions& options, const Run& run) {
  Export work(file, folder, options, run);
  const std::vector<const Part*> chosen = chosen_parts(options, work);
  std::vector<std::string> files;
  for (const Part* part : chosen)
    for (std::string& name : part->files(work.hybrid_map())) files.push_back(std::move(name));
  prepare_folder(folder, files, options.overwrite);
  for (const Part* part : chosen) {
    if (run.stop_requested()) throw Interrupted{};
    part->write(work);
  }
  return files;
}

}  // namespace hmt::submap
