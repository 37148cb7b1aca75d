// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/dlt.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

namespace tranos::camera {
namespace {

constexpr double kRank = 1e-9;

tl::unexpected<geom::Error> Degenerate(const char* detail) {
  return tl::unexpected(geom::Error{geom::ErrorCode::kDegenerate, detail});
}

// The world about the traces' centre, in units of their spread.
struct Normalized {
  SpaceTraces traces;
  Eigen::Matrix4d from_world;
};

Normalized Normalize(const SpaceTraces& traces) {
  Normalized result{traces, Eigen::Matrix4d::Identity()};
  const Vec3 centre = traces.centre_m();
  double spread = 0;
  const auto widen = [&](const Vec3& p) { spread = std::max(spread, (p - centre).norm()); };
  for (const SpaceEdge& e : traces.edges) widen(e.from_m), widen(e.to_m);
  for (const SpacePoint& p : traces.points) widen(p.point_m);
  const double scale = spread > 0 ? 1 / spread : 1;
  const auto map = [&](Vec3* p) { *p = scale * (*p - centre); };
  for (SpaceEdge& e : result.traces.edges) map(&e.from_m), map(&e.to_m);
  for (SpacePoint& p : result.traces.points) map(&p.point_m);
  result.from_world.topLeftCorner<3, 3>() *= scale;
  result.from_world.topRightCorner<3, 1>() = -scale * centre;
  return result;
}

}  // namespace

geom::Result<ConditionedCamera> DecomposeProjection(const ProjectionMatrix& projection) {
  Mat3 m = projection.leftCols<3>();
  const double determinant = m.determinant();
  if (!(std::abs(determinant) > 1e-12 * std::pow(m.norm(), 3)))
    return Degenerate("the projection matrix is not that of a camera at a finite place");
  m *= (determinant < 0 ? -1 : 1) / m.row(2).norm();
  // Gram–Schmidt from the last row on: M = K R with K upper triangular.
  Mat3 k = Mat3::Identity(), r;
  r.row(2) = m.row(2);
  k(1, 2) = m.row(1).dot(r.row(2));
  const Eigen::RowVector3d second = m.row(1) - k(1, 2) * r.row(2);
  k(1, 1) = second.norm();
  r.row(1) = second / k(1, 1);
  r.row(0) = r.row(1).cross(r.row(2));
  k(0, 0) = m.row(0).dot(r.row(0));
  k(0, 1) = m.row(0).dot(r.row(1));
  k(0, 2) = m.row(0).dot(r.row(2));
  const Vec3 position = -projection.leftCols<3>().partialPivLu().solve(projection.col(3));
  return ConditionedCamera{k.inverse(), NearestRotation(r), position};
}

geom::Result<ProjectionMatrix> FitProjection(const SpaceTraces& traces) {
  const Normalized normalized = Normalize(traces);
  if (2 * (traces.edges.size() + traces.points.size()) < 11)
    return Degenerate("the projection has eleven unknowns: six points or edges are needed");
  ProjectionMatrix projection;
  for (int i = 0; i < 3; ++i) {
    const ProjectionRows rows = ProjectionRowsOf(normalized.traces, i == 0 ? nullptr : &projection);
    if (!rows.allFinite()) return Degenerate("a point lies in the plane of the camera");
    Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(std::max<Eigen::Index>(12, rows.rows()), 12);
    padded.topRows(rows.rows()) = rows;
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(padded);
    const Eigen::Matrix<double, 12, 12> upper =
        qr.matrixQR().topRows<12>().triangularView<Eigen::Upper>();
    const Eigen::JacobiSVD<Eigen::Matrix<double, 12, 12>> svd(upper, Eigen::ComputeFullV);
    if (!(svd.singularValues()[10] > kRank * svd.singularValues()[0]))
      return Degenerate("points and edges leave the projection open, as when they are in a plane");
    projection = svd.matrixV().col(11).reshaped(3, 4);
  }
  projection = (projection * normalized.from_world).eval();
  const double depth = projection.row(2).dot(traces.centre_m().homogeneous());
  return ProjectionMatrix((depth < 0 ? -1 : 1) * projection / projection.norm());
}

geom::Result<Camera> CalibrateDlt(const Photograph& photograph, const Numbers& numbers) {
  const SpaceTraces traces = SpaceTracesOf(photograph, numbers);
  const geom::Result<ProjectionMatrix> projection = FitProjection(traces);
  if (!projection) return tl::unexpected(projection.error());
  const geom::Result<ConditionedCamera> camera = DecomposeProjection(*projection);
  if (!camera) return tl::unexpected(camera.error());
  if (!InFront(traces, *camera))
    return Degenerate("the picture is mirrored: what is traced would be behind the camera");
  return CameraOf(*camera, photograph.frame);
}

}  // namespace tranos::camera
