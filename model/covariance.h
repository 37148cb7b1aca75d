// SPDX-License-Identifier: GPL-3.0-or-later
// How uncertain an element is that hangs on sources of uncertainty.
#pragma once

#include <optional>

#include "model/element.h"

namespace tranos::model {

// How far a source is moved to either side, in its deviations: little enough for what is curved,
// enough for the rounding of coordinates.
inline constexpr double kMovedBy = 0.01;

// The covariance of a point's coordinates, m². Nothing if the element is no point, or hangs on no
// source.
std::optional<Eigen::Matrix3d> CovarianceOf(const Element& element);

}  // namespace tranos::model
