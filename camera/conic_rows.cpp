// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/conic_rows.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "camera/homography.h"

namespace tranos::camera {
namespace {

constexpr double kRank = 1e-9;

Conic EqualLengthUnitRow(const Vec3& u, const Vec3& v) {
  return EqualLengthRow(u, v) / std::max(u.squaredNorm(), v.squaredNorm());
}

// The first three columns of P, up to a common scale, from the axes' vanishing points and the
// edges and points in space: linear in the columns' scales and the fourth column. A column along
// which nothing in space varies, or that cannot be known, is none.
AxisPoints ScaledAxes(const AxisPoints& points, const SpaceTraces& traces) {
  std::vector<int> axes;
  for (int i = 0; i < 3; ++i) {
    if (!traces.varies(i)) continue;
    if (!points[static_cast<size_t>(i)]) return {};
    axes.push_back(i);
  }
  const auto count = std::ssize(axes);
  if (count < 2) return {};
  SpaceTraces centred = traces;
  const Vec3 centre = traces.centre_m();
  for (SpaceEdge& e : centred.edges) e.from_m -= centre, e.to_m -= centre;
  for (SpacePoint& p : centred.points) p.point_m -= centre;
  AxisPoints result;
  ProjectionMatrix projection;
  for (int pass = 0; pass < 2; ++pass) {
    const ProjectionRows rows = ProjectionRowsOf(centred, pass == 0 ? nullptr : &projection);
    if (rows.rows() < count + 2 || !rows.allFinite()) return {};
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(6, rows.rows()), count + 3);
    for (Eigen::Index i = 0; i < count; ++i)
      a.col(i).head(rows.rows()) = rows.middleCols<3>(3 * axes[static_cast<size_t>(i)]) *
                                   *points[static_cast<size_t>(axes[static_cast<size_t>(i)])];
    a.topRightCorner(rows.rows(), 3) = rows.rightCols<3>();
    const Eigen::VectorXd size = a.colwise().norm();
    if (!(size.minCoeff() > 0)) return {};
    a = (a * size.cwiseInverse().asDiagonal()).eval();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
    const Eigen::MatrixXd upper = qr.matrixQR().topRows(count + 3).triangularView<Eigen::Upper>();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(upper, Eigen::ComputeFullV);
    if (!(svd.singularValues()[count + 1] > kRank * svd.singularValues()[0])) return {};
    const Eigen::VectorXd scales = svd.matrixV().col(count + 2).cwiseQuotient(size);
    projection.setZero();
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto axis = static_cast<size_t>(axes[static_cast<size_t>(i)]);
      if (std::abs(scales[i] * size[i]) < kRank) return {};
      result[axis] = scales[i] * *points[axis];
      projection.col(static_cast<Eigen::Index>(axis)) = *result[axis];
    }
    projection.col(3) = scales.tail<3>();
  }
  return result;
}

// An edge's vanishing point, scaled by its length in the facade: the difference of its ends, each
// divided by its distance from the vanishing line.
Vec3 ScaledDirection(const Vec2& a, const Vec2& b, const Vec3& vanishing_line) {
  const Vec3 p = a.homogeneous(), q = b.homogeneous();
  return q / vanishing_line.dot(q) - p / vanishing_line.dot(p);
}

// The conic through dots, of least algebraic distance.
std::optional<Mat3> ImageOfCircle(const CircleTrace& trace, const Conditioning& conditioning) {
  Eigen::MatrixXd rows(std::max<Eigen::Index>(6, std::ssize(trace.dots_px)), 6);
  rows.setZero();
  for (Eigen::Index i = 0; i < std::ssize(trace.dots_px); ++i) {
    const Vec2 p = conditioning.PointFromDot(trace.dots_px[static_cast<size_t>(i)]);
    rows.row(i) << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y(), 1;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
  if (!(svd.singularValues()[4] > kRank * svd.singularValues()[0])) return {};
  const Eigen::VectorXd c = svd.matrixV().col(5);
  Mat3 conic;
  conic << c[0], c[1] / 2, c[3] / 2, c[1] / 2, c[2], c[4] / 2, c[3] / 2, c[4] / 2, c[5];
  return conic;
}

// The two points x ± iy at which the image of a circle meets its plane's vanishing line: they are
// the images of the circular points, so that x and y are like orthogonal edges of equal length
// (Hartley and Zisserman, Multiple View Geometry, 2.7). None if they are real: no circle's image.
std::optional<std::pair<Vec3, Vec3>> CircularPoints(const Mat3& conic, const Vec3& line) {
  const Vec3 u = line.unitOrthogonal(), v = line.cross(u);
  const double a = u.dot(conic * u), b = u.dot(conic * v), c = v.dot(conic * v);
  const double rest = a * c - b * b;
  if (!(rest > 0)) return {};
  return std::pair(Vec3(u - b / c * v), Vec3(std::sqrt(rest) / c * v));
}

}  // namespace

