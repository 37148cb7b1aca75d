// SPDX-License-Identifier: GPL-3.0-or-later
// fSpy's JSON, and a project that it solves to the same camera.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "camera/fspy.h"
#include "output/camera_formats.h"

namespace tranos::output {

using camera::FspyCamera;
using geom::Vec2;
using geom::Vec3;
using nlohmann::ordered_json;

namespace {

// A vanishing point farther than this, in halves of the picture's longer side, is taken to be at
// infinity, which fSpy's solver of two vanishing points cannot hold.
constexpr double kFarthest = 1e6;
// With one vanishing point, which then is the principal point, fSpy wants it a little aside: by
// this share of the focal length, which turns the camera by so many radians.
constexpr double kAside = 1e-5;
constexpr double kSegmentLength = 0.2;  // of the shorter side

struct Axes {
  std::array<int, 3> order;    // that with the nearest vanishing point first
  Eigen::Matrix3d directions;  // columns: of X, Y, Z in fSpy's camera, turned to lie before it
  std::array<std::string, 3> names;  // xPositive, where the axis itself lies before it
};

ordered_json PointJson(const Vec2& point) { return {{"x", point.x()}, {"y", point.y()}}; }

ordered_json TransformJson(const Eigen::Matrix4d& m) {
  ordered_json rows = ordered_json::array();
  for (int i = 0; i < 4; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2), m(i, 3)});
  return {{"rows", std::move(rows)}};
}

Axes AxesOf(const FspyCamera& camera) {
  Axes axes{{0, 1, 2}, camera.world_from_camera.topLeftCorner<3, 3>().transpose(), {}};
  for (int axis = 0; axis < 3; ++axis) {
    const bool before = axes.directions(2, axis) <= 0;
    if (!before) axes.directions.col(axis) *= -1;
    axes.names[axis] =
        std::string(1, static_cast<char>('x' + axis)) + (before ? "Positive" : "Negative");
  }
  std::stable_sort(axes.order.begin(), axes.order.end(),
                   [&](int a, int b) { return axes.directions(2, a) < axes.directions(2, b); });
  return axes;
}

bool IsFinite(const FspyCamera& camera, const Vec3& direction) {
  return camera.relative_focal_length < kFarthest * -direction.z();
}

// On the image plane; of one at infinity a point far away.
Vec2 VanishingPoint(const FspyCamera& camera, const Vec3& direction) {
  const double depth = std::max(-direction.z(), camera.relative_focal_length / kFarthest);
  return camera.principal_point + camera.relative_focal_length / depth * direction.head<2>();
}

// Two lines to a vanishing point, in the picture, as far apart in direction as they can be.
ordered_json LinesTo(const Vec2& vanishing_px, const Eigen::Vector2i& size_px) {
  const Vec2 size = size_px.cast<double>(), middle = 0.5 * size;
  std::vector<std::pair<Vec2, Vec2>> lines;
  for (const double x : {0.25, 0.5, 0.75}) {
    for (const double y : {0.25, 0.5, 0.75}) {
      const Vec2 start = size.cwiseProduct(Vec2(x, y));
      if ((vanishing_px - start).norm() < 1) continue;
      Vec2 along = (vanishing_px - start).normalized() * kSegmentLength * size.minCoeff();
      if (along.dot(middle - start) < 0) along = -along;
      lines.emplace_back(start, start + along);
    }
  }
  std::pair<std::size_t, std::size_t> widest;
  double widest_angle = -1;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec2 a = lines[i].second - lines[i].first, b = lines[j].second - lines[j].first;
      const double angle = std::abs(a.x() * b.y() - a.y() * b.x());
      if (angle <= widest_angle) continue;
      widest_angle = angle;
      widest = {i, j};
    }
  }
  ordered_json segments = ordered_json::array();
  for (const std::size_t i : {widest.first, widest.second}) {
    segments.push_back({PointJson(camera::FspyShareOf(lines[i].first, size_px)),
                        PointJson(camera::FspyShareOf(lines[i].second, size_px))});
  }
  return {{"lineSegments", std::move(segments)}};
}

ordered_json CameraParameters(const FspyCamera& camera) {
  const Axes axes = AxesOf(camera);
  const Vec2 half = camera.size_px.cast<double>() / camera.size_px.maxCoeff();
  const auto field_of_view = [&](double half_side) {
    return 2 * std::atan(half_side / camera.relative_focal_length);
  };
  ordered_json points = ordered_json::array(), names = ordered_json::array();
  for (const int axis : axes.order) {
    points.push_back(PointJson(VanishingPoint(camera, axes.directions.col(axis))));
    names.push_back(axes.names[axis]);
  }
  return {{"principalPoint", PointJson(camera.principal_point)},
          {"viewTransform", TransformJson(camera.world_from_camera.inverse())},
          {"cameraTransform", TransformJson(camera.world_from_camera)},
          {"horizontalFieldOfView", field_of_view(half.x())},
          {"verticalFieldOfView", field_of_view(half.y())},
          {"vanishingPoints", std::move(points)},
          {"vanishingPointAxes", std::move(names)},
          {"relativeFocalLength", camera.relative_focal_length},
          {"imageWidth", camera.size_px.x()},
          {"imageHeight", camera.size_px.y()}};
}

