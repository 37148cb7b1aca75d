// SPDX-License-Identifier: GPL-3.0-or-later
// What is exported is read as each program documents its own format, and a point of the world must
// lie on the same dot of the same picture as with our camera.
#include "output/camera_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <sstream>

#include "camera/fspy.h"
#include "camera/unskewed.h"
#include "output/camera_formats.h"
#include "tests/output/models.h"

namespace tranos::output {
namespace {

using camera::Camera;
using camera::Frame;
using camera::FramedCamera;
using camera::kPi;
using camera::Mat3;
using geom::Vec2;
using geom::Vec3;
using model::CameraFormat;
using nlohmann::json;

// Of closed forms that differ in the order of their operations, on pictures of some 1000 pixels.
constexpr double kRounding_px = 1e-8;

const std::vector<Vec3> kPoints = {{0, 0, 0}, {10, 0, 0}, {10, 14, 6}, {-3, 2, 9}, {4, -5, 1}};

FramedCamera Skewed() {
  Camera camera;
  const double d = kPi / 180;
  camera.parameters << 35, 1.03, 0.9, -0.7, 89 * d, 12 * d, 25 * d, 2 * d, 22, -24, 2;
  return {{{36, 24}, {1600, 1067}}, camera};
}

FramedCamera Upright() {
  FramedCamera framed = Skewed();
  framed.frame = {{24, 36}, {480, 720}};
  return framed;
}

model::CameraRequest RequestOf(const FramedCamera& framed, CameraFormat format, std::string file,
                               const char* name = "hall") {
  model::Photograph photograph;
  photograph.frame = framed.frame;
  camera::Estimate estimate;
  estimate.camera = framed.camera;
  photograph.estimate = std::make_shared<const camera::Estimate>(estimate);
  return {ElementOf(std::make_shared<const model::Photograph>(photograph), {}, name), nullptr,
          format, std::move(file)};
}

camera::PhotoPtr GreyPicture(const Eigen::Vector2i& size_px) {
  camera::Photo photo{size_px.x(), size_px.y(), {}};
  photo.rgb.assign(std::size_t{3} * size_px.x() * size_px.y(), 128);
  return std::make_shared<const camera::Photo>(std::move(photo));
}

std::vector<NamedFile> FilesOf(const model::CameraRequest& request) {
  auto files = CameraFilesOf(request);
  EXPECT_TRUE(files.has_value()) << files.error().message;
  return files ? *files : std::vector<NamedFile>{};
}

std::string TextOf(const FramedCamera& framed, CameraFormat format, std::size_t which = 0) {
  return FilesOf(RequestOf(framed, format, "hall.txt"))[which].bytes;
}

// The dot of a point in the picture that goes with the exported camera.
Vec2 NewDot(const FramedCamera& framed, const Vec3& point, camera::PixelShape shape) {
  const Mat3 warp = camera::UnskewedOf(framed, shape)->new_dot_from_dot;
  const Vec3 dot = camera::DotFromWorld(framed.camera, framed.frame) * point.homogeneous();
  return (warp * dot).hnormalized();
}

// The data of a Python file: the one literal on its one line.
json DataIn(const std::string& script) {
  constexpr std::string_view kBegin = "\nDATA = json.loads('";
  const std::size_t begin = script.find(kBegin) + kBegin.size();
  std::string text;
  for (std::size_t i = begin; script[i] != '\''; ++i) {
    if (script[i] == '\\') ++i;
    text += script[i];
  }
  return json::parse(text);
}

TEST(CameraFiles, OpenCvProjectsToOurDots) {
  for (const FramedCamera& framed : {Skewed(), Upright()}) {
    const cv::FileStorage yaml(TextOf(framed, CameraFormat::kOpenCv),
                               cv::FileStorage::READ | cv::FileStorage::MEMORY);
    cv::Mat k, distortion, r, t, turn;
    yaml["camera_matrix"] >> k;
    yaml["distortion_coefficients"] >> distortion;
    yaml["rotation"] >> r;
    yaml["translation"] >> t;
    cv::Rodrigues(r, turn);
    std::vector<cv::Point3d> points;
    for (const Vec3& p : kPoints) points.emplace_back(p.x(), p.y(), p.z());
    std::vector<cv::Point2d> dots;
    cv::projectPoints(points, turn, t, k, distortion, dots);
    for (std::size_t i = 0; i < kPoints.size(); ++i) {
      const Vec2 ours = NewDot(framed, kPoints[i], camera::PixelShape::kRectangular);
      EXPECT_LT((Vec2(dots[i].x, dots[i].y) - ours).norm(), kRounding_px);
    }
  }
}

TEST(CameraFiles, ColmapProjectsToOurDotsCountedFromTheCorner) {
  const FramedCamera framed = Skewed();
  std::istringstream cameras(TextOf(framed, CameraFormat::kColmap)),
      images(TextOf(framed, CameraFormat::kColmap, 1));
  int id = 0, width = 0, height = 0, image = 0, camera_id = 0;
  std::string model, name;
  double fx = 0, fy = 0, cx = 0, cy = 0, qw = 0, qx = 0, qy = 0, qz = 0;
  Vec3 t;
  cameras >> id >> model >> width >> height >> fx >> fy >> cx >> cy;
  images >> image >> qw >> qx >> qy >> qz >> t.x() >> t.y() >> t.z() >> camera_id >> name;
  EXPECT_EQ(model, "PINHOLE");
  EXPECT_EQ(camera_id, id);
  EXPECT_EQ(name, "hall.png");
  EXPECT_NEAR(qw * qw + qx * qx + qy * qy + qz * qz, 1, 1e-12);
  Mat3 r;
  r << 1 - 2 * (qy * qy + qz * qz), 2 * (qx * qy - qz * qw), 2 * (qx * qz + qy * qw),
      2 * (qx * qy + qz * qw), 1 - 2 * (qx * qx + qz * qz), 2 * (qy * qz - qx * qw),
      2 * (qx * qz - qy * qw), 2 * (qy * qz + qx * qw), 1 - 2 * (qx * qx + qy * qy);
  for (const Vec3& point : kPoints) {
    const Vec3 p = r * point + t;
    const Vec2 corner(fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy);
    const Vec2 ours = NewDot(framed, point, camera::PixelShape::kRectangular);
    EXPECT_LT((corner - Vec2(0.5, 0.5) - ours).norm(), kRounding_px);
  }
}

TEST(CameraFiles, BlenderProjectsToOurDotsByItsShifts) {
  for (const FramedCamera& framed : {Skewed(), Upright()}) {
    const json data = DataIn(TextOf(framed, CameraFormat::kBlender));
    const double width = data["size_px"][0], height = data["size_px"][1];
    const double side = std::max(width, height);
    EXPECT_EQ(data["sensor_fit"], width >= height ? "HORIZONTAL" : "VERTICAL");
    Eigen::Matrix4d world_from_camera;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) world_from_camera(i, j) = data["world_from_camera"][i][j];
    }
    const double f = data["lens_mm"].get<double>() / data["sensor_mm"].get<double>();
    const Vec2 shift(data["shift_x"].get<double>(), data["shift_y"].get<double>());
    for (const Vec3& point : kPoints) {
      const Vec3 p = (world_from_camera.inverse() * point.homogeneous()).hnormalized();
      const Vec2 plane = side * (f * p.head<2>() / -p.z() - shift);  // from the middle, y up
      const Vec2 dot(width / 2 + plane.x() - 0.5, height / 2 - plane.y() - 0.5);
      EXPECT_LT((dot - NewDot(framed, point, camera::PixelShape::kSquare)).norm(), kRounding_px);
    }
  }
}

