// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>

#include "figures.hpp"
#include "hmt/submap/export/atomic_file.hpp"
#include "straight_path_study.hpp"
#include "svg.hpp"

namespace hmt::paper {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Enough to tell the variations apart.
constexpr int kSensitivityRuns = 40;

/// The ellipse of three standard deviations.
void draw_ellipse(Svg& svg, const MapView& view, const Eigen::Vector2d& mean,
                  const Eigen::Matrix2d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const Eigen::Vector2d axes = 3 * solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= 24; ++i) {
    const double angle = i * 15 * kDegree;
    points.push_back(view(mean + solver.eigenvectors() * axes.cwiseProduct(Eigen::Vector2d(
                                                             std::cos(angle), std::sin(angle)))));
  }
  svg.polyline(points, "#06c");
}

/// Fig. 8(a): the filter at the end of one run; the path in the color of its group.
std::string run_svg(const StraightPathParameters& p, uint64_t seed) {
  const StraightPathRun run = run_straight_path(p, seed);
  graph::PartitionOptions options;
  options.tau = kPaperTau;
  const graph::Labels labels = graph::recursive_partition(run.overlap, options).labels;
  const double margin_m = 1;
  const Eigen::Vector2d low(-margin_m, -p.half_width_m - margin_m);
  const Eigen::Vector2d high(p.length_m + margin_m, p.half_width_m + margin_m);
  const MapView view(low, high, {10, 30}, 16 * (high - low));
  Svg svg(16 * (high - low).x() + 20, 16 * (high - low).y() + 50);
  svg.text({10, 20}, fmt::format("Run {}: path by submap at tau {}, landmarks with 3 sigma", seed,
                                 kPaperTau));
  for (size_t i = 0; i < run.state_landmarks.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 + 2 * i);
    draw_ellipse(svg, view, run.state.segment<2>(row), run.covariance.block<2, 2>(row, row));
  }
  for (size_t k = 0; k < run.poses.size(); ++k)
    if (!run.seen[k].empty()) svg.circle(view(run.poses[k].head<2>()), 3, group_color(labels[k]));
  return svg.str();
}

std::string csv_row(const Statistics& s) {
  return fmt::format("{:.6f},{:.6f},{:.6f},{:.6f}", s.mean, s.deviation, s.low, s.high);
}

void write_methods(const std::filesystem::path& folder, const StraightPathStudy& study, int runs) {
  std::string csv = "method,k,mean_percent,deviation,p16,p84\nncut,," + csv_row(study.ncut) + "\n";
  Series ncut{"min-Ncut, tau = 0.2", "#d00", false, {0}, {study.ncut}};
  Series fixed{"fixed, k observations", "#06c", true, {}, study.fixed};
  double top = study.ncut.high;
  for (int k = kLeastFixed; k <= kMostFixed; ++k) {
    const Statistics& s = study.fixed[static_cast<size_t>(k - kLeastFixed)];
    csv += fmt::format("fixed,{},{}\n", k, csv_row(s));
    fixed.x.push_back(k);
    top = std::max(top, s.high);
  }
  submap::write_file(folder / "fig8b.csv", csv);
  submap::write_file(
      folder / "fig8b.svg",
      chart_svg(fmt::format("Information loss, mean and 68 % interval of {} runs", runs),
                {"k", -1, 46, 5}, {"e, percent", 0, std::ceil(top * 2) / 2, 0.5}, {ncut, fixed}));
}

void write_taus(const std::filesystem::path& folder, const StraightPathStudy& study, int runs) {
  std::string csv = "tau,groups,mean_percent,deviation,p16,p84\n";
  double top = 0;
  for (size_t t = 0; t < study.taus.size(); ++t) {
    csv += fmt::format("{:g},{:.3f},{}\n", study.taus[t], study.groups_by_tau[t],
                       csv_row(study.by_tau[t]));
    top = std::max(top, study.by_tau[t].high);
  }
  submap::write_file(folder / "fig8c.csv", csv);
  submap::write_file(folder / "fig8c.svg",
                     chart_svg(fmt::format("Information loss over tau, {} runs", runs),
                               {"tau", -0.02, study.taus.back() + 0.02, 0.1},
                               {"e, percent", 0, std::ceil(top * 2) / 2, 0.5},
                               {{"min-Ncut", "#d00", true, study.taus, study.by_tau}}));
}

struct Variation {
  std::string name;
  std::function<void(StraightPathParameters&)> change;
};

