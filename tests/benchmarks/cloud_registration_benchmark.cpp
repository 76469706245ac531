// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Registration of pairs of lidar clouds by register_surface() and by the GICP and NDT of the Point
// Cloud Library, from the same guesses: error to reference poses, and time, for clouds one, two and
// five apart and for the pairs of a file of loops. Guesses are the odometry, of loops (whose
// odometry is far off) the reference with 0.3 m and 2 deg added.
// Usage: cloud_registration_benchmark FOLDER ODOMETRY.tum REFERENCE.tum [LOOPS.txt] [EVERY]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/log/log_reader.hpp"
#include "hmt/submap/registration/register_surface.hpp"
#include "pcl_registration.hpp"

namespace hmt::test {
namespace {

using graph::Pose;
using graph::Vector6d;
using submap::Observation;

constexpr double kDegree = std::numbers::pi / 180;

struct Pair {
  size_t target;
  size_t source;
  Pose T_guess;
  Pose T_true;
};

using Method = Pose (*)(const Observation&, const Observation&, const Pose&);

Pose by_surfaces(const Observation& target, const Observation& source, const Pose& guess) {
  const submap::Surface target_surface = submap::make_surface(target);
  const submap::RegistrationTarget::Placed placed[] = {{Pose{}, &target_surface}};
  submap::RegistrationOptions options;
  options.space = graph::Space::se3;
  options.max_correspondence_m = 1;
  return register_surface(submap::make_surface(source), submap::RegistrationTarget(placed), guess,
                          options)
      .T_target_source;
}

template <PclMethod kMethod>
Pose by_pcl(const Observation& target, const Observation& source, const Pose& guess) {
  return register_by_pcl(kMethod, source.readings.at(0).points_sensor,
                         target.readings.at(0).points_sensor, guess);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void measure(const char* name, Method method, const std::vector<Observation>& clouds,
             const std::vector<Pair>& pairs) {
  std::vector<double> metres, degrees;
  int failures = 0;
  const std::clock_t start = std::clock();
  for (const Pair& pair : pairs) {
    const Pose found = method(clouds[pair.target], clouds[pair.source], pair.T_guess);
    const Vector6d error = graph::boxminus(found, pair.T_true);
    metres.push_back(error.head<3>().norm());
    degrees.push_back(error.tail<3>().norm() / kDegree);
    if (metres.back() > 0.5 || degrees.back() > 2) ++failures;
  }
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("  %-9s %8.4f m %8.4f deg %6.1f %% off by 0.5 m or 2 deg %8.1f ms cpu a pair\n", name,
              median(metres), median(degrees), 100.0 * failures / static_cast<double>(pairs.size()),
              1e3 * seconds / static_cast<double>(pairs.size()));
  std::fflush(stdout);
}

void compare(const std::string& title, const std::vector<Observation>& clouds,
             const std::vector<Pair>& pairs) {
  if (pairs.empty()) return;
  std::printf("%s: %zu pairs, median errors\n", title.c_str(), pairs.size());
  measure("surfaces", by_surfaces, clouds, pairs);
  measure("PCL GICP", by_pcl<PclMethod::gicp>, clouds, pairs);
  measure("PCL NDT", by_pcl<PclMethod::ndt>, clouds, pairs);
}

std::vector<Pair> pairs_apart(const std::vector<Observation>& clouds,
                              const std::vector<submap::StampedPose>& reference, size_t apart,
                              size_t every) {
  std::vector<Pair> pairs;
  for (size_t i = 0; i + apart < clouds.size(); i += every)
    pairs.push_back(
        {i, i + apart, relative_pose(clouds[i].T_odom_robot, clouds[i + apart].T_odom_robot),
         relative_pose(reference.at(i).T_world_robot, reference.at(i + apart).T_world_robot)});
  return pairs;
}

/// Lines `id1 id2 score x y z qx qy qz qw`.
std::vector<Pair> pairs_of_loops(const std::string& path, size_t every) {
  std::ifstream file(path);
  std::vector<Pair> pairs;
  std::string line;
  for (size_t k = 0; std::getline(file, line); ++k) {
    std::istringstream numbers(line);
    Pair pair;
    double score = 0;
    Pose& T = pair.T_true;
    if (!(numbers >> pair.target >> pair.source >> score >> T.translation.x() >>
          T.translation.y() >> T.translation.z() >> T.rotation.x() >> T.rotation.y() >>
          T.rotation.z() >> T.rotation.w()))
      continue;
    T.rotation.normalize();
    const double angle = 2.4 * static_cast<double>(k);
    Vector6d off;
    off << 0.3 * std::cos(angle), 0.3 * std::sin(angle), 0, 0, 0, (k % 2 ? 2 : -2) * kDegree;
    pair.T_guess = boxplus(T, off);
    if (k % every == 0) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace
}  // namespace hmt::test

int main(int argc, char** argv) {
  using namespace hmt;
  if (argc < 4) {
    std::printf("usage: %s FOLDER ODOMETRY.tum REFERENCE.tum [LOOPS.txt] [EVERY]\n", argv[0]);
    return 2;
  }
  submap::LogOptions options;
  options.odometry_file = argv[2];
  const auto log = submap::open_log(argv[1], options);
  std::vector<submap::Observation> clouds;
  while (auto observation = log->next()) clouds.push_back(std::move(*observation));
  const auto reference = submap::read_tum(argv[3]);
  const size_t every = argc > 5 ? static_cast<size_t>(std::max(1, std::atoi(argv[5]))) : 5;
  for (const size_t apart : {1U, 2U, 5U})
    test::compare("clouds " + std::to_string(apart) + " apart", clouds,
                  test::pairs_apart(clouds, reference, apart, every));
  if (argc > 4) test::compare("loops", clouds, test::pairs_of_loops(argv[4], every));
}
