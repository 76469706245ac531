// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

/// More landmarks than any sensor sees around one place.
constexpr int kMostLandmarks = 64;

}  // namespace

LandmarkFilter::LandmarkFilter(Space space, const Pose& T_track_robot,
                               const OdometryErrors& deviation)
    : rows_(space == Space::se2 ? 2 : 3),
      T_track_robot_(T_track_robot),
      covariance_(Rows::Zero(kPose + kErrors, kPose + kErrors)) {
  covariance_.diagonal().tail<kErrors>() = deviation.cwiseAbs2();
}

void LandmarkFilter::predict(const Pose& T_before_now, const Matrix6d& covariance) {
  T_track_robot_ = T_track_robot_ * T_before_now;
  const Matrix6d F = graph::adjoint(T_before_now.inverse());
  covariance_.topRows<kPose>() = (F * covariance_.topRows<kPose>()).eval();
  covariance_.leftCols<kPose>() = (covariance_.leftCols<kPose>() * F.transpose()).eval();
  covariance_.topLeftCorner<kPose, kPose>() += covariance;
}

void LandmarkFilter::predict_told(const Pose& told, double duration_s, const Matrix6d& covariance) {
  const Pose step = without_errors(told, duration_s, errors_);
  predict(step, covariance);
  const Eigen::Matrix<double, kPose, kErrors> J = by_odometry_errors(told, duration_s, errors_);
  const Eigen::Matrix<double, kPose, Eigen::Dynamic> change =
      J * covariance_.middleRows<kErrors>(kPose);
  covariance_.topRows<kPose>() += change;
  covariance_.topLeftCorner<kPose, kPose>() +=
      change.leftCols<kPose>().transpose() + J * change.middleCols<kErrors>(kPose).transpose();
  covariance_.leftCols<kPose>() = covariance_.topRows<kPose>().transpose().eval();
}

LandmarkFilter::Prediction LandmarkFilter::predict_measurement(int slot) const {
  Prediction predicted;
  predicted.J_point = T_track_robot_.rotation_matrix().transpose();
  predicted.p_robot =
      predicted.J_point * (p_track_[static_cast<size_t>(slot)] - T_track_robot_.translation);
  predicted.J_pose << -Eigen::Matrix3d::Identity(), graph::skew(predicted.p_robot);
  return predicted;
}

Eigen::Matrix3d LandmarkFilter::innovation_covariance(int slot, const Prediction& predicted,
                                                      const Eigen::Matrix3d& measured) const {
  const int row = row_of(slot);
  const Eigen::Matrix3d cross =
      predicted.J_pose * covariance_.block<kPose, 3>(0, row) * predicted.J_point.transpose();
  return predicted.J_pose * covariance_.topLeftCorner<kPose, kPose>() *
             predicted.J_pose.transpose() +
         predicted.J_point * covariance_.block<3, 3>(row, row) * predicted.J_point.transpose() +
         cross + cross.transpose() + measured;
}

std::optional<Innovation> LandmarkFilter::innovation(int landmark,
                                                     const MeasuredLandmark& measured) const {
  const auto found = slot_of_.find(landmark);
  if (found == slot_of_.end()) return std::nullopt;
  const Prediction predicted = predict_measurement(found->second);
  const Eigen::Matrix3d S = innovation_covariance(found->second, predicted, measured.covariance);
  const Eigen::LLT<Rows> llt(S.topLeftCorner(rows_, rows_));
  const Eigen::VectorXd nu = (measured.p_robot - predicted.p_robot).head(rows_);
  const Eigen::VectorXd diagonal = llt.matrixLLT().diagonal();
  return Innovation{nu.dot(llt.solve(nu)), 2 * diagonal.array().log().sum()};
}

void LandmarkFilter::update(int landmark, const MeasuredLandmark& measured) {
  const int slot = slot_of_.at(landmark);
  last_seen_[static_cast<size_t>(slot)] = ++calls_;
  const Prediction predicted = predict_measurement(slot);
  const Eigen::Matrix3d S = innovation_covariance(slot, predicted, measured.covariance);
  const Eigen::LLT<Rows> llt(S.topLeftCorner(rows_, rows_));
  const Rows PHt = (covariance_.leftCols<kPose>() * predicted.J_pose.transpose() +
                    covariance_.middleCols<3>(row_of(slot)) * predicted.J_point.transpose())
                       .leftCols(rows_);
  const Rows K = llt.solve(PHt.transpose()).transpose();
  const Eigen::VectorXd step = K * (measured.p_robot - predicted.p_robot).head(rows_);
  covariance_.noalias() -= K * PHt.transpose();
  covariance_ = ((covariance_ + covariance_.transpose()) / 2).eval();
  T_track_robot_ = graph::boxplus(T_track_robot_, step.head<kPose>());
  errors_ += step.segment<kErrors>(kPose);
  for (const auto& [number, at] : slot_of_)
    p_track_[static_cast<size_t>(at)] += step.segment<3>(row_of(at));
}

void LandmarkFilter::forget(int landmark) {
  const int slot = slot_of_.at(landmark);
  slot_of_.erase(landmark);
  covariance_.middleRows<3>(row_of(slot)).setZero();
  covariance_.middleCols<3>(row_of(slot)).setZero();
  last_seen_[static_cast<size_t>(slot)] = 0;
}

int LandmarkFilter::free_slot() {
  if (static_cast<int>(slot_of_.size()) == kMostLandmarks) {
    const auto oldest =
        std::min_element(slot_of_.begin(), slot_of_.end(), [this](const auto& l, const auto& r) {
          return last_seen_[static_cast<size_t>(l.second)] <
                 last_seen_[static_cast<size_t>(r.second)];
        });
    forget(oldest->first);
  }
  const auto free = std::find(last_seen_.begin(), last_seen_.end(), 0);
  const auto slot = static_cast<int>(free - last_seen_.begin());
  if (free != last_seen_.end()) return slot;
  last_seen_.push_back(0);
  p_track_.emplace_back(Eigen::Vector3d::Zero());
  const Eigen::Index size = covariance_.rows();
  covariance_.conservativeResize(size + 3, size + 3);
  covariance_.bottomRows<3>().setZero();
  covariance_.rightCols<3>().setZero();
  return slot;
}

void LandmarkFilter::insert(int landmark, const MeasuredLandmark& measured) {
  const int slot = free_slot();
  const int row = row_of(slot);
  slot_of_[landmark] = slot;
  last_seen_[static_cast<size_t>(slot)] = ++calls_;
  p_track_[static_cast<size_t>(slot)] = T_track_robot_ * measured.p_robot;
  const Eigen::Matrix3d R = T_track_robot_.rotation_matrix();
  Eigen::Matrix<double, 3, 6> J_pose;
  J_pose << R, -R * graph::skew(measured.p_robot);
  const Eigen::Matrix<double, 3, Eigen::Dynamic> rows = J_pose * covariance_.topRows<kPose>();
  const Eigen::Matrix3d own =
      rows.leftCols<kPose>() * J_pose.transpose() + R * measured.covariance * R.transpose();
  covariance_.middleRows<3>(row) = rows;
  covariance_.middleCols<3>(row) = rows.transpose();
  covariance_.block<3, 3>(row, row) = own;
}

}  // namespace hmt::submap
