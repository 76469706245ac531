// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/landmarks_file.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "../log/line_source.hpp"
#include "../log/text_fields.hpp"
#include "number_text.hpp"

namespace hmt::submap {
namespace {

constexpr int kPositionDecimals = 6;
constexpr int kCovarianceDecimals = 9;

std::string csv_line(const HybridMap& map, const PlacedLandmark& l, const std::string& frame) {
  std::string line = std::to_string(landmark_name(map, l.landmark));
  line.append(",").append(frame);
  const auto add = [&line](double value, int decimals) {
    line.append(",").append(fixed_text(value, decimals));
  };
  for (const double value : l.position) add(value, kPositionDecimals);
  for (int r = 0; r < 3; ++r)
    for (int c = r; c < 3; ++c) add(l.covariance(r, c), kCovarianceDecimals);
  return line.append("\n");
}

}  // namespace

int64_t landmark_name(const HybridMap& map, int landmark) {
  const int64_t name = map.landmark_names.at(static_cast<size_t>(landmark));
  return name == kUnknownLandmark ? -1 - int64_t{landmark} : name;
}

std::string landmarks_csv(const HybridMap& map) {
  std::string csv = "landmark,frame,x_m,y_m,z_m,cov_xx,cov_xy,cov_xz,cov_yy,cov_yz,cov_zz\n";
  for (const PlacedLandmark& l : map.landmarks) csv += csv_line(map, l, "world");
  for (const Submap& submap : map.submaps)
    for (const PlacedLandmark& l : submap.landmarks)
      csv += csv_line(map, l, std::to_string(submap.id));
  return csv;
}

std::map<int64_t, Eigen::Vector2d> read_true_landmarks(const std::filesystem::path& path) {
  LineSource lines(path);
  std::map<int64_t, Eigen::Vector2d> landmarks;
  while (const auto line = lines.next()) {
    std::string_view fields = without_comment(*line);
    if (fields.empty()) continue;
    try {
      const auto name = to_count(take_field(fields));
      if (!name) throw std::invalid_argument("the name of the landmark is not a count");
      const double x_m = take_finite(fields, "x");
      landmarks[*name] = {x_m, take_finite(fields, "y")};
    } catch (const std::invalid_argument& error) {
      throw InputError(lines.place() + ": " + error.what() + "; a line is 'name x y'");
    }
  }
  if (!lines.damage().empty()) throw InputError(path.string() + ": " + lines.damage());
  if (landmarks.empty()) throw InputError(path.string() + ": no landmarks in the file");
  return landmarks;
}

LandmarkError evaluate_landmarks(const HybridMap& map,
                                 const std::map<int64_t, Eigen::Vector2d>& truth) {
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> matches;  // estimated, true
  for (const PlacedLandmark& l : map.landmarks)
    if (const auto found = truth.find(landmark_name(map, l.landmark)); found != truth.end())
      matches.emplace_back(l.position.head<2>(), found->second);
  if (matches.size() < 3)
    throw InputError(std::to_string(matches.size()) + " of the " + std::to_string(truth.size()) +
                     " true landmarks are in the map, three are needed; are they of one log?");
  Eigen::MatrixXd estimated(2, static_cast<Eigen::Index>(matches.size()));
  Eigen::MatrixXd expected = estimated;
  for (size_t k = 0; k < matches.size(); ++k) {
    estimated.col(static_cast<Eigen::Index>(k)) = matches[k].first;
    expected.col(static_cast<Eigen::Index>(k)) = matches[k].second;
  }
  const Eigen::MatrixXd T = Eigen::umeyama(estimated, expected, false);
  const Eigen::MatrixXd aligned =
      (T.topLeftCorner(2, 2) * estimated).colwise() + Eigen::VectorXd(T.topRightCorner(2, 1));
  const Eigen::VectorXd squares = (aligned - expected).colwise().squaredNorm();
  LandmarkError error;
  error.true_landmarks = static_cast<int64_t>(truth.size());
  error.matched = static_cast<int64_t>(matches.size());
  error.rmse_m = std::sqrt(squares.mean());
  error.max_m = std::sqrt(squares.maxCoeff());
  return error;
}

}  // namespace hmt::submap