// x and y of its image plane, from a view transform, as fSpy draws its grid.
Vec2 FspyDot(const Eigen::Matrix4d& view, double f, const Vec2& principal, const Vec3& point,
             const Eigen::Vector2i& size_px) {
  const Vec3 p = (view * point.homogeneous()).hnormalized();
  const Vec2 plane = f * p.head<2>() / -p.z() + principal;
  const double half = size_px.maxCoeff() / 2.0;
  return {size_px.x() / 2.0 + half * plane.x() - 0.5, size_px.y() / 2.0 - half * plane.y() - 0.5};
}

Vec2 PointIn(const json& point) { return {point["x"].get<double>(), point["y"].get<double>()}; }

TEST(CameraFiles, FspysJsonProjectsToOurDots) {
  for (const FramedCamera& framed : {Skewed(), Upright()}) {
    const json stored = json::parse(TextOf(framed, CameraFormat::kFspyJson));
    Eigen::Matrix4d view;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) view(i, j) = stored["viewTransform"]["rows"][i][j];
    }
    const Eigen::Vector2i size_px(stored["imageWidth"].get<int>(),
                                  stored["imageHeight"].get<int>());
    for (const Vec3& point : kPoints) {
      const Vec2 dot = FspyDot(view, stored["relativeFocalLength"],
                               PointIn(stored["principalPoint"]), point, size_px);
      EXPECT_LT((dot - NewDot(framed, point, camera::PixelShape::kSquare)).norm(), kRounding_px);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name = stored["vanishingPointAxes"][axis];
      const Vec3 direction = Vec3::Unit(name[0] - 'x') * (name.substr(1) == "Positive" ? 1 : -1);
      const Vec3 seen = view.topLeftCorner<3, 3>() * direction;
      const Vec2 vanishing =
          stored["relativeFocalLength"].get<double>() * seen.head<2>() / -seen.z() +
          PointIn(stored["principalPoint"]);
      EXPECT_LT((vanishing - PointIn(stored["vanishingPoints"][axis])).norm(), 1e-9);
    }
  }
}

