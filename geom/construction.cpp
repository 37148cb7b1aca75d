// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/construction.h"

#include <Eigen/SparseLU>
#include <cmath>

#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

tl::unexpected<Error> Degenerate(const char* detail, std::size_t part) {
  return tl::unexpected(Error{ErrorCode::kDegenerate, detail, static_cast<int>(part)});
}

// Derivatives at the points with which the cubics between them have equal second derivatives: a
// row for each point, `chords` from each to the next.
Eigen::MatrixXd SmoothDerivatives(const Eigen::MatrixXd& points, const std::vector<double>& chords,
                                  bool closed) {
  const Eigen::Index count = points.rows();
  Eigen::SparseMatrix<double> matrix(count, count);
  Eigen::MatrixXd right(count, points.cols());
  std::vector<Eigen::Triplet<double>> entries;
  const auto slope = [&](Eigen::Index i) -> Eigen::RowVectorXd {
    return (points.row((i + 1) % count) - points.row(i)) / chords[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!closed && (i == 0 || i + 1 == count)) {
      const Eigen::Index other = i == 0 ? 1 : i - 1;
      entries.emplace_back(i, i, 2);
      entries.emplace_back(i, other, 1);
      right.row(i) = 3 * slope(std::min(i, other));
      continue;
    }
    const Eigen::Index before = (i + count - 1) % count;
    const double h0 = chords[before], h1 = chords[i];
    entries.emplace_back(i, before, h1);
    entries.emplace_back(i, i, 2 * (h0 + h1));
    entries.emplace_back(i, (i + 1) % count, h0);
    right.row(i) = 3 * (h1 * slope(before) + h0 * slope(i));
  }
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
  return solver.solve(right);
}

// The spans [i, i + 1] of a periodic B-spline with uniform knots and these poles.
std::vector<BezierSpan> PeriodicSpans(const std::vector<Vec3>& poles, int degree) {
  std::vector<double> knots;
  for (int i = 0; i <= 2 * degree + 1; ++i) knots.push_back(i);
  std::vector<BezierSpan> spans;
  for (std::size_t first = 0; first < poles.size(); ++first) {
    BezierPoles control(4, degree + 1);
    for (int i = 0; i <= degree; ++i) {
      control.col(i) = Homogeneous(poles[(first + static_cast<std::size_t>(i)) % poles.size()], 1);
    }
    BezierSpan span;
    span.poles = BezierOver(knots, degree, control, degree, degree + 1);
    spans.push_back(std::move(span));
  }
  return spans;
}

}  // namespace

BsplineCurve Ellipse(const Frame& frame, double half_axis_x, double half_axis_y) {
  Affine world_from_unit = frame.WorldFromFrame();
  world_from_unit.scale(Vec3(half_axis_x, half_axis_y, 1));
  return ToBspline(Transformed(ToBspline(Circle{Frame{}, 1}), world_from_unit));
}

Polyline RegularPolygon(const Frame& frame, double radius, int sides) {
  Polyline polygon{{}, true};
  for (int i = 0; i < sides; ++i) {
    const CosSin at = ExactCosSin(2 * kPi * i / sides);
    polygon.vertices.push_back(frame.ToWorld({radius * at.cos, radius * at.sin, 0}));
  }
  return polygon;
}

