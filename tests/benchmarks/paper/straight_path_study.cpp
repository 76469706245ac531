// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "straight_path_study.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <set>

namespace hmt::paper {
namespace {

/// Information loss of one run in percent, and how many submaps there are.
struct Outcome {
  double ncut = 0;
  double ncut_groups = 0;
  std::vector<double> fixed;
  std::vector<double> by_tau;
  std::vector<double> groups_by_tau;
};

/// Observations without any landmark are groups of their own; they say nothing here.
double groups_with_landmarks(const StraightPathRun& run, const graph::Labels& labels) {
  std::set<int> groups;
  for (size_t k = 0; k < labels.size(); ++k)
    if (!run.seen[k].empty()) groups.insert(labels[k]);
  return static_cast<double>(groups.size());
}

graph::Labels cut_at(const StraightPathRun& run, double tau) {
  graph::PartitionOptions options;
  options.tau = tau;
  return graph::recursive_partition(run.overlap, options).labels;
}

Outcome evaluate(const StraightPathRun& run, const std::vector<double>& taus) {
  const auto percent = [&run](const graph::Labels& labels) {
    return 100 * landmark_information_loss(run, labels);
  };
  Outcome outcome;
  const graph::Labels ncut = cut_at(run, kPaperTau);
  outcome.ncut = percent(ncut);
  outcome.ncut_groups = groups_with_landmarks(run, ncut);
  for (int k = kLeastFixed; k <= kMostFixed; ++k) {
    graph::Labels fixed(run.seen.size());
    for (size_t i = 0; i < fixed.size(); ++i) fixed[i] = static_cast<int>(i) / k;
    outcome.fixed.push_back(percent(fixed));
  }
  for (const double tau : taus) {
    const graph::Labels labels = cut_at(run, tau);
    outcome.by_tau.push_back(percent(labels));
    outcome.groups_by_tau.push_back(groups_with_landmarks(run, labels));
  }
  return outcome;
}

template <typename Value>
Statistics over_runs(const std::vector<Outcome>& outcomes, const Value& value) {
  std::vector<double> sample;
  for (const Outcome& outcome : outcomes) sample.push_back(value(outcome));
  return statistics(std::move(sample));
}

template <typename Spread>
int count_lower(const StraightPathStudy& study, const Spread& spread) {
  return static_cast<int>(
      std::count_if(study.fixed.begin(), study.fixed.end(),
                    [&](const Statistics& s) { return spread(study.ncut) < spread(s); }));
}

}  // namespace

int StraightPathStudy::lower_means() const {
  return count_lower(*this, [](const Statistics& s) { return s.mean; });
}

int StraightPathStudy::lower_deviations() const {
  return count_lower(*this, [](const Statistics& s) { return s.deviation; });
}

int StraightPathStudy::lower_intervals() const {
  return count_lower(*this, [](const Statistics& s) { return s.high - s.low; });
}

StraightPathStudy study_straight_path(const StraightPathParameters& parameters, int runs,
                                      const std::vector<double>& taus, int threads) {
  StraightPathStudy study;
  study.taus = taus;
  study.taus.insert(study.taus.begin(), kTauToZero);
  std::vector<Outcome> outcomes(static_cast<size_t>(runs));
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(0, runs, [&](int i) {
      outcomes[static_cast<size_t>(i)] =
          evaluate(run_straight_path(parameters, static_cast<uint64_t>(i) + 1), study.taus);
    });
  });
  study.ncut = over_runs(outcomes, [](const Outcome& o) { return o.ncut; });
  study.ncut_groups = over_runs(outcomes, [](const Outcome& o) { return o.ncut_groups; }).mean;
  for (size_t k = 0; k < outcomes.front().fixed.size(); ++k)
    study.fixed.push_back(over_runs(outcomes, [k](const Outcome& o) { return o.fixed[k]; }));
  for (size_t t = 0; t < study.taus.size(); ++t) {
    study.by_tau.push_back(over_runs(outcomes, [t](const Outcome& o) { return o.by_tau[t]; }));
    study.groups_by_tau.push_back(
        over_runs(outcomes, [t](const Outcome& o) { return o.groups_by_tau[t]; }).mean);
  }
  return study;
}

}  // namespace hmt::paper