std::vector<Conic> ConicRows::all() const {
  std::vector<Conic> rows = orthogonal;
  rows.insert(rows.end(), metric.begin(), metric.end());
  return rows;
}

ConicRows ConicRowsOf(const Photograph& photograph, const Numbers& numbers) {
  const Conditioning conditioning = ConditioningOf(photograph.frame);
  const AxisLines lines = AxisLinesOf(photograph, numbers);
  ConicRows result;
  for (size_t i = 0; i < 3; ++i)
    if (const auto point = FitVanishingPoint(lines[i], conditioning)) {
      result.axes[i] = *point;
      result.points[i] = point->point;
    }

  std::vector<Conic> of_rectangles;
  std::vector<std::pair<int, Vec3>> vanishing_lines;  // of facades
  for (const Trace& trace : photograph.traces) {
    const auto* r = std::get_if<RectangleTrace>(&trace);
    if (!r) continue;
    std::array<Vec2, 4> dots;
    for (size_t i = 0; i < 4; ++i) dots[i] = conditioning.PointFromDot(r->dots_px[i]);
    const auto h = HomographyOfRectangle(dots, numbers.values[r->a], numbers.values[r->b]);
    if (!h) continue;
    const Vec3 x = h->col(0), z = h->col(1);
    of_rectangles.push_back(EqualLengthUnitRow(x, z));
    of_rectangles.push_back(OrthogonalRow(x.normalized(), z.normalized()));
    vanishing_lines.push_back({r->facade, x.cross(z).normalized()});
    if (!result.points[2]) result.points[2] = z.normalized();
    if (r->facade == 0 && !result.points[0] && !WorldIsFixed(photograph))
      result.points[0] = x.normalized();
  }

  const AxisPoints& p = result.points;
  for (const auto& [i, j] : {std::pair<size_t, size_t>{0, 2}, {1, 2}, {0, 1}})
    if (p[i] && p[j]) result.orthogonal.push_back(OrthogonalRow(*p[i], *p[j]));
  const AxisPoints scaled = ScaledAxes(p, SpaceTracesOf(photograph, numbers));
  for (const auto& [i, j] : {std::pair<size_t, size_t>{0, 2}, {1, 2}, {0, 1}})
    if (scaled[i] && scaled[j]) result.metric.push_back(EqualLengthUnitRow(*scaled[i], *scaled[j]));
  result.metric.insert(result.metric.end(), of_rectangles.begin(), of_rectangles.end());

  // The main facade's vanishing line comes better from the axes than from a small rectangle.
  if (p[0] && p[2])
    vanishing_lines.insert(vanishing_lines.begin(), {0, p[0]->cross(*p[2]).normalized()});
  const auto vanishing_line = [&](int facade) -> const Vec3* {
    const auto found = std::ranges::find(vanishing_lines, facade, &std::pair<int, Vec3>::first);
    return found == vanishing_lines.end() ? nullptr : &found->second;
  };
  const auto add_like = [&](const Vec3& u, const Vec3& v) {
    if (!u.allFinite() || !v.allFinite() || u.isZero() || v.isZero()) return;
    result.metric.push_back(EqualLengthUnitRow(u, v));
    result.metric.push_back(OrthogonalRow(u.normalized(), v.normalized()));
  };
  for (const Trace& trace : photograph.traces) {
    if (const auto* ratio = std::get_if<RatioTrace>(&trace)) {
      const Vec3* const line = vanishing_line(ratio->facade);
      if (!line) continue;
      const auto dot = [&](int i) { return conditioning.PointFromDot(ratio->dots_px[i]); };
      add_like(ScaledDirection(dot(0), dot(1), *line),
               numbers.values[ratio->ratio] * ScaledDirection(dot(2), dot(3), *line));
    } else if (const auto* circle = std::get_if<CircleTrace>(&trace)) {
      const Vec3* const line = vanishing_line(circle->facade);
      const std::optional<Mat3> conic = ImageOfCircle(*circle, conditioning);
      if (!line || !conic) continue;
      const auto points = CircularPoints(*conic, *line);
      if (points) add_like(points->first, points->second);
    }
  }
  return result;
}

std::vector<Conic> IndependentRows(std::span<const Conic> rows, int rank) {
  std::vector<Conic> chosen, basis;
  for (const Conic& row : rows) {
    if (std::ssize(chosen) >= rank) break;
    Conic left = row;
    for (int pass = 0; pass < 2; ++pass)
      for (const Conic& b : basis) left -= b.dot(left) * b;
    if (!(left.norm() > 1e-6 * row.norm())) continue;
    basis.push_back(left.normalized());
    chosen.push_back(row);
  }
  return chosen;
}

}  // namespace tranos::camera
