// SPDX-License-Identifier: GPL-3.0-or-later
// Real photographs whose cameras are known, and what is traced on them. The photographs' data are
// beside the project or in $TRANOS_DATA, never within it; the traces of the castle are beside this
// file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "camera/traces.h"

namespace tranos::camera::real {

// The folder of the test data; nothing where it is not there.
std::optional<std::filesystem::path> DataFolder();

struct Segment {
  Vec2 a_px, b_px;
  int axis;  // 0, 1, 2: X, Y, Z
};

// A photograph with what is known of its camera, and edges along three orthogonal directions.
struct Known {
  std::string name;
  std::filesystem::path file;
  Frame frame;      // 36 mm wide, square pixels: only ratios of lengths in it are ever looked at
  double focal_px;  // in x
  Vec2 principal_px;
  Mat3 camera_from_world;  // of the York photographs the signs of the world's axes are arbitrary
  std::vector<Segment> segments;
};

// The York Urban Database's 51 photographs with their labelled segments; its three directions,
// horizontal, vertical and horizontal, are X, Z and Y here.
std::vector<Known> YorkUrban(const std::filesystem::path& data);

// Strecha's castle-P30, eight photographs: X along the facade with the arches, Y along the ornate
// one, Z upright. The world of `camera_from_world` has Z downward and any azimuth.
std::vector<Known> Castle(const std::filesystem::path& data);

// fSpy's shifted_landscape with the control lines of its three vanishing points, of which the
// second is that of the quadrilateral's other two sides; the known camera is fSpy's own answer.
Known ShiftedLandscape(const std::filesystem::path& data);

// Merton College's tower: two edges of each direction, and the camera that an independent solution
// gives them under square pixels.
Known Tower(const std::filesystem::path& data);

}  // namespace tranos::camera::real
