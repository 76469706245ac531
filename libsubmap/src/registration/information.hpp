// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// Inverse of a covariance over the coordinates that the space has; zero in the others.
Matrix6d inverse_in(Space space, const Matrix6d& matrix);

/// Information on T_a_c from independent information on T_a_b (frame b) and T_b_c (frame c),
/// either of which may be singular: (Ad I_ab^-1 Ad^T + I_bc^-1)^-1.
Matrix6d compose_information(Space space, const Pose& T_b_c, const Matrix6d& information_a_b,
                             const Matrix6d& information_b_c);

/// Whether a measurement tells more than the prediction in every direction of the space.
bool observes_all(Space space, const Matrix6d& information, const Matrix6d& predicted);

}  // namespace hmt::submap