// The picture of the world's origin, as a share; and a distance from there along an axis.
struct Reference {
  bool known = false;  // the origin lies before the camera
  Vec2 origin{0.5, 0.5};
  double distance_m = 1, offset = 0.2;
};

Reference ReferenceAlong(const FspyCamera& camera, int axis) {
  const Eigen::Matrix4d view = camera.world_from_camera.inverse();
  const Vec3 origin = view.topRightCorner<3, 1>();
  Reference reference;
  if (!(origin.z() < 0)) return reference;
  const auto share_of = [&](const Vec3& in_camera) {
    const Vec2 point = camera.principal_point +
                       camera.relative_focal_length / -in_camera.z() * in_camera.head<2>();
    return camera::FspyShareOf(camera::DotOfFspyPoint(point, camera.size_px), camera.size_px);
  };
  // A third of the way to where the axis vanishes, or back to the camera, along the axis.
  Vec3 along = view.block<3, 1>(0, axis);
  if (along.z() > 0) along = -along;
  reference.distance_m = 0.5 * origin.z() / along.z();
  reference.origin = share_of(origin);
  reference.offset = (share_of(origin + reference.distance_m * along) - reference.origin).norm();
  reference.known = reference.offset > 1e-6;
  return reference;
}

std::string PositiveName(int axis) {
  return std::string(1, static_cast<char>('x' + axis)) + "Positive";
}

}  // namespace

std::string FspyJsonOf(const NamedCamera& named) {
  return CameraParameters(camera::FspyCameraOf(named.framed)).dump(1) + "\n";
}

std::string FspySettingsOf(const NamedCamera& named) {
  const FspyCamera camera = camera::FspyCameraOf(named.framed);
  const Eigen::Vector2i size_px = camera.size_px;
  const Axes axes = AxesOf(camera);
  const auto dot_of = [&](const Vec2& point) { return camera::DotOfFspyPoint(point, size_px); };
  const Vec3 second = axes.directions.col(axes.order[1]);
  const bool has_two = IsFinite(camera, second);
  const auto vanishing = [&](int i) -> Vec2 {
    if (i == 0 && !has_two) {
      return camera.principal_point - kAside * camera.relative_focal_length * second.head<2>();
    }
    return VanishingPoint(camera, axes.directions.col(axes.order[i]));
  };
  const auto lines = [&](int i) { return LinesTo(dot_of(vanishing(i)), size_px); };
  const Reference reference = ReferenceAlong(camera, axes.order[0]);
  const Vec2 horizon = vanishing(1) - vanishing(0);
  const Vec2 horizon_start(-0.4, 0),
      horizon_end = horizon_start + 0.8 * (horizon.x() < 0 ? Vec2(-horizon) : horizon).normalized();
  const Vec2 sensor_mm = named.framed.frame.size_mm;
  const ordered_json settings = {
      {"globalSettings",
       {{"calibrationMode", has_two ? "TwoVanishingPoints" : "OneVanishingPoint"},
        {"imageOpacity", 0.2},
        {"overlay3DGuide", "None"}}},
      {"calibrationSettingsBase",
       {{"referenceDistanceAxis",
         reference.known ? ordered_json(PositiveName(axes.order[0])) : ordered_json(nullptr)},
        {"referenceDistance", reference.distance_m},
        {"referenceDistanceUnit", "Meters"},
        {"cameraData",
         {{"presetId", nullptr},
          {"customSensorWidth", sensor_mm.x()},
          {"customSensorHeight", sensor_mm.y()}}},
        {"firstVanishingPointAxis", axes.names[axes.order[0]]},
        {"secondVanishingPointAxis", axes.names[axes.order[1]]}}},
      {"calibrationSettings1VP",
       {{"principalPointMode", "Manual"},
        {"upAxis", "zPositive"},
        {"horizonMode", "Manual"},
        {"absoluteFocalLength", 0.5 * camera.relative_focal_length * sensor_mm.maxCoeff()}}},
      {"calibrationSettings2VP", {{"principalPointMode", "Manual"}, {"quadModeEnabled", false}}},
      {"controlPointsStateBase",
       {{"principalPoint", PointJson(camera::FspyShareOf(dot_of(camera.principal_point), size_px))},
        {"origin", PointJson(reference.origin)},
        {"referenceDistanceAnchor", PointJson(reference.origin)},
        {"referenceDistanceHandleOffsets", {0, reference.offset}},
        {"firstVanishingPoint", lines(0)}}},
      {"controlPointsState1VP",
       {{"horizon",
         {PointJson(camera::FspyShareOf(dot_of(horizon_start), size_px)),
          PointJson(camera::FspyShareOf(dot_of(horizon_end), size_px))}}}},
      {"controlPointsState2VP",
       {{"secondVanishingPoint", lines(1)}, {"thirdVanishingPoint", lines(2)}}},
      {"cameraParameters", CameraParameters(camera)},
      {"resultDisplaySettings",
       {{"orientationFormat", "AxisAngleDegrees"},
        {"principalPointFormat", "Absolute"},
        {"fieldOfViewFormat", "Degrees"},
        {"displayAbsoluteFocalLength", false}}}};
  return settings.dump();
}

}  // namespace tranos::output
