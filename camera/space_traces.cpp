// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/space_traces.h"

#include <Eigen/LU>
#include <cmath>

namespace tranos::camera {
namespace {

Vec3 PointOf(const Numbers& numbers, NumberIndex at) { return numbers.values.segment<3>(at); }

using Row = Eigen::Matrix<double, 1, 12>;

Row FormOf(const Vec3& line, const Vec3& point) {
  Row row;
  row << point.x() * line.transpose(), point.y() * line.transpose(), point.z() * line.transpose(),
      line.transpose();
  return row;
}

}  // namespace

Vec3 SpaceTraces::centre_m() const {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const SpaceEdge& e : edges) sum += e.from_m + e.to_m, count += 2;
  for (const SpacePoint& p : points) sum += p.point_m, count += 1;
  return count > 0 ? Vec3(sum / count) : sum;
}

bool SpaceTraces::varies(int axis) const {
  geom::Box box;
  for (const SpaceEdge& e : edges) box.Add(e.from_m), box.Add(e.to_m);
  for (const SpacePoint& p : points) box.Add(p.point_m);
  if (box.empty()) return false;
  const Vec3 size = box.max - box.min;
  return size[axis] > 1e-9 * size.maxCoeff();
}

bool WorldIsFixed(const Photograph& photograph) {
  for (const Trace& trace : photograph.traces)
    if (std::holds_alternative<EdgeTrace>(trace) || std::holds_alternative<PointTrace>(trace) ||
        std::holds_alternative<CurveTrace>(trace))
      return true;
  return false;
}

SpaceTraces SpaceTracesOf(const Photograph& photograph, const Numbers& numbers) {
  const Conditioning conditioning = ConditioningOf(photograph.frame);
  SpaceTraces result;
  const bool fixed = WorldIsFixed(photograph);
  bool has_rectangle = false;
  for (const Trace& trace : photograph.traces) {
    if (const auto* edge = std::get_if<EdgeTrace>(&trace)) {
      const ImageLine& line = edge->line;
      result.edges.push_back(
          {conditioning.LineFromImageLine(line.coordinates()), conditioning.PointFromDot(line.a_px),
           conditioning.PointFromDot(line.b_px), PointOf(numbers, edge->from),
           PointOf(numbers, edge->to), conditioning.scale_px / line.centre_sigma_px,
           conditioning.scale_px / line.tilt_sigma_px});
    } else if (const auto* point = std::get_if<PointTrace>(&trace)) {
      result.points.push_back({conditioning.PointFromDot(point->dot_px),
                               PointOf(numbers, point->at),
                               conditioning.scale_px / point->sigma_px});
    } else if (const auto* r = std::get_if<RectangleTrace>(&trace)) {
      if (fixed || has_rectangle || r->facade != 0) continue;
      has_rectangle = true;
      const double a = numbers.values[r->a], b = numbers.values[r->b];
      const Vec3 corners[4] = {{0, 0, 0}, {a, 0, 0}, {a, 0, b}, {0, 0, b}};
      for (int i = 0; i < 4; ++i)
        result.points.push_back({conditioning.PointFromDot(r->dots_px[i]), corners[i],
                                 conditioning.scale_px / r->sigma_px});
    }
  }
  return result;
}

AxisLines AxisLinesOf(const Photograph& photograph, const Numbers& numbers) {
  AxisLines lines;
  for (const Trace& trace : photograph.traces) {
    if (const auto* direction = std::get_if<DirectionTrace>(&trace)) {
      lines[static_cast<size_t>(direction->axis)].push_back(direction->line);
    } else if (const auto* edge = std::get_if<EdgeTrace>(&trace)) {
      const Vec3 along = (PointOf(numbers, edge->to) - PointOf(numbers, edge->from)).cwiseAbs();
      Eigen::Index axis = 0;
      const double length = along.maxCoeff(&axis);
      if (length > 0 && along.sum() - length < 1e-9 * length)
        lines[static_cast<size_t>(axis)].push_back(edge->line);
    }
  }
  return lines;
}

