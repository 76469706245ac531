// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "match_landmarks.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace hmt::submap {
namespace {

/// Which landmarks have their counterpart already.
struct Taken {
  std::vector<char> a;
  std::vector<char> b;

  Taken(const SensedLandmarks& landmarks_a, const SensedLandmarks& landmarks_b)
      : a(static_cast<size_t>(landmarks_a.size()), 0),
        b(static_cast<size_t>(landmarks_b.size()), 0) {}

  /// True where both were free until now.
  bool take(int i, int j) {
    char &of_a = a[static_cast<size_t>(i)], &of_b = b[static_cast<size_t>(j)];
    if (of_a != 0 || of_b != 0) return false;
    of_a = of_b = 1;
    return true;
  }
};

struct Candidate {
  int i = 0;
  int j = 0;
  double square_distance = 0;

  /// Ties are broken alike when a and b are exchanged: (i, j) and (j, i) share no landmark.
  std::tuple<double, int, int> key() const {
    return {square_distance, std::min(i, j), std::max(i, j)};
  }
};

int match_names(const SensedLandmarks& a, const SensedLandmarks& b, Taken& taken) {
  int matches = 0;
  auto i = a.by_name().begin();
  auto j = b.by_name().begin();
  while (i != a.by_name().end() && j != b.by_name().end()) {
    const int64_t id_a = a[*i].id, id_b = b[*j].id;
    if (id_a == id_b)
      matches += taken.take(*i++, *j++) ? 1 : 0;
    else if (id_a < id_b)
      ++i;
    else
      ++j;
  }
  return matches;
}

/// Decides which landmarks without a common name can be one.
class Gate {
 public:
  Gate(const SensedLandmarks& a, const SensedLandmarks& b, const PoseSpread& spread,
       const OverlapOptions& options)
      : spread_(spread),
        square_distance_(options.max_mahalanobis * options.max_mahalanobis),
        descriptor_gate_(std::min(a.descriptor_gate(), b.descriptor_gate())) {}

  /// Square of the largest distance of a landmark from any with a gate of at most `gate`.
  double reach(const SensedLandmark& l, double gate) const {
    return l.gate + gate + square_distance_ * l.max_pose_deviation_m * l.max_pose_deviation_m;
  }

  /// Square of the distance that orders correspondences; nothing where there is none.
  std::optional<double> square_distance(const SensedLandmark& a, const SensedLandmark& b) const {
    if (a.id != kUnknownLandmark && b.id != kUnknownLandmark) return std::nullopt;
    const Eigen::Vector3d epsilon = a.position - b.position;
    if (epsilon.squaredNorm() > reach(a, b.gate)) return std::nullopt;
    const Eigen::Vector3d middle = (a.position + b.position) / 2;
    const double limit = std::min(a.max_pose_deviation_m, b.max_pose_deviation_m);
    if (spread_.trace(middle) > limit * limit) return std::nullopt;
    const Eigen::Matrix3d S = spread_.covariance(middle) + a.covariance + b.covariance;
    const double square = epsilon.dot(S.inverse() * epsilon);
    if (!(square <= square_distance_)) return std::nullopt;
    const double share = descriptor_share(a, b);
    if (share > 1) return std::nullopt;
    return square + square_distance_ * share * share;
  }

 private:
  /// Distance of the descriptors against their gate, 0 where they say nothing.
  double descriptor_share(const SensedLandmark& a, const SensedLandmark& b) const {
    if (a.descriptor.empty() || a.descriptor.size() != b.descriptor.size()) return 0;
    const double distance = descriptor_distance(a.descriptor, b.descriptor);
    return distance > 0 ? distance / descriptor_gate_ : 0;
  }

  const PoseSpread& spread_;
  double square_distance_ = 0;
  double descriptor_gate_ = 0;
};

std::vector<Candidate> candidates(const SensedLandmarks& a, const SensedLandmarks& b,
                                  const Gate& gate, const Taken& taken) {
  std::vector<Candidate> found;
  for (int i = 0; i < a.size(); ++i) {
    if (taken.a[static_cast<size_t>(i)] != 0) continue;
    const double reach = std::sqrt(gate.reach(a[i], b.max_gate()));
    auto j = std::lower_bound(b.by_x().begin(), b.by_x().end(), a[i].position.x() - reach,
                              [&](int k, double x) { return b[k].position.x() < x; });
    for (; j != b.by_x().end() && b[*j].position.x() <= a[i].position.x() + reach; ++j) {
      if (taken.b[static_cast<size_t>(*j)] != 0) continue;
      const auto square = gate.square_distance(a[i], b[*j]);
      if (square) found.push_back({i, *j, *square});
    }
  }
  return found;
}

}  // namespace

int match_landmarks(const SensedLandmarks& a, const SensedLandmarks& b, const PoseSpread& spread,
                    const OverlapOptions& options) {
  Taken taken(a, b);
  int matches = match_names(a, b, taken);
  // All but the unnamed have found theirs by name, if there is one.
  const auto all_named = [](const SensedLandmarks& l) {
    return static_cast<int>(l.by_name().size()) == l.size();
  };
  if (all_named(a) && all_named(b)) return matches;
  std::vector<Candidate> found = candidates(a, b, Gate(a, b, spread, options), taken);
  std::sort(found.begin(), found.end(),
            [](const Candidate& x, const Candidate& y) { return x.key() < y.key(); });
  for (const Candidate& c : found) matches += taken.take(c.i, c.j) ? 1 : 0;
  return matches;
}

}  // namespace hmt::submap
