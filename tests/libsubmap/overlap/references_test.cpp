// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "references.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hmt::submap {
namespace {

/// Arcs of keyframe `to` with the first `count` keyframes.
std::vector<graph::Arc> arcs_with_first(int count, int to, double weight) {
  std::vector<graph::Arc> arcs;
  for (int k = 0; k < count; ++k) arcs.push_back({k, to, weight});
  return arcs;
}

TEST(References, AreAllKeyframesAtFirst) {
  const References references(500);
  EXPECT_TRUE(references.is_reference(499));
  EXPECT_TRUE(references.is_compared(0, 499));
}

TEST(References, LeaveOutAKeyframeThatSixteenOfThemShow) {
  References references(500);
  references.thin(400, 402, arcs_with_first(16, 400, 0.5));
  EXPECT_FALSE(references.is_reference(400));
  EXPECT_TRUE(references.is_reference(401));
  // It is compared with its own visit, and with references before it.
  EXPECT_TRUE(references.is_compared(400, 500));
  EXPECT_FALSE(references.is_compared(400, 501));
  EXPECT_TRUE(references.is_compared(0, 400));
}

TEST(References, KeepAKeyframeThatFewerShowOrLessOfIt) {
  References references(500);
  references.thin(400, 401, arcs_with_first(15, 400, 1.0));
  references.thin(401, 402, arcs_with_first(100, 401, 0.49));
  EXPECT_TRUE(references.is_reference(400));
  EXPECT_TRUE(references.is_reference(401));
}

TEST(References, DoNotCountTheVisitItselfNorKeyframesThatAreNone) {
  References references(500);
  references.thin(100, 101, arcs_with_first(100, 100, 1.0));
  EXPECT_TRUE(references.is_reference(100));
  for (int k = 150; k < 200; ++k) references.thin(k, k + 1, arcs_with_first(20, k, 1.0));
  ASSERT_FALSE(references.is_reference(199));
  std::vector<graph::Arc> arcs;
  for (int k = 150; k < 200; ++k) arcs.push_back({k, 400, 1.0});
  references.thin(400, 401, arcs);
  EXPECT_TRUE(references.is_reference(400));
}

}  // namespace
}  // namespace hmt::submap