CubicRow CubicThrough(const Eigen::MatrixXd& points, const std::vector<double>& chords,
                      bool closed) {
  const Eigen::Index count = points.rows(), spans = closed ? count : count - 1;
  const Eigen::MatrixXd derivatives = SmoothDerivatives(points, chords, closed);
  const auto chord = [&](Eigen::Index i) { return chords[static_cast<std::size_t>(i)]; };
  const auto after = [&](Eigen::Index i) -> Eigen::RowVectorXd {
    return points.row(i) + chord(i) / 3 * derivatives.row(i);
  };
  const auto before_next = [&](Eigen::Index i) -> Eigen::RowVectorXd {
    const Eigen::Index next = (i + 1) % count;
    return points.row(next) - chord(i) / 3 * derivatives.row(next);
  };
  CubicRow cubic;
  cubic.poles.resize(spans + 3, points.cols());
  cubic.poles.row(0) = points.row(0);
  cubic.poles.row(1) = after(0);
  // Where three neighbouring knots meet in the blossom, one cubic reaches on into the next span.
  for (Eigen::Index i = 0; i + 1 < spans; ++i) {
    const Eigen::RowVectorXd a = after(i), b = before_next(i);
    cubic.poles.row(i + 2) = a + (chord(i) + chord(i + 1)) / chord(i) * (b - a);
  }
  cubic.poles.row(spans + 1) = before_next(spans - 1);
  cubic.poles.row(spans + 2) = points.row(spans % count);
  cubic.knots = {0, 0, 0, 0};
  for (const double length : chords) cubic.knots.push_back(cubic.knots.back() + length);
  cubic.knots.insert(cubic.knots.end(), 3, cubic.knots.back());
  return cubic;
}

Result<BsplineCurve> CurveThrough(const std::vector<Vec3>& points, bool closed) {
  const std::size_t count = points.size(), spans = closed ? count : count - 1;
  if (count < (closed ? 3u : 2u)) return Degenerate("it has too few points", count - 1);
  std::vector<double> chords;
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(count), 3);
  for (std::size_t i = 0; i < count; ++i) rows.row(static_cast<Eigen::Index>(i)) = points[i];
  for (std::size_t i = 0; i < spans; ++i) {
    chords.push_back((points[(i + 1) % count] - points[i]).norm());
    if (!(chords[i] > kCoincident_m)) {
      return Degenerate("two neighbouring points coincide", i + 1 == count ? i : i + 1);
    }
  }
  CubicRow cubic = CubicThrough(rows, chords, closed);
  BsplineCurve curve;
  curve.degree = 3;
  curve.knots = std::move(cubic.knots);
  for (const auto& pole : cubic.poles.rowwise()) curve.poles.emplace_back(pole.transpose());
  if (!Check(curve)) return Degenerate("its points are too unevenly spaced", count - 1);
  return curve;
}

Result<BsplineCurve> CurveByPoles(const std::vector<Vec3>& poles, int degree, bool closed) {
  if (poles.size() < (closed ? 3u : 2u))
    return Degenerate("it has too few poles", poles.size() - 1);
  if (degree < 1 || degree > kMaxDegree) {
    return tl::unexpected(Error{ErrorCode::kOutOfRange, "a degree lies from 1 to 24"});
  }
  degree = std::min(degree, static_cast<int>(poles.size()) - 1);
  if (closed) return JoinSpans(PeriodicSpans(poles, degree));
  BsplineCurve curve;
  curve.degree = degree;
  curve.poles = poles;
  curve.knots.assign(degree, 0.0);
  const int spans = static_cast<int>(poles.size()) - degree;
  for (int i = 0; i <= spans; ++i) curve.knots.push_back(i);
  curve.knots.insert(curve.knots.end(), degree, spans);
  return curve;
}

Result<Curve> TangentArc(const Vec3& start, const Vec3& tangent, const Vec3& end) {
  const Vec3 chord = end - start;
  const double ahead = chord.dot(tangent);
  const Vec3 aside = chord - ahead * tangent;
  if (aside.norm() <= kCoincident_m) {
    if (ahead > kCoincident_m) return Line{start, end};
    return Degenerate(ahead < -kCoincident_m ? "the end lies straight behind the start"
                                             : "it ends where it starts",
                      1);
  }
  // The angle between tangent and chord is half of the sweep.
  const Vec3 inward = aside.normalized();
  const double radius = chord.squaredNorm() / (2 * aside.norm());
  const double sweep_rad = 2 * std::atan2(aside.norm(), ahead);
  return Arc{Frame{start + radius * inward, -inward, tangent}, radius, sweep_rad};
}

}  // namespace tranos::geom
