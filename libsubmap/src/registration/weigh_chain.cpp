// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "weigh_chain.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>

#include "../observation/median.hpp"
#include "noise_components.hpp"
#include "odometry_model.hpp"

namespace hmt::submap {
namespace {

constexpr std::array<size_t, 4> kWays{1, 2, 4, 8};  // keyframes
constexpr size_t kLeastSteps = 100;
// Information so small (100 m, 100 rad) that it says nothing.
constexpr double kNothing = 1e-4;
// A tenth of a millimetre, or of a milliradian, in a metre: no odometry is better.
constexpr double kLeastRate = 1e-8;
// A registration errs by up to four times what it claims. What does not grow with the way beyond
// that is odometry's, too: one that knows no tilt is off by as much after a metre as after ten.
constexpr double kMostExtra = 15;  // variances
// Motion of a step below this share of the usual one: odometry stood still while the robot did not.
constexpr double kLeastShare = 0.5;

/// A way over some keyframes by both.
struct Way {
  size_t steps = 0;
  double length_m = 0;
  Vector6d motion = Vector6d::Zero();
  Vector6d difference = Vector6d::Zero();  // odometry - registration
  Vector6d known_variance = Vector6d::Zero();
};

/// What is learnt of one direction.
struct AxisNoise {
  NoiseComponents noise;
  double odometry_step = 0;  // variance of odometry that does not grow with the way
  double error_per_m = 0;    // of odometry, always
};

class ChainWeights {
 public:
  explicit ChainWeights(const std::vector<ChainStep>& chain) : chain_(chain) {
    for (const size_t steps : kWays)
      for (size_t begin = 0; begin + steps <= chain.size(); ++begin) add_way(begin, steps);
  }

  bool enough() const {
    return static_cast<size_t>(std::count_if(ways_.begin(), ways_.end(), [](const Way& way) {
             return way.steps == 1;
           })) >= kLeastSteps;
  }

  void learn() {
    for (Eigen::Index axis = 0; axis < 6; ++axis) learn_axis(axis);
  }

  WeighedStep weigh(const ChainStep& step) const {
    if (!step.has_odometry) return {step.estimate, Matrix6d::Zero()};
    // (I^-1 + N)^-1, also where I is singular.
    const Matrix6d registration_noise = registration_variances().asDiagonal();
    const Matrix6d narrowed =
        (Matrix6d::Identity() + step.information * registration_noise).inverse();
    const Matrix6d measured = narrowed * step.information;
    const Matrix6d odometry = odometry_variances(step).cwiseInverse().asDiagonal();
    const Vector6d difference = boxminus(corrected(step), step.estimate);
    const Matrix6d both = measured + odometry;
    const Matrix6d inverse = both.inverse();
    // Squared Mahalanobis distance between odometry d and registration m with their informations O
    // and M: a^T (M^-1 - (M + O)^-1) a, a = M (d - m).
    const Vector6d apart = measured * difference;
    const Matrix6d covariance = (measured + kNothing * Matrix6d::Identity()).inverse();
    const double doubt = std::max(1.0, apart.dot((covariance - inverse) * apart) / 6);
    const Matrix6d information = both / doubt;
    return {boxplus(step.estimate, inverse * (odometry * difference)),
            (information + information.transpose()) / 2};
  }

 private:
  void add_way(size_t begin, size_t steps) {
    Way way;
    way.steps = steps;
    Pose odometry, estimate;
    for (size_t k = begin; k < begin + steps; ++k) {
      const ChainStep& step = chain_[k];
      if (!step.has_odometry) return;
      odometry = odometry * step.odometry;
      estimate = estimate * step.estimate;
      way.length_m += step.odometry.translation.norm();
      way.motion += OdometryModel::motion_by_axis(step.odometry);
    }
    const ChainStep& last = chain_[begin + steps - 1];
    if (last.information.isZero(0) || way.motion.minCoeff() <= 0) return;
    const Matrix6d covariance = (last.information + kNothing * Matrix6d::Identity()).inverse();
    way.difference = boxminus(odometry, estimate);
    way.known_variance = covariance.diagonal();
    ways_.push_back(way);
  }

  void learn_axis(Eigen::Index axis) {
    std::vector<double> errors, step_motions, step_variances;
    std::vector<NoiseSample> samples;
    for (const Way& way : ways_) {
      if (way.length_m > 0) errors.push_back(way.difference[axis] / way.length_m);
      samples.push_back({way.difference[axis], way.motion[axis], way.known_variance[axis]});
      if (way.steps > 1) continue;
      step_motions.push_back(way.motion[axis]);
      step_variances.push_back(way.known_variance[axis]);
    }
    AxisNoise& of_axis = axes_[static_cast<size_t>(axis)];
    usual_motion_[axis] = median(std::move(step_motions));
    const double claimed = median(std::move(step_variances));
    of_axis = noise_of(samples, claimed);
    const double of_odometry =
        of_axis.noise.odometry_rate * usual_motion_[axis] + of_axis.odometry_step;
    if (errors.empty() || of_odometry < of_axis.noise.registration + claimed) return;
    const double error_per_m = median(std::move(errors));
    for (size_t k = 0; k < samples.size(); ++k)
      samples[k].difference -= error_per_m * ways_[k].length_m;
    of_axis = noise_of(samples, claimed);
    of_axis.error_per_m = error_per_m;
  }

  static AxisNoise noise_of(std::span<const NoiseSample> samples, double claimed) {
    AxisNoise of_axis;
    of_axis.noise = separate_noise(samples);
    const double extra = std::min(of_axis.noise.registration, kMostExtra * claimed);
    of_axis.odometry_step = of_axis.noise.registration - extra;
    of_axis.noise.registration = extra;
    return of_axis;
  }

  Vector6d registration_variances() const {
    Vector6d variances;
    for (size_t k = 0; k < 6; ++k)
      variances[static_cast<Eigen::Index>(k)] = axes_[k].noise.registration;
    return variances;
  }

  Vector6d odometry_variances(const ChainStep& step) const {
    const Vector6d motion =
        OdometryModel::motion_by_axis(step.odometry).cwiseMax(kLeastShare * usual_motion_);
    Vector6d variances;
    for (size_t k = 0; k < 6; ++k)
      variances[static_cast<Eigen::Index>(k)] = std::max(axes_[k].noise.odometry_rate, kLeastRate) *
                                                    motion[static_cast<Eigen::Index>(k)] +
                                                axes_[k].odometry_step;
    return variances;
  }

  Pose corrected(const ChainStep& step) const {
    Vector6d errors;
    for (size_t k = 0; k < 6; ++k) errors[static_cast<Eigen::Index>(k)] = axes_[k].error_per_m;
    return boxplus(step.odometry, -step.odometry.translation.norm() * errors);
  }

  const std::vector<ChainStep>& chain_;
  std::vector<Way> ways_;
  std::array<AxisNoise, 6> axes_;
  Vector6d usual_motion_ = Vector6d::Zero();
};

}  // namespace

std::optional<std::vector<WeighedStep>> weigh_chain(const std::vector<ChainStep>& chain) {
  ChainWeights weights(chain);
  if (!weights.enough()) return std::nullopt;
  weights.learn();
  std::vector<WeighedStep> weighed;
  for (const ChainStep& step : chain) weighed.push_back(weights.weigh(step));
  return weighed;
}

}  // namespace hmt::submap