// A control point, a share of width and height, on the image plane.
Vec2 PlaneOfShare(const Vec2& share, const Eigen::Vector2i& size_px) {
  const Vec2 from_middle = (share - Vec2(0.5, 0.5)).cwiseProduct(size_px.cast<double>());
  return Vec2(from_middle.x(), -from_middle.y()) / (0.5 * size_px.maxCoeff());
}

// A project's own solution, as fSpy finds it from its control points: two vanishing points and the
// principal point give f and the axes, or f is given and the second one is on the horizon; the
// origin and a distance along the first axis give the place.
FramedCamera SolvedByFspy(const json& project, const Eigen::Vector2i& size_px) {
  const auto plane = [&](const json& share) { return PlaneOfShare(PointIn(share), size_px); };
  const auto vanishing = [&](const json& point) -> Vec2 {
    const json& lines = point["lineSegments"];
    const auto line = [&](int i) -> Vec3 {
      return plane(lines[i][0]).homogeneous().cross(plane(lines[i][1]).homogeneous());
    };
    return line(0).cross(line(1)).hnormalized();
  };
  const json& base = project["controlPointsStateBase"];
  const Vec2 principal = plane(base["principalPoint"]);
  const Vec2 first = vanishing(base["firstVanishingPoint"]) - principal;
  Vec2 second = vanishing(project["controlPointsState2VP"]["secondVanishingPoint"]) - principal;
  double f = std::sqrt(-first.dot(second));
  const json& settings = project["calibrationSettingsBase"];
  if (project["globalSettings"]["calibrationMode"] == "OneVanishingPoint") {
    const json& sensor = settings["cameraData"];
    f = 2 * project["calibrationSettings1VP"]["absoluteFocalLength"].get<double>() /
        std::max(sensor["customSensorWidth"].get<double>(),
                 sensor["customSensorHeight"].get<double>());
    const json& ends = project["controlPointsState1VP"]["horizon"];
    const Vec2 horizon = (plane(ends[1]) - plane(ends[0])).normalized();
    second = first - (first.squaredNorm() + f * f) / first.dot(horizon) * horizon;
  }
  Mat3 camera_axes, world_axes;
  const auto set = [&](int i, const Vec2& point, const std::string& name) {
    camera_axes.col(i) = Vec3(point.x(), point.y(), -f).normalized();
    world_axes.col(i) = Vec3::Unit(name[0] - 'x') * (name.substr(1) == "Positive" ? 1 : -1);
  };
  set(0, first, settings["firstVanishingPointAxis"]);
  set(1, second, settings["secondVanishingPointAxis"]);
  for (Mat3* axes : {&camera_axes, &world_axes}) axes->col(2) = axes->col(0).cross(axes->col(1));
  camera::FspyCamera solved{size_px, f, principal, Eigen::Matrix4d::Identity()};
  const Mat3 camera_from_world = camera_axes * world_axes.transpose();
  solved.world_from_camera.topLeftCorner<3, 3>() = camera_from_world.transpose();
  // The handle lies on the way from the anchor to the vanishing point; on the ray to it, at the
  // stated distance from the origin along the axis.
  const std::string axis = settings["referenceDistanceAxis"];
  EXPECT_EQ(axis[0], settings["firstVanishingPointAxis"].get<std::string>()[0]);
  const Vec2 anchor = PointIn(base["referenceDistanceAnchor"]);
  const Vec2 to = camera::FspyShareOf(camera::DotOfFspyPoint(first + principal, size_px), size_px);
  const Vec2 handle =
      anchor + base["referenceDistanceHandleOffsets"][1].get<double>() * (to - anchor).normalized();
  const auto ray = [&](const Vec2& share) {
    const Vec2 point = PlaneOfShare(share, size_px);
    return Vec3(point.x() - principal.x(), point.y() - principal.y(), -f);
  };
  // depth · ray(origin) + distance · axis lies on ray(handle).
  const Vec3 across = ray(handle);
  const Vec3 step = settings["referenceDistance"].get<double>() * camera_axes.col(0);
  const Vec3 start = ray(PointIn(base["origin"])).cross(across);
  const double depth = -step.cross(across).dot(start) / start.squaredNorm();
  solved.world_from_camera.topRightCorner<3, 1>() =
      -camera_from_world.transpose() * (depth * ray(PointIn(base["origin"])));
  const auto framed = camera::FramedCameraOf(solved);
  EXPECT_TRUE(framed.has_value());
  return framed.value_or(FramedCamera{});
}

