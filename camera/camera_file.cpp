// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/camera_file.h"

#include <nlohmann/json.hpp>

#include "camera/fspy.h"
#include "camera/json_text.h"

namespace tranos::camera {

using nlohmann::json;

namespace {

constexpr const char* kExact = "tranos_camera";  // its version is 1

std::optional<Mat3> MatrixIn(const json& rows) {
  if (!rows.is_array() || rows.size() != 3) return std::nullopt;
  Mat3 m;
  for (int i = 0; i < 3; ++i) {
    const auto row = NumbersIn(rows[i], 3);
    if (!row) return std::nullopt;
    m.row(i) = Eigen::Map<const Eigen::RowVector3d>(row->data());
  }
  return m;
}

geom::Result<FramedCamera> ExactCameraIn(const json& stored) {
  const auto unreadable = [](const char* detail) {
    return tl::unexpected(geom::Error{geom::ErrorCode::kUnreadable, detail});
  };
  if (MemberOf(stored, kExact) != 1) return unreadable("the exact camera is of another version");
  const json& px = MemberOf(stored, "size_px");
  const auto numbers = NumbersIn(px, 2), size_mm = NumbersIn(MemberOf(stored, "format_mm"), 2),
             t = NumbersIn(MemberOf(stored, "t_m"), 3);
  const auto k = MatrixIn(MemberOf(stored, "K")), r = MatrixIn(MemberOf(stored, "R"));
  const auto size_px = numbers ? SizeIn(px[0], px[1]) : std::nullopt;
  if (!size_px || !size_mm || !t || !k || !r) return unreadable("the exact camera is not complete");
  const Frame frame{{(*size_mm)[0], (*size_mm)[1]}, *size_px};
  if (!(frame.size_mm.minCoeff() > 0 && frame.size_mm.maxCoeff() < 1e7)) {
    return unreadable("the exact camera has no format");
  }
  return FramedCameraOf(frame, *k, *r, -r->transpose() * Eigen::Map<const Vec3>(t->data()));
}

}  // namespace

geom::Result<std::optional<FramedCamera>> CameraInFile(std::span<const std::byte> file) {
  std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (IsFspyProject(file)) {
    const auto project = FspyProjectIn(file);
    if (!project) return tl::unexpected(project.error());
    text = project->settings;
  }
  const auto value = JsonIn(text);
  if (!value) return tl::unexpected(value.error());
  if (value->is_object() && value->contains(kExact)) return ExactCameraIn(*value);
  return CameraInFspy(text);
}

}  // namespace tranos::camera
