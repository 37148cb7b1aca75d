// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/fspy.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "camera/json_text.h"

namespace tranos::camera {

using geom::Error;
using geom::ErrorCode;
using nlohmann::json;

namespace {

constexpr std::string_view kWord = "fspy";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeader = 16;

// Camera axes with y down and z forward, from those with y up and looking along −z; and back.
const Vec3 kTurned(1, -1, -1);

tl::unexpected<Error> Unreadable(std::string detail) {
  return tl::unexpected(Error{ErrorCode::kUnreadable, std::move(detail)});
}

std::uint32_t LittleEndian(std::span<const std::byte> file, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 4; i-- > 0;) {
    number = number << 8 | std::to_integer<std::uint32_t>(file[at + i]);
  }
  return number;
}

void Append(std::string* bytes, std::uint32_t number) {
  for (int i = 0; i < 4; ++i) bytes->push_back(static_cast<char>(number >> 8 * i & 0xff));
}

double HalfLonger(const Eigen::Vector2i& size_px) { return 0.5 * size_px.maxCoeff(); }

std::optional<Vec2> PointIn(const json& point) {
  const auto x = NumberIn(MemberOf(point, "x")), y = NumberIn(MemberOf(point, "y"));
  if (!x || !y) return std::nullopt;
  return Vec2(*x, *y);
}

std::optional<Eigen::Matrix4d> TransformIn(const json& transform) {
  const json& rows = MemberOf(transform, "rows");
  if (!rows.is_array() || rows.size() != 4) return std::nullopt;
  Eigen::Matrix4d m;
  for (int i = 0; i < 4; ++i) {
    const auto row = NumbersIn(rows[i], 4);
    if (!row) return std::nullopt;
    m.row(i) = Eigen::Map<const Eigen::RowVector4d>(row->data());
  }
  return m;
}

// Metres in the unit of a project's world; 1 where it has none.
double UnitOf(const json& settings) {
  const json& base = MemberOf(settings, "calibrationSettingsBase");
  const json& unit = MemberOf(base, "referenceDistanceUnit");
  if (!MemberOf(base, "referenceDistanceAxis").is_string() || !unit.is_string()) return 1;
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"Millimeters", 1e-3}, {"Centimeters", 1e-2}, {"Kilometers", 1e3},
      {"Inches", 0.0254},    {"Feet", 0.3048},      {"Miles", 1609.344}};
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) return metres;
  }
  return 1;
}

}  // namespace

FspyCamera FspyCameraOf(const FramedCamera& framed) {
  const Mat3 k = DotFromCamera(framed);
  FspyCamera camera;
  camera.size_px = framed.frame.size_px;
  camera.relative_focal_length = k(1, 1) / HalfLonger(camera.size_px);
  camera.principal_point = FspyPointOf(k.col(2).head<2>(), camera.size_px);
  camera.world_from_camera.topLeftCorner<3, 3>() =
      CameraFromWorld(framed.camera.parameters).transpose() * kTurned.asDiagonal();
  camera.world_from_camera.topRightCorner<3, 1>() = framed.camera.position_m();
  return camera;
}

geom::Result<FramedCamera> FramedCameraOf(const FspyCamera& camera) {
  const double f_px = camera.relative_focal_length * HalfLonger(camera.size_px);
  const Vec2 principal = DotOfFspyPoint(camera.principal_point, camera.size_px);
  Mat3 k;
  k << f_px, 0, principal.x(), 0, f_px, principal.y(), 0, 0, 1;
  const Mat3 r = kTurned.asDiagonal() * camera.world_from_camera.topLeftCorner<3, 3>().transpose();
  return FramedCameraOf(FrameOfPixels(camera.size_px), k, r,
                        camera.world_from_camera.topRightCorner<3, 1>());
}

Vec2 FspyPointOf(const Vec2& dot_px, const Eigen::Vector2i& size_px) {
  const Vec2 from_middle = dot_px + Vec2(0.5, 0.5) - 0.5 * size_px.cast<double>();
  return Vec2(from_middle.x(), -from_middle.y()) / HalfLonger(size_px);
}

Vec2 DotOfFspyPoint(const Vec2& point, const Eigen::Vector2i& size_px) {
  return Vec2(point.x(), -point.y()) * HalfLonger(size_px) + 0.5 * size_px.cast<double>() -
         Vec2(0.5, 0.5);
}

Vec2 FspyShareOf(const Vec2& dot_px, const Eigen::Vector2i& size_px) {
  return (dot_px + Vec2(0.5, 0.5)).cwiseQuotient(size_px.cast<double>());
}

bool IsFspyProject(std::span<const std::byte> file) {
  return file.size() >= kWord.size() &&
         std::equal(kWord.begin(), kWord.end(), file.begin(),
                    [](char c, std::byte b) { return static_cast<std::byte>(c) == b; });
}

geom::Result<FspyProject> FspyProjectIn(std::span<const std::byte> file) {
  if (!IsFspyProject(file)) return Unreadable("it is no fSpy project");
  if (file.size() < kHeader) return Unreadable("the fSpy project is cut off");
  if (const std::uint32_t version = LittleEndian(file, 4); version != kVersion) {
    return Unreadable("the fSpy project has version " + std::to_string(version) +
                      ", and version 1 is read");
  }
  const std::size_t settings = LittleEndian(file, 8), picture = LittleEndian(file, 12);
  if (file.size() - kHeader < settings || file.size() - kHeader - settings < picture) {
    return Unreadable("the fSpy project is cut off");
  }
  const auto parts = file.subspan(kHeader);
  return FspyProject{{reinterpret_cast<const char*>(parts.data()), settings},
                     parts.subspan(settings, picture)};
}

std::string FspyProjectOf(std::string_view settings, std::string_view picture) {
  std::string bytes(kWord);
  Append(&bytes, kVersion);
  Append(&bytes, static_cast<std::uint32_t>(settings.size()));
  Append(&bytes, static_cast<std::uint32_t>(picture.size()));
  bytes += settings;
  bytes += picture;
  return bytes;
}

geom::Result<std::optional<FramedCamera>> CameraInFspy(std::string_view text) {
  const auto settings = JsonIn(text);
  if (!settings) return tl::unexpected(settings.error());
  const bool is_project = settings->is_object() && settings->contains("calibrationSettingsBase");
  const json& stored = is_project ? MemberOf(*settings, "cameraParameters") : *settings;
  if (is_project && stored.is_null()) return std::nullopt;
  const auto size = SizeIn(MemberOf(stored, "imageWidth"), MemberOf(stored, "imageHeight"));
  const auto focal = NumberIn(MemberOf(stored, "relativeFocalLength"));
  const auto principal = PointIn(MemberOf(stored, "principalPoint"));
  auto pose = TransformIn(MemberOf(stored, "cameraTransform"));
  if (!size || !focal || !principal || !pose) {
    return Unreadable("fSpy's camera is not complete");
  }
  pose->topRightCorner<3, 1>() *= UnitOf(*settings);
  return FramedCameraOf(FspyCamera{*size, *focal, *principal, *pose});
}

}  // namespace tranos::camera
