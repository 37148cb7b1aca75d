// SPDX-License-Identifier: GPL-3.0-or-later
// fSpy's cameras and projects. Its image plane: x right, y up, from the picture's middle, in halves
// of the longer side. Its camera: x right, y up, looking along −z. Its world is right-handed, and
// which way is up in it is the user's choice: Z here. Pixels are square and have no skew.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "camera/framed_camera.h"

namespace tranos::camera {

struct FspyCamera {
  Eigen::Vector2i size_px{1, 1};
  double relative_focal_length = 1;  // in halves of the longer side
  Vec2 principal_point = Vec2::Zero();
  Eigen::Matrix4d world_from_camera = Eigen::Matrix4d::Identity();
};

// Of a camera without skew and with square pixels; of any other, that of its f_y.
FspyCamera FspyCameraOf(const FramedCamera&);
// Errors of FramedCameraOf.
geom::Result<FramedCamera> FramedCameraOf(const FspyCamera&);

// A dot's place on the image plane, and back.
Vec2 FspyPointOf(const Vec2& dot_px, const Eigen::Vector2i& size_px);
Vec2 DotOfFspyPoint(const Vec2& point, const Eigen::Vector2i& size_px);
// A control point is a share of the width and of the height, from the top left corner.
Vec2 FspyShareOf(const Vec2& dot_px, const Eigen::Vector2i& size_px);

// A project: the word, the version 1, the lengths of the two parts, the settings as JSON, the
// picture as the bytes of its file.
struct FspyProject {
  std::string_view settings;
  std::span<const std::byte> picture;  // empty if there is none
};
bool IsFspyProject(std::span<const std::byte> file);
// Errors: kUnreadable (not a project, another version, cut off).
geom::Result<FspyProject> FspyProjectIn(std::span<const std::byte> file);
std::string FspyProjectOf(std::string_view settings, std::string_view picture);

// The camera in a project's settings, or in what fSpy exports as JSON. Its position is in metres
// where a reference distance has a unit; else it is as it stands. Nothing if a project was saved
// without a solution. The fields of view, which are wrong for portraits, are not read. Errors:
// kUnreadable (no JSON, no camera), kTooLarge, those of FramedCameraOf.
geom::Result<std::optional<FramedCamera>> CameraInFspy(std::string_view settings);

}  // namespace tranos::camera
