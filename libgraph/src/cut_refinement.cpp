// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cut_refinement.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace hmt::graph {
namespace {

// Passes end sooner in practice: one that does not lower the Ncut is the last.
constexpr int kMaxPasses = 20;
// Moves without a new minimum after which a pass gives up.
constexpr int kMaxStall = 60;
// Relative gain below which a change is rounding.
constexpr double kMinGain = 1e-12;
// Up to this size looking through all nodes for the best is faster than a heap, whose entries
// change with every move.
constexpr size_t kMaxSearchSize = 1000;
constexpr double kNotQueued = -std::numeric_limits<double>::infinity();

// cut(A)/assoc(A) + cut(B)/assoc(B); the cut between the sides is counted in both.
double objective(const std::array<double, 2>& cut, const std::array<double, 2>& assoc) {
  return (cut[0] > 0 ? cut[0] / assoc[0] : 0) + (cut[1] > 0 ? cut[1] / assoc[1] : 0);
}

double measure(const CsrGraph& graph, const Sides& sides, const std::vector<double>& outside) {
  const Cut between = measure_cut(graph, sides);
  std::array<double, 2> cut = {between.cut, between.cut};
  std::array<double, 2> assoc = {between.assoc_a, between.assoc_b};
  for (size_t i = 0; i < outside.size(); ++i) {
    cut[sides[i]] += outside[i];
    assoc[sides[i]] += outside[i];
  }
  return objective(cut, assoc);
}

class Refinement {
 public:
  Refinement(const CsrGraph& graph, Sides& sides, const std::vector<double>& outside)
      : graph_(graph), sides_(sides), outside_(outside), searches_(sides.size() <= kMaxSearchSize) {
    to_other_.assign(sides.size(), 0);
    for (size_t i = 0; i < sides.size(); ++i) {
      ++count_[sides[i]];
      for_each_neighbor(i, [&](size_t j, double w) {
        if (sides[j] != sides[i]) to_other_[i] += w;
      });
      assoc_[sides[i]] += degree(i);
      cut_[sides[i]] += to_other_[i] + outside_weight(i);
    }
    locked_.assign(sides.size(), 0);
  }

  void run() {
    for (int pass = 0; pass < kMaxPasses && run_pass(); ++pass) {
    }
  }

 private:
  struct Entry {
    double gain;
    size_t node;
    bool operator<(const Entry& o) const { return gain != o.gain ? gain < o.gain : node > o.node; }
  };

  template <class F>
  void for_each_neighbor(size_t i, F&& f) const {
    for (auto k = static_cast<size_t>(graph_.offsets[i]);
         k < static_cast<size_t>(graph_.offsets[i + 1]); ++k)
      f(static_cast<size_t>(graph_.columns[k]), graph_.weights[k]);
  }

  double outside_weight(size_t i) const { return outside_.empty() ? 0 : outside_[i]; }
  double degree(size_t i) const { return graph_.degrees[i] + outside_weight(i); }

  // First-order drop of the objective if the node changes sides, with the totals of the start of
  // the pass, so that keys of nodes whose neighbors stand still stay valid.
  double gain(size_t i) const {
    const size_t from = sides_[i];
    const double less_between = 2 * to_other_[i] - graph_.degrees[i];
    return (less_between + outside_weight(i)) * cut_slope_[from] +
           (less_between - outside_weight(i)) * cut_slope_[1 - from] -
           degree(i) * (assoc_slope_[from] - assoc_slope_[1 - from]);
  }

  void push(size_t i) {
    key_[i] = gain(i);
    if (searches_) return;
    queue_.push_back({key_[i], i});
    std::push_heap(queue_.begin(), queue_.end());
  }

  // The queued node of the largest gain, the smallest of equals, which leaves the queue; the number
  // of nodes where the queue is empty.
  size_t pop() {
    size_t best = key_.size();
    if (searches_) {
      const auto largest = std::max_element(key_.begin(), key_.end());
      if (*largest > kNotQueued) best = static_cast<size_t>(largest - key_.begin());
    }
    while (!queue_.empty() && best == key_.size()) {
      const auto [gain, node] = queue_.front();
      std::pop_heap(queue_.begin(), queue_.end());
      queue_.pop_back();
      if (gain == key_[node]) best = node;
    }
    if (best < key_.size()) key_[best] = kNotQueued;
    return best;
  }

  void move(size_t i) {
    const size_t from = sides_[i];
    const double less_between = 2 * to_other_[i] - graph_.degrees[i];
    cut_[from] -= less_between + outside_weight(i);
    cut_[1 - from] -= less_between - outside_weight(i);
    assoc_[from] -= degree(i);
    assoc_[1 - from] += degree(i);
    --count_[from];
    ++count_[1 - from];
    to_other_[i] = graph_.degrees[i] - to_other_[i];
    sides_[i] = static_cast<uint8_t>(1 - from);
    for_each_neighbor(i,
                      [&](size_t j, double w) { to_other_[j] += sides_[j] == sides_[i] ? -w : w; });
  }

  void start_pass() {
    for (size_t side = 0; side < 2; ++side) {
      cut_slope_[side] = assoc_[side] > 0 ? 1 / assoc_[side] : 0;
      assoc_slope_[side] = cut_[side] * cut_slope_[side] * cut_slope_[side];
    }
    queue_.clear();
    key_.assign(sides_.size(), kNotQueued);
    for (size_t i = 0; i < sides_.size(); ++i)
      if (to_other_[i] > 0) push(i);
  }

  // Moves nodes, best first, and goes back to the best state on the way. False if that is the
  // first.
  bool run_pass() {
    start_pass();
    double best = objective(cut_, assoc_);
    std::vector<size_t> moves;
    size_t kept = 0;
    while (moves.size() - kept < kMaxStall) {
      const size_t i = pop();
      if (i == key_.size()) break;
      if (count_[sides_[i]] == 1) continue;
      move(i);
      locked_[i] = 1;
      moves.push_back(i);
      for_each_neighbor(i, [&](size_t j, double) {
        if (locked_[j] == 0) push(j);
      });
      if (objective(cut_, assoc_) < best * (1 - kMinGain)) {
        best = objective(cut_, assoc_);
        kept = moves.size();
      }
    }
    for (const size_t i : moves) locked_[i] = 0;
    for (size_t k = moves.size(); k > kept; --k) move(moves[k - 1]);
    return kept > 0;
  }

  const CsrGraph& graph_;
  Sides& sides_;
  const std::vector<double>& outside_;
  std::array<double, 2> cut_ = {0, 0};
  std::array<double, 2> assoc_ = {0, 0};
  std::array<size_t, 2> count_ = {0, 0};
  std::array<double, 2> cut_slope_ = {0, 0};    // d objective / d cut of a side
  std::array<double, 2> assoc_slope_ = {0, 0};  // -d objective / d assoc of a side
  std::vector<double> to_other_;                // weight from the node to the other side
  bool searches_;
  std::vector<double> key_;  // gain under which the node is queued
  std::vector<uint8_t> locked_;
  std::vector<Entry> queue_;  // heap; entries whose gain is no longer the key are void
};

}  // namespace

double refine_cut(const CsrGraph& graph, Sides& sides, const std::vector<double>& outside) {
  if (sides.size() < 3) return 0;
  const Sides given = sides;
  const double before = measure(graph, given, outside);
  Refinement(graph, sides, outside).run();
  // The running totals carry rounding; the verdict is on sums made anew.
  const double gain = before - measure(graph, sides, outside);
  if (gain > kMinGain * before) return gain;
  sides = given;
  return 0;
}

}  // namespace hmt::graph
