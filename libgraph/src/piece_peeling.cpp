// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "piece_peeling.hpp"

#include <algorithm>
#include <numeric>

namespace hmt::graph {
namespace {

using Piece = std::vector<int>;

template <class F>
void for_each_neighbor(const CsrGraph& graph, int i, F&& f) {
  for (auto k = static_cast<size_t>(graph.offsets[static_cast<size_t>(i)]);
       k < static_cast<size_t>(graph.offsets[static_cast<size_t>(i) + 1]); ++k)
    f(graph.columns[k], graph.weights[k]);
}

uint8_t smaller_side(const Sides& sides) {
  return 2 * std::count(sides.begin(), sides.end(), 1) <= std::ssize(sides) ? 1 : 0;
}

std::vector<Piece> single_nodes(const CsrGraph& graph) {
  std::vector<int> order(graph.degrees.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&graph](int a, int b) {
    return graph.degrees[static_cast<size_t>(a)] < graph.degrees[static_cast<size_t>(b)];
  });
  std::vector<Piece> pieces;
  pieces.reserve(order.size());
  for (const int node : order) pieces.push_back({node});
  return pieces;
}

// Components of the group without the nodes that side `small` hangs on, smallest first, without the
// largest.
std::vector<Piece> hanging_pieces(const CsrGraph& graph, const Sides& sides, uint8_t small) {
  std::vector<int> part(sides.size(), 0);
  for (int i = 0; i < graph.size(); ++i)
    if (sides[static_cast<size_t>(i)] == small)
      for_each_neighbor(graph, i, [&](int j, double) {
        if (sides[static_cast<size_t>(j)] != small) part[static_cast<size_t>(j)] = 1;
      });
  const CsrGraph free = split(graph, part, 2).front();
  std::vector<int> local(static_cast<size_t>(graph.nodes.back()) + 1);
  for (int i = 0; i < graph.size(); ++i)
    local[static_cast<size_t>(graph.nodes[static_cast<size_t>(i)])] = i;
  int count = 0;
  const std::vector<int> component = connected_components(free, &count);
  std::vector<Piece> pieces(static_cast<size_t>(count));
  for (size_t i = 0; i < component.size(); ++i)
    pieces[static_cast<size_t>(component[i])].push_back(local[static_cast<size_t>(free.nodes[i])]);
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.size() < b.size(); });
  pieces.pop_back();
  return pieces;
}

class Peeler {
 public:
  Peeler(const CsrGraph& graph, double tau)
      : graph_(graph),
        tau_(tau),
        assoc_(std::accumulate(graph.degrees.begin(), graph.degrees.end(), 0.0)),
        left_(graph.size()) {
    peeling_.part.assign(graph.nodes.size(), 0);
  }

  Peeling run(const Piece& first, const Bisection& bisection, const std::vector<Piece>& others) {
    const double enough = assoc_ / 2;
    take(first, weigh(first));
    peeling_.bisections = {bisection};
    for (const Piece& piece : others) {
      if (assoc_ <= enough) break;
      if (std::any_of(piece.begin(), piece.end(), [this](int i) { return part(i) != 0; })) continue;
      const Weight weight = weigh(piece);
      const double ncut =
          weight.cut > 0 ? weight.cut / weight.assoc + weight.cut / (assoc_ - weight.assoc) : 0;
      if (std::ssize(piece) == left_ || ncut >= tau_) continue;
      take(piece, weight);
      peeling_.bisections.push_back({static_cast<int>(piece.size()), left_, ncut, 0, 0});
    }
    return std::move(peeling_);
  }

 private:
  struct Weight {
    double cut = 0;    // to what is left besides
    double assoc = 0;  // with all that is left
  };

  int& part(int i) { return peeling_.part[static_cast<size_t>(i)]; }

  Weight weigh(const Piece& piece) {
    Weight weight;
    for (const int i : piece) part(i) = -1;
    for (const int i : piece)
      for_each_neighbor(graph_, i, [&](int j, double w) {
        if (part(j) == 0) weight.cut += w;
        if (part(j) <= 0) weight.assoc += w;
      });
    for (const int i : piece) part(i) = 0;
    return weight;
  }

  void take(const Piece& piece, const Weight& weight) {
    for (const int i : piece) part(i) = peeling_.parts;
    ++peeling_.parts;
    assoc_ -= weight.assoc + weight.cut;
    left_ -= static_cast<int>(piece.size());
  }

  const CsrGraph& graph_;
  double tau_;
  double assoc_;  // of what is left with itself
  int left_;      // nodes
  Peeling peeling_;
};

Piece nodes_of(const Sides& sides, uint8_t side) {
  Piece nodes;
  for (size_t i = 0; i < sides.size(); ++i)
    if (sides[i] == side) nodes.push_back(static_cast<int>(i));
  return nodes;
}

}  // namespace

Peeling peel_pieces(const CsrGraph& graph, const SpectralCut& cut, double tau) {
  const uint8_t small = smaller_side(cut.sides);
  const Piece first = nodes_of(cut.sides, small);
  return Peeler(graph, tau)
      .run(first, report(cut),
           first.size() == 1 ? single_nodes(graph) : hanging_pieces(graph, cut.sides, small));
}

}  // namespace hmt::graph