FramedCamera Level() {
  FramedCamera framed = Skewed();
  framed.camera[camera::kOmega] = framed.camera[camera::kKappa] = 0;
  return framed;
}

// Looks along Y: X and Z vanish at infinity, and fSpy's way of one vanishing point turns it a hair.
FramedCamera Frontal() {
  FramedCamera framed = Level();
  framed.camera[camera::kPhi] = 0;
  framed.camera[camera::kX0] = 5;
  return framed;
}

TEST(CameraFiles, AnFspyProjectIsSolvedToTheSameCamera) {
  for (const auto& [framed, apart_px, apart_m] :
       {std::tuple(Skewed(), 1e-5, 1e-6), std::tuple(Upright(), 1e-5, 1e-6),
        std::tuple(Level(), 1e-5, 1e-6), std::tuple(Frontal(), 0.05, 1e-2)}) {
    model::CameraRequest request = RequestOf(framed, CameraFormat::kFspyProject, "hall.fspy");
    request.picture = GreyPicture(framed.frame.size_px);
    const std::string bytes = FilesOf(request)[0].bytes;
    const auto project = camera::FspyProjectIn(std::as_bytes(std::span(bytes)));
    ASSERT_TRUE(project.has_value());
    const auto size = camera::PhotoSizeOf(project->picture);
    ASSERT_TRUE(size.has_value());
    const Eigen::Vector2i size_px(size->width_px, size->height_px);
    const FramedCamera solved = SolvedByFspy(json::parse(project->settings), size_px);
    const auto stored = camera::CameraInFspy(project->settings);
    ASSERT_TRUE(stored.has_value()) << stored.error().detail;
    ASSERT_TRUE(stored->has_value());
    EXPECT_EQ((*stored)->frame.size_px, size_px);
    for (const FramedCamera& again : {solved, **stored}) {
      EXPECT_LT((again.camera.position_m() - framed.camera.position_m()).norm(), apart_m);
      for (const Vec3& point : kPoints) {
        const Vec3 dot = camera::DotFromWorld(again.camera, again.frame) * point.homogeneous();
        const Vec2 ours = NewDot(framed, point, camera::PixelShape::kSquare);
        EXPECT_LT((dot.hnormalized() - ours).norm(), apart_px);
      }
    }
  }
}

TEST(CameraFiles, TheExactCameraIsTheCamera) {
  const FramedCamera framed = Skewed();
  const json exact = json::parse(TextOf(framed, CameraFormat::kOpenCv, 1));
  EXPECT_EQ(exact["name"], "hall");
  EXPECT_NEAR(exact["skew_deg"], 89, 1e-12);
  for (const Vec3& point : kPoints) {
    Vec3 dot;
    for (int i = 0; i < 3; ++i) {
      const std::vector<double> row = exact["P"][i];
      dot[i] = row[0] * point.x() + row[1] * point.y() + row[2] * point.z() + row[3];
    }
    const Vec3 ours = camera::DotFromWorld(framed.camera, framed.frame) * point.homogeneous();
    EXPECT_LT((dot.hnormalized() - ours.hnormalized()).norm(), kRounding_px);
  }
}