std::vector<Variation> variations() {
  using P = StraightPathParameters;
  std::vector<Variation> all = {{"as stated", [](P&) {}}};
  for (const double range : {8.0, 10.0, 16.0})
    all.push_back({fmt::format("range {:g} m", range), [=](P& p) { p.max_range_m = range; }});
  for (const double view : {45.0, 90.0, 180.0, 360.0})
    all.push_back({fmt::format("field of view {:g} deg", view),
                   [=](P& p) { p.field_of_view_rad = view * kDegree; }});
  for (const double width : {4.0, 10.0})
    all.push_back(
        {fmt::format("landmarks within {:g} m", width), [=](P& p) { p.half_width_m = width; }});
  for (const double step : {0.1, 0.2, 0.5})
    all.push_back({fmt::format("observation every {:g} m", step), [=](P& p) { p.step_m = step; }});
  for (const double factor : {0.3, 3.0, 10.0})
    all.push_back({fmt::format("odometry noise x {:g}", factor), [=](P& p) {
                     p.sigma_odometry_m *= factor;
                     p.sigma_odometry_rad *= factor;
                   }});
  for (const double factor : {0.3, 3.0})
    all.push_back({fmt::format("sensor noise x {:g}", factor), [=](P& p) {
                     p.sigma_range_m *= factor;
                     p.sigma_bearing_rad *= factor;
                   }});
  all.push_back({"last pose marginalized", [](P& p) { p.marginalize_pose = true; }});
  all.push_back({"landmarks known by name", [](P& p) { p.known_landmarks = true; }});
  return all;
}

void write_sensitivity(const std::filesystem::path& folder, int runs, int threads) {
  std::string csv =
      "parameter,ncut_mean_percent,ncut_p16,ncut_p84,ncut_groups,tau_to_0_mean,fixed_2_mean,"
      "fixed_10_mean,fixed_45_mean,lower_means,lower_deviations,lower_intervals\n";
  for (const Variation& variation : variations()) {
    StraightPathParameters parameters;
    variation.change(parameters);
    const StraightPathStudy s = study_straight_path(parameters, runs, {}, threads);
    csv += fmt::format("{},{:.4f},{:.4f},{:.4f},{:.2f},{:.5f},{:.4f},{:.4f},{:.4f},{},{},{}\n",
                       variation.name, s.ncut.mean, s.ncut.low, s.ncut.high, s.ncut_groups,
                       s.by_tau.front().mean, s.fixed[0].mean, s.fixed[8].mean, s.fixed.back().mean,
                       s.lower_means(), s.lower_deviations(), s.lower_intervals());
  }
  submap::write_file(folder / "fig8_sensitivity.csv", csv);
}

std::vector<Claim> claims(const StraightPathStudy& s) {
  const double below =
      s.ncut.high <= s.ncut.low ? 1 : std::min(1.0, (1 - s.ncut.low) / (s.ncut.high - s.ncut.low));
  const double at_zero = s.by_tau.front().mean;
  return {
      {fmt::format(
           "Fig. 8b: at tau 0.2 e = {:.3f} %, 68 % in [{:.3f}, {:.3f}]: most of it below 1 %",
           s.ncut.mean, s.ncut.low, s.ncut.high),
       below > 0.5},
      {fmt::format("Fig. 8b: lower mean than fixed k for {} of 44 values (at least 40)",
                   s.lower_means()),
       s.lower_means() >= 40},
      {fmt::format("Fig. 8b: lower spread for {} of 44 by the 68 % interval, {} by the standard "
                   "deviation (at least 40)",
                   s.lower_intervals(), s.lower_deviations()),
       s.lower_intervals() >= 40 && s.lower_deviations() >= 40},
      {fmt::format("Fig. 8c: e falls with tau to {:.4f} % at tau -> 0: below 0.1, not 0", at_zero),
       at_zero > 0 && at_zero < 0.1 && at_zero < s.ncut.mean}};
}

}  // namespace

std::vector<Claim> draw_straight_path(const std::filesystem::path& folder, int runs,
                                      bool sensitivity, int threads) {
  std::vector<double> taus;
  for (int i = 1; i <= 20; ++i) taus.push_back(0.05 * i);
  const StraightPathParameters parameters;
  const StraightPathStudy study = study_straight_path(parameters, runs, taus, threads);
  submap::write_file(folder / "fig8a.svg", run_svg(parameters, 1));
  write_methods(folder, study, runs);
  write_taus(folder, study, runs);
  if (sensitivity) write_sensitivity(folder, std::min(runs, kSensitivityRuns), threads);
  return claims(study);
}

}  // namespace hmt::paper
