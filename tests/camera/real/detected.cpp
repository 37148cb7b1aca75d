// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/camera/real/detected.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

namespace tranos::camera::real {
namespace {

double DegreesBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) * 180 / kPi;
}

// The line of dots that all horizontal directions' vanishing points are on.
Vec3 HorizonOf(const Mat3& dot_from_camera, const Vec3& up_in_camera) {
  return dot_from_camera.inverse().transpose() * up_in_camera;
}

Mat3 TrueDotFromCamera(const Known& known) {
  Mat3 k = Vec3(known.focal_px, known.focal_px, 1).asDiagonal();
  k.topRightCorner<2, 1>() = known.principal_px;
  return k;
}

// Whether most of the line is along the edge, within what a hand sets ends to.
bool LiesAlong(const ImageLine& line, const Segment& edge) {
  constexpr double kOff_px = 2.5;
  const double length = (edge.b_px - edge.a_px).norm();
  const Vec2 along = (edge.b_px - edge.a_px) / length, across(-along.y(), along.x());
  const double from = along.dot(line.a_px - edge.a_px), to = along.dot(line.b_px - edge.a_px);
  const double shared = std::min(std::max(from, to), length) - std::max(std::min(from, to), 0.0);
  return shared > 0.5 * line.length_px() && std::abs(across.dot(line.a_px - edge.a_px)) < kOff_px &&
         std::abs(across.dot(line.b_px - edge.a_px)) < kOff_px;
}

}  // namespace

Photo PhotoOf(const Known& known) {
  std::ifstream file(known.file, std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  return DecodePhoto(std::as_bytes(std::span(bytes))).value();
}

Traced TracedLines(const Known& known, std::span<const ImageLine> lines,
                   std::span<const int> axis) {
  constexpr double kNoise_px = 0.5;  // only a unit, as the noise is estimated
  Traced traced;
  traced.photograph.name = known.name;
  traced.photograph.frame = known.frame;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (axis[i] == kNoAxis) continue;
    const int samples = SamplesOf(AsParallel(lines[i], DirectionSearch().parallel_rad), kNoise_px);
    const auto line = FitImageLine({lines[i].a_px, lines[i].b_px}, kNoise_px, samples);
    traced.photograph.traces.push_back(DirectionTrace{line.value(), axis[i]});
  }
  return traced;
}

std::vector<int> AxesByDirections(const Known& known, std::span<const ImageLine> lines) {
  Mat3 k = known.frame.DotFromFrame().inverse() * TrueDotFromCamera(known);
  Mat3 rotation = known.camera_from_world;
  if (rotation.determinant() < 0) rotation.col(1) *= -1;
  return AxesOfLines(lines, known.frame, CameraOf(k, rotation, Vec3::Zero()),
                     DirectionSearch().parallel_rad);
}

std::vector<int> AxesByLabels(const Known& known, std::span<const ImageLine> lines) {
  std::vector<int> axes;
  for (const ImageLine& line : lines) {
    const auto edge = std::ranges::find_if(
        known.segments, [&](const Segment& segment) { return LiesAlong(line, segment); });
    axes.push_back(edge == known.segments.end() ? kNoAxis : edge->axis);
  }
  return axes;
}

double DirectionError(const Mat3& found, const Mat3& truth) {
  const auto error = [&](int x, int y) {
    return std::max(DegreesBetween(found.col(0), truth.col(x)),
                    DegreesBetween(found.col(1), truth.col(y)));
  };
  return std::max(std::min(error(0, 1), error(1, 0)), DegreesBetween(found.col(2), truth.col(2)));
}

double HorizonError(const Found& found, const Known& known) {
  const Vec3 truth = HorizonOf(TrueDotFromCamera(known), known.camera_from_world.col(2));
  const Vec3 line = HorizonOf(found.dot_from_camera, found.camera_from_world.col(2));
  const auto height = [](const Vec3& l, double x) { return -(l.x() * x + l.z()) / l.y(); };
  const double right = known.frame.size_px.x() - 1;
  return std::max(std::abs(height(line, 0) - height(truth, 0)),
                  std::abs(height(line, right) - height(truth, right))) /
         known.frame.size_px.y();
}

void Errors::Add(const Found& found, const Known& known) {
  constexpr double kFailed = std::numeric_limits<double>::infinity();
  direction_deg.push_back(
      found.is_found ? DirectionError(found.camera_from_world, known.camera_from_world) : 180);
  horizon.push_back(found.is_found ? HorizonError(found, known) : kFailed);
  focal.push_back(found.is_found ? std::abs(found.focal_px / known.focal_px - 1) : kFailed);
}

double Errors::DirectionsWithin(double degrees) const {
  const auto within = std::ranges::count_if(direction_deg, [&](double e) { return e <= degrees; });
  return static_cast<double>(within) / static_cast<double>(direction_deg.size());
}

double Errors::HorizonArea(double most) const {
  double area = 0;
  for (const double e : horizon) area += std::max(0.0, 1 - e / most);
  return area / static_cast<double>(horizon.size());
}

}  // namespace tranos::camera::real
