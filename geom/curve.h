// SPDX-License-Identifier: GPL-3.0-or-later
// Exact curves. A curve stays what it was drawn as (an arc is an arc) until output asks for
// points. Every curve has a natural parameter t in [0, 1] from its start to its end.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "geom/primitives.h"

namespace tranos::geom {

struct Line {
  Vec3 start, end;
};

// Starts at frame.origin + radius·frame.x and turns towards frame.y by sweep_rad in (0, 2π].
struct Arc {
  Frame frame;
  double radius;
  double sweep_rad;
};

struct Circle {
  Frame frame;
  double radius;
};

// Straight pieces through the vertices; `closed` adds the piece from the last to the first
// (which is not repeated).
struct Polyline {
  std::vector<Vec3> vertices;
  bool closed = false;
};

// A rational B-spline with clamped knots; weights empty for a polynomial one.
struct BsplineCurve {
  int degree = 1;
  std::vector<double> knots;
  std::vector<Vec3> poles;
  std::vector<double> weights;
};

using Segment = std::variant<Line, Arc, Circle, Polyline, BsplineCurve>;

// Segments that follow one another end to start. `closed`: the last ends where the first starts.
struct Chain {
  std::vector<Segment> segments;
  bool closed = false;
};

using Curve = std::variant<Line, Arc, Circle, Polyline, BsplineCurve, Chain>;

// The arc from `start` through `on` to `end`; kDegenerate if they are collinear or coincide.
Result<Arc> ArcThrough(const Vec3& start, const Vec3& on, const Vec3& end);
// The arc about `centre` from `start`, counter-clockwise about `normal`, to the direction of `end`.
Result<Arc> ArcAround(const Vec3& centre, const Vec3& start, const Vec3& end, const Vec3& normal);

// Coordinates beyond this are refused: products of them would overflow.
inline constexpr double kLargestCoordinate_m = 1e30;

// Whether the curve is sound: finite numbers, orthonormal frames, clamped ascending knots,
// positive weights. Of a curve that is not, measures are zero and boxes empty.
tl::expected<void, Error> Check(const Curve&);
// Finite, ascending, the first and the last degree + 1 times, none inside more than degree times.
bool AreClampedKnots(const std::vector<double>& knots, int degree);

// Curves joined to one chain, each turned round where needed, the first keeping its direction if
// possible; order as given. kDoNotMeet with the index of the first that does not reach the one
// before.
Result<Chain> JoinChain(const std::vector<Curve>& curves, double tolerance_m = 1e-6);

Vec3 PointAt(const Curve&, double t);                 // at the natural parameter, clamped to [0, 1]
Vec3 PointAtFraction(const Curve&, double fraction);  // at this fraction of its length
double ParameterAtFraction(const Curve&, double fraction);
Vec3 TangentAt(const Curve&, double t);  // unit, in the direction of travel
bool IsClosed(const Curve&);
double Length(const Curve&);                // m; 1e-9 relative
Result<double> EnclosedArea(const Curve&);  // m²; closed and planar, else an error
Result<Vec3> Centroid(const Curve&);        // of the enclosed plane region
Box BoundingBox(const Curve&);              // tight to 1e-9 m
// The plane a curve lies in, origin at its start; nothing for a straight or a twisted curve.
std::optional<Frame> PlaneOf(const Curve&);

struct Nearest {
  Vec3 point = Vec3::Zero();
  double distance_m = 0;
  double t = 0;
};
Nearest NearestPoint(const Curve&, const Vec3& p);

Curve Reversed(const Curve&);
// Exact: an arc stays an arc under a similarity and becomes a B-spline under a shear or stretch.
Curve Transformed(const Curve&, const Affine& target_from_source);
// The same points as one rational B-spline, knots of a chain's segments with full multiplicity.
BsplineCurve ToBspline(const Curve&);
// Vertices along the curve, both ends included (a closed curve's start is not repeated).
// kTooLarge above ten million points.
Result<std::vector<Vec3>> Tessellate(const Curve&, const Tolerance&);

}  // namespace tranos::geom
