// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cut_refinement.hpp"

#include <algorithm>
#include <array>
#include <queue>
#include <vector>

namespace hmt::graph {
namespace {

// Passes end sooner in practice: one that does not lower the Ncut is the last.
constexpr int kMaxPasses = 20;
// Moves without a new minimum after which a pass gives up.
constexpr int kMaxStall = 60;
// Relative gain below which a change is rounding.
constexpr double kMinGain = 1e-12;

class Refinement {
 public:
  Refinement(const CsrGraph& graph, Sides& sides) : graph_(graph), sides_(sides) {
    to_other_.assign(sides.size(), 0);
    for (size_t i = 0; i < sides.size(); ++i) {
      ++count_[sides[i]];
      assoc_[sides[i]] += graph.degrees[i];
      for_each_neighbor(i, [&](size_t j, double w) {
        if (sides[j] != sides[i]) to_other_[i] += w;
      });
      if (sides[i] == 0) cut_ += to_other_[i];
    }
    locked_.assign(sides.size(), 0);
    key_.assign(sides.size(), 0);
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

  double ncut() const { return cut_ / assoc_[0] + cut_ / assoc_[1]; }

  // First-order drop of the Ncut if the node changes sides, with the totals of the start of the
  // pass, so that keys of nodes whose neighbors stand still stay valid.
  double gain(size_t i) const {
    const double less_cut = 2 * to_other_[i] - graph_.degrees[i];
    const double shift = sides_[i] == 0 ? assoc_slope_ : -assoc_slope_;
    return less_cut * cut_slope_ - shift * graph_.degrees[i];
  }

  void push(size_t i) {
    key_[i] = gain(i);
    queue_.push({key_[i], i});
  }

  void move(size_t i) {
    const size_t from = sides_[i];
    cut_ += graph_.degrees[i] - 2 * to_other_[i];
    assoc_[from] -= graph_.degrees[i];
    assoc_[1 - from] += graph_.degrees[i];
    --count_[from];
    ++count_[1 - from];
    to_other_[i] = graph_.degrees[i] - to_other_[i];
    sides_[i] = static_cast<uint8_t>(1 - from);
    for_each_neighbor(i,
                      [&](size_t j, double w) { to_other_[j] += sides_[j] == sides_[i] ? -w : w; });
  }

  void start_pass() {
    cut_slope_ = 1 / assoc_[0] + 1 / assoc_[1];
    assoc_slope_ = cut_ * (1 / (assoc_[0] * assoc_[0]) - 1 / (assoc_[1] * assoc_[1]));
    queue_ = {};
    for (size_t i = 0; i < sides_.size(); ++i)
      if (to_other_[i] > 0) push(i);
  }

  // Moves nodes, best first, and goes back to the best state on the way. False if that is the
  // first.
  bool run_pass() {
    start_pass();
    const double before = ncut();
    double best = before;
    std::vector<size_t> moves;
    size_t kept = 0;
    while (!queue_.empty() && moves.size() - kept < kMaxStall) {
      const Entry entry = queue_.top();
      queue_.pop();
      const size_t i = entry.node;
      if (locked_[i] != 0 || entry.gain != key_[i] || count_[sides_[i]] == 1) continue;
      move(i);
      locked_[i] = 1;
      moves.push_back(i);
      for_each_neighbor(i, [&](size_t j, double) {
        if (locked_[j] == 0) push(j);
      });
      if (ncut() < best * (1 - kMinGain)) {
        best = ncut();
        kept = moves.size();
      }
    }
    for (const size_t i : moves) locked_[i] = 0;
    for (size_t k = moves.size(); k > kept; --k) move(moves[k - 1]);
    return kept > 0;
  }

  const CsrGraph& graph_;
  Sides& sides_;
  double cut_ = 0;
  std::array<double, 2> assoc_ = {0, 0};
  std::array<size_t, 2> count_ = {0, 0};
  double cut_slope_ = 0;
  double assoc_slope_ = 0;
  std::vector<double> to_other_;  // weight from the node to the other side
  std::vector<double> key_;       // gain under which the node was queued last
  std::vector<uint8_t> locked_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

void refine_cut(const CsrGraph& graph, Sides& sides) {
  if (sides.size() < 3) return;
  const Sides given = sides;
  const double before = measure_cut(graph, given).ncut();
  Refinement(graph, sides).run();
  // The running totals carry rounding; the verdict is on sums made anew.
  if (measure_cut(graph, sides).ncut() >= before) sides = given;
}

}  // namespace hmt::graph
