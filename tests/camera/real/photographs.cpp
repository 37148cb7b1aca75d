// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/camera/real/photographs.h"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace tranos::camera::real {
namespace {

using nlohmann::json;

json Parsed(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

Frame FrameOf(int width_px, int height_px) {
  return {{36, 36.0 * height_px / width_px}, {width_px, height_px}};
}

Mat3 MatrixOf(const json& rows) {
  Mat3 m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m(i, j) = rows[i][j].get<double>();
  }
  return m;
}

Segment SegmentOf(const json& ends, int axis, const Vec2& offset_px) {
  const auto at = [&](int i) { return ends[i].get<double>(); };
  return {Vec2(at(0), at(1)) + offset_px, Vec2(at(2), at(3)) + offset_px, axis};
}

// The first dot's middle is (1, 1) in what was labelled in Matlab, (0.5, 0.5) where coordinates
// count from the picture's corner.
const Vec2 kFromMatlab(-1, -1), kFromCorner(-0.5, -0.5);

Known YorkPhotograph(const json& image, const json& k) {
  Known known;
  known.name = image["name"].get<std::string>();
  known.frame = FrameOf(640, 480);
  known.focal_px = k[0][0].get<double>();
  known.principal_px = Vec2(k[0][2].get<double>(), k[1][2].get<double>()) + kFromMatlab;
  constexpr std::array<int, 3> kAxes = {0, 2, 1};
  const json& directions = image["vp_dirs_cam_orthogonal"];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      known.camera_from_world(j, kAxes[i]) = directions[i][j].get<double>();
  }
  for (const json& line : image["lines"]) {
    const int direction = line["vp"].get<int>() - 1;
    known.segments.push_back(SegmentOf(line["p"], kAxes[direction], kFromMatlab));
  }
  return known;
}

std::vector<Segment> TracedBeside(const std::string& photograph) {
  std::ifstream stream(std::filesystem::path(TRANOS_CASTLE_TRACES) / (photograph + ".txt"));
  std::vector<Segment> segments;
  char axis = 0;
  Vec2 a, b;
  while (stream >> axis >> a.x() >> a.y() >> b.x() >> b.y()) segments.push_back({a, b, axis - 'X'});
  return segments;
}

// The settings within an fSpy project: a word, the version, the length of the text and of the
// picture, four bytes each with the lowest first, then the text.
json FspyProject(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<unsigned char, 16> header{};
  stream.read(reinterpret_cast<char*>(header.data()), header.size());
  std::uint32_t length = 0;
  for (int i = 3; i >= 0; --i) length = length << 8 | header[8 + i];
  std::string text(length, '\0');
  stream.read(text.data(), length);
  return json::parse(text);
}

}  // namespace

std::optional<std::filesystem::path> DataFolder() {
  const char* stated = std::getenv("TRANOS_DATA");
  const std::filesystem::path folder = stated ? stated : TRANOS_DATA_BESIDE;
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "york_urban", ignored)) return {};
  return folder;
}

std::vector<Known> YorkUrban(const std::filesystem::path& data) {
  const json all = Parsed(data / "york_urban" / "ground_truth.json");
  std::vector<Known> photographs;
  for (const json& image : all["images"]) {
    photographs.push_back(YorkPhotograph(image, all["K"]));
    photographs.back().file = data / "york_urban" / image["file"].get<std::string>();
  }
  return photographs;
}

std::vector<Known> Castle(const std::filesystem::path& data) {
  std::vector<Known> photographs;
  for (const json& camera : Parsed(data / "strecha" / "cameras_half.json")) {
    const std::filesystem::path file = camera["file"].get<std::string>();
    if (file.parent_path() != "castle-P30") continue;
    Known known;
    known.name = file.stem();
    known.file = data / "strecha" / file;
    known.segments = TracedBeside(known.name);
    if (known.segments.empty()) continue;
    known.frame = FrameOf(camera["size"][0].get<int>(), camera["size"][1].get<int>());
    const Mat3 k = MatrixOf(camera["K_half"]);
    known.focal_px = k(0, 0);
    known.principal_px = {k(0, 2), k(1, 2)};
    known.camera_from_world = MatrixOf(camera["R_world_to_cam"]);
    photographs.push_back(known);
  }
  return photographs;
}

Known ShiftedLandscape(const std::filesystem::path& data) {
  const json project = FspyProject(data / "fspy" / "shifted_landscape.fspy");
  const json& answer = project["cameraParameters"];
  const int width = answer["imageWidth"].get<int>(), height = answer["imageHeight"].get<int>();
  Known known;
  known.name = "shifted_landscape";
  known.frame = FrameOf(width, height);
  // fSpy's plane has its origin in the middle, y up, half the longer side as its unit.
  const double unit_px = 0.5 * std::max(width, height);
  known.focal_px = answer["relativeFocalLength"].get<double>() * unit_px;
  const json& principal = answer["principalPoint"];
  known.principal_px = {0.5 * width + unit_px * principal["x"].get<double>(),
                        0.5 * height - unit_px * principal["y"].get<double>()};
  known.principal_px += kFromCorner;
  const auto dot = [&](const json& p) -> Vec2 {
    return Vec2(p["x"].get<double>() * width, p["y"].get<double>() * height) + kFromCorner;
  };
  const json& first = project["controlPointsStateBase"]["firstVanishingPoint"]["lineSegments"];
  const json& third = project["controlPointsState2VP"]["thirdVanishingPoint"]["lineSegments"];
  for (int i = 0; i < 2; ++i) {
    known.segments.push_back({dot(first[i][0]), dot(first[i][1]), 0});
    known.segments.push_back({dot(first[0][i]), dot(first[1][i]), 2});
    known.segments.push_back({dot(third[i][0]), dot(third[i][1]), 1});
  }
  return known;
}

Known Tower(const std::filesystem::path& data) {
  const json tower = Parsed(data / "cmu" / "tower.json");
  Known known;
  known.name = "tower";
  known.frame = FrameOf(1024, 768);
  known.focal_px = 1154.178;
  known.principal_px = {575.066, 431.939};
  constexpr std::array<int, 3> kAxes = {0, 2, 1};
  for (int i = 0; i < 3; ++i) {
    for (const json& ends : tower["segments_by_direction_px"][i])
      known.segments.push_back(SegmentOf(ends, kAxes[i], Vec2::Zero()));
  }
  return known;
}

}  // namespace tranos::camera::real
