// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "command.hpp"
#include "hmt/graph/information_loss.hpp"
#include "hmt/graph/point_information_loss.hpp"
#include "hmt/graph/weighted_graph.hpp"

namespace hmt::apps {

/// What the commands of partition work on.
struct PartitionInput {
  graph::WeightedGraph overlap;
  /// Of the pose graph of all keyframes; a matrix has none.
  std::optional<graph::InformationBlocks> information;
  /// Of its landmarks alone, if it has any, and for each of these the keyframes that sighted it.
  std::optional<graph::PointInformationBlocks> landmark_information;
  std::vector<std::vector<int>> keyframes_of_landmark;
  /// Metres travelled and seconds passed up to each keyframe; empty for a matrix. Stamps that run
  /// backwards count as no time.
  std::vector<double> metres;
  std::vector<double> seconds;

  /// e of Eq. 22 of a partition; nothing for a matrix.
  std::optional<double> information_loss(const graph::Labels& labels) const;
  /// The same of the landmarks alone, as the paper measures it, and the mean number of groups that
  /// hold a landmark; nothing without landmarks.
  struct LandmarkLoss {
    double information_loss = 0;
    double copies = 0;
  };
  std::optional<LandmarkLoss> landmark_loss(const graph::Labels& labels) const;
};

/// Reads a weight matrix or a map; a log is mapped first, with default options, into a temporary
/// file. Kinds are told by content.
PartitionInput read_partition_input(const std::filesystem::path& path, const Globals& globals);

}  // namespace hmt::apps