TEST(CameraFiles, APictureGoesWithTheCameraAndItsNameSaysThatItWasWarped) {
  const auto paths = [](FramedCamera framed, CameraFormat format, std::string file) {
    model::CameraRequest request = RequestOf(framed, format, std::move(file));
    request.picture = GreyPicture(framed.frame.size_px);
    std::vector<std::string> made;
    for (const NamedFile& one : FilesOf(request)) made.push_back(one.path);
    EXPECT_EQ(made, *CameraPathsOf(request));
    return made;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(paths(Skewed(), CameraFormat::kOpenCv, "to/hall.yaml"),
            (Names{"to/hall.yaml", "to/hall_unskewed.png", "to/hall.camera.json"}));
  EXPECT_EQ(paths(Skewed(), CameraFormat::kBlender, "hall.py"),
            (Names{"hall.py", "hall_square.png", "hall.camera.json"}));
  EXPECT_EQ(paths(Skewed(), CameraFormat::kColmap, "hall"),
            (Names{"hall/cameras.txt", "hall/images.txt", "hall/points3D.txt",
                   "hall/images/hall_unskewed.png", "hall/hall.camera.json"}));
  EXPECT_EQ(paths(Skewed(), CameraFormat::kFspyProject, "hall.fspy"),
            (Names{"hall.fspy", "hall.camera.json"}));
  FramedCamera plain = Skewed();
  plain.camera[camera::kSkew] = kPi / 2;
  EXPECT_EQ(paths(plain, CameraFormat::kOpenCv, "hall.yaml")[1], "hall.png");
}

TEST(CameraFiles, AnFspyProjectNeedsAPhotograph) {
  const auto files = CameraFilesOf(RequestOf(Skewed(), CameraFormat::kFspyProject, "hall.fspy"));
  ASSERT_FALSE(files.has_value());
  EXPECT_NE(files.error().message.find("photograph"), std::string::npos);
}

TEST(CameraFiles, APictureThatWouldBeTooLargeIsRefused) {
  FramedCamera framed = Skewed();
  framed.frame.size_px = {10'000, 20'000};
  framed.camera[camera::kSkew] = 30 * kPi / 180;
  const auto paths = CameraPathsOf(RequestOf(framed, CameraFormat::kOpenCv, "hall.yaml"));
  ASSERT_FALSE(paths.has_value());
  EXPECT_NE(paths.error().message.find("too large"), std::string::npos);
}

// Whatever a name holds, the text around the data stays as it is.
TEST(CameraFiles, NamesAreDataAndNeverText) {
  const char* const kName = "'); import os; os.system('x')\n#\"\\\r\u2028\\x27";
  const auto lines_of = [](const char* name) {
    model::CameraRequest request = RequestOf(Skewed(), CameraFormat::kBlender, "hall.py", name);
    std::istringstream script(FilesOf(request)[0].bytes);
    std::vector<std::string> lines;
    for (std::string line; std::getline(script, line);) lines.push_back(line);
    return lines;
  };
  const auto plain = lines_of("hall"), hostile = lines_of(kName);
  ASSERT_EQ(plain.size(), hostile.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (plain[i].starts_with("DATA = ")) continue;
    EXPECT_EQ(plain[i], hostile[i]);
  }
  const std::string script =
      FilesOf(RequestOf(Skewed(), CameraFormat::kBlender, "hall.py", kName))[0].bytes;
  EXPECT_EQ(DataIn(script)["name"], kName);
  for (const char c : script) EXPECT_TRUE((c >= ' ' && c <= '~') || c == '\n') << int{c};
}

TEST(CameraFiles, NamesComeBackFromOpenCvsYaml) {
  const char* const kName = "a \"quoted\"\nname: [of, no] \\ 'kind' Säule";
  const std::string text =
      FilesOf(RequestOf(Skewed(), CameraFormat::kOpenCv, "hall.yaml", kName))[0].bytes;
  const cv::FileStorage yaml(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
  EXPECT_EQ(yaml["camera_name"].string(), kName);
  EXPECT_EQ(static_cast<int>(yaml["image_height"]), 1067);
}

}  // namespace
}  // namespace tranos::output
