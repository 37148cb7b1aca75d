// SPDX-License-Identifier: GPL-3.0-or-later
// Curves cut shorter and made longer.
#pragma once

#include "geom/curve.h"

namespace tranos::geom {

// The stretch of the curve between two natural parameters, exactly; of a closed one, where `from`
// is not below `to`, on through its start. A part of one piece of a chain or polyline is that
// piece's. kDegenerate for a stretch of no length.
Result<Curve> PartOf(const Curve& curve, double from, double to);

// The parts between the parameters, which ascend from 0 to 1: of an open curve one more than there
// are parameters, of a closed one as many. Parameters at an open curve's ends cut nothing.
std::vector<Curve> Divided(const Curve& curve, std::vector<double> parameters);

// The natural parameters at equal fractions of the length, `parts` - 1 of them; for a closed curve
// `parts`, the first 0.
std::vector<double> EqualParameters(const Curve& curve, int parts);

enum class CurveEnd : std::uint8_t { kStart, kEnd };

// The curve with its last piece gone on beyond the end: a line straight ahead, an arc round its
// centre. kOutOfRange with its reason for a closed curve, a B-spline's end, an arc that would go
// round more than once, a length that is not positive.
Result<Curve> LengthenedBy(const Curve& curve, CurveEnd end, double length_m);
// Until it first meets one of the others. kDoNotMeet if it never does.
Result<Curve> LengthenedTo(const Curve& curve, CurveEnd end, const std::vector<Curve>& others);

}  // namespace tranos::geom