Camera CameraOf(const ConditionedCamera& camera, const Frame& frame) {
  const Mat3 k = FrameFromConditioned(frame) * camera.inverse_calibration.inverse();
  return CameraOf(k, camera.camera_from_world, camera.position_m);
}

ConditionedCamera ConditionedCameraOf(const Camera& camera, const Frame& frame) {
  return {(FrameFromConditioned(frame).inverse() * FrameFromCamera(camera.parameters)).inverse(),
          CameraFromWorld(camera.parameters), camera.position_m()};
}

double PenaltyOf(const SpaceTraces& traces, const ConditionedCamera& camera) {
  const Mat3 to_line = camera.inverse_calibration.transpose() * camera.camera_from_world;
  double penalty = 0;
  for (const SpaceEdge& e : traces.edges) {
    const Vec3 line = to_line * (e.from_m - camera.position_m).cross(e.to_m - camera.position_m);
    const double a = line.x() * e.a.x() + line.y() * e.a.y() + line.z();
    const double b = line.x() * e.b.x() + line.y() * e.b.y() + line.z();
    const double centre = 0.5 * (a + b) * e.centre_weight, tilt = (b - a) * e.tilt_weight;
    penalty += (centre * centre + tilt * tilt) / (line.x() * line.x() + line.y() * line.y());
  }
  if (traces.points.empty()) return penalty;
  const Mat3 m = camera.inverse_calibration.inverse() * camera.camera_from_world;
  for (const SpacePoint& p : traces.points) {
    const Vec3 x = m * (p.point_m - camera.position_m);
    penalty += (x.hnormalized() - p.at).squaredNorm() * p.weight * p.weight;
  }
  return penalty;
}

bool InFront(const SpaceTraces& traces, const ConditionedCamera& camera) {
  const Vec3 axis = camera.camera_from_world.row(2);
  const auto before = [&](const Vec3& point) { return axis.dot(point - camera.position_m) > 0; };
  for (const SpaceEdge& e : traces.edges)
    if (!before(e.from_m) || !before(e.to_m)) return false;
  for (const SpacePoint& p : traces.points)
    if (!before(p.point_m)) return false;
  return true;
}

ProjectionRows ProjectionRowsOf(const SpaceTraces& traces, const ProjectionMatrix* reference) {
  ProjectionRows rows(2 * std::ssize(traces.edges) + 2 * std::ssize(traces.points), 12);
  Eigen::Index at = 0;
  for (const SpaceEdge& e : traces.edges) {
    Row from = FormOf(e.line, e.from_m), to = FormOf(e.line, e.to_m);
    double at_a = 0, at_b = 1;  // where the traced ends are between the ends of the edge's image
    if (reference) {
      const Vec3 p = *reference * e.from_m.homogeneous(), q = *reference * e.to_m.homogeneous();
      from /= p.z(), to /= q.z();
      const Vec2 along = q.hnormalized() - p.hnormalized();
      at_a = along.dot(e.a - p.hnormalized()) / along.squaredNorm();
      at_b = along.dot(e.b - p.hnormalized()) / along.squaredNorm();
    }
    const double middle = 0.5 * (at_a + at_b);
    rows.row(at++) = e.centre_weight * ((1 - middle) * from + middle * to);
    rows.row(at++) = e.tilt_weight * (at_b - at_a) * (to - from);
  }
  for (const SpacePoint& p : traces.points) {
    const double depth = reference ? reference->row(2).dot(p.point_m.homogeneous()) : 1;
    rows.row(at++) = FormOf(Vec3(1, 0, -p.at.x()), p.point_m) * p.weight / depth;
    rows.row(at++) = FormOf(Vec3(0, 1, -p.at.y()), p.point_m) * p.weight / depth;
  }
  return rows;
}

}  // namespace tranos::camera
