// SPDX-License-Identifier: GPL-3.0-or-later
// Common points of Bézier spans. Internal to geom.
#pragma once

#include "geom/bezier.h"

namespace tranos::geom {

// Points of the one row of spans within kMeeting_m of the other, one for each place where they
// cross or touch.
std::vector<Vec3> MeetBySpans(const std::vector<BezierSpan>& a, const std::vector<BezierSpan>& b);

}  // namespace tranos::geom
