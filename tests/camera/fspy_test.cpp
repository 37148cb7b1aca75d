// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/fspy.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "camera/camera_file.h"
#include "camera/photo.h"

namespace tranos::camera {
namespace {

using geom::ErrorCode;

constexpr double kRounding = 1e-9;

std::span<const std::byte> BytesOf(const std::string& text) {
  return std::as_bytes(std::span(text));
}

// Half a picture of 1000 pixels is 1 on its image plane: f 1.5 is 750 px.
constexpr std::string_view kStored = R"({
  "principalPoint": {"x": 0.1, "y": -0.2},
  "cameraTransform": {"rows": [[1, 0, 0, 3], [0, 0, -1, -20], [0, 1, 0, 2], [0, 0, 0, 1]]},
  "relativeFocalLength": 1.5, "imageWidth": 1000, "imageHeight": 600})";

std::string ProjectSettings(std::string_view unit = "Meters",
                            std::string_view axis = "\"xPositive\"") {
  return R"({"calibrationSettingsBase": {"referenceDistanceAxis": )" + std::string(axis) +
         R"(, "referenceDistanceUnit": ")" + std::string(unit) + R"("}, "cameraParameters": )" +
         std::string(kStored) + "}";
}

FramedCamera StoredIn(std::string_view text) {
  const auto read = CameraInFspy(text);
  EXPECT_TRUE(read.has_value() && read->has_value());
  return read && *read ? **read : FramedCamera{};
}

TEST(Fspy, ItsJsonIsReadInItsOwnAxesAndHalvesOfTheLongerSide) {
  const FramedCamera read = StoredIn(kStored);
  Mat3 k;
  k << 750, 0, 549.5, 0, 750, 399.5, 0, 0, 1;
  EXPECT_LT((DotFromCamera(read) - k).cwiseAbs().maxCoeff(), kRounding);
  // It looks along Y with Z up.
  Mat3 level;
  level << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  EXPECT_LT((CameraFromWorld(read.camera.parameters) - level).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LT((read.camera.position_m() - Vec3(3, -20, 2)).norm(), kRounding);
}

TEST(Fspy, AProjectsWorldIsInTheUnitOfItsReferenceDistance) {
  const auto at = [](std::string_view unit, std::string_view axis = "\"xPositive\"") -> Vec3 {
    return StoredIn(ProjectSettings(unit, axis)).camera.position_m();
  };
  EXPECT_LT((at("Feet") - 0.3048 * Vec3(3, -20, 2)).norm(), kRounding);
  EXPECT_LT((at("Meters") - Vec3(3, -20, 2)).norm(), kRounding);
  EXPECT_LT((at("Feet", "null") - Vec3(3, -20, 2)).norm(), kRounding);
}

RC_GTEST_PROP(Fspy, CamerasComeBack, ()) {
  const auto in = [](int least, int most, double unit) {
    return *rc::gen::inRange(least, most + 1) * unit;
  };
  FspyCamera camera;
  camera.size_px = {*rc::gen::inRange(1, 5000), *rc::gen::inRange(1, 5000)};
  camera.relative_focal_length = in(1, 1000, 0.01);
  camera.principal_point = {in(-100, 100, 0.01), in(-100, 100, 0.01)};
  const Vec3 axis(in(-9, 9, 1), in(-9, 9, 1), in(1, 9, 1));
  camera.world_from_camera.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(in(-31, 31, 0.1), axis.normalized()).toRotationMatrix();
  camera.world_from_camera.topRightCorner<3, 1>() =
      Vec3(in(-99, 99, 1), in(-99, 99, 1), in(-99, 99, 1));
  const auto framed = FramedCameraOf(camera);
  RC_ASSERT(framed.has_value());
  const FspyCamera again = FspyCameraOf(*framed);
  RC_ASSERT(again.size_px == camera.size_px);
  RC_ASSERT(std::abs(again.relative_focal_length - camera.relative_focal_length) < kRounding);
  RC_ASSERT((again.principal_point - camera.principal_point).norm() < kRounding);
  RC_ASSERT((again.world_from_camera - camera.world_from_camera).cwiseAbs().maxCoeff() < 1e-7);
}

TEST(Fspy, DotsHavePointsOnItsImagePlaneAndShares) {
  const Eigen::Vector2i size_px(640, 480);
  EXPECT_LT(FspyPointOf({319.5, 239.5}, size_px).norm(), kRounding);
  EXPECT_LT((FspyPointOf({-0.5, -0.5}, size_px) - Vec2(-1, 0.75)).norm(), kRounding);
  EXPECT_LT((FspyShareOf({639.5, 479.5}, size_px) - Vec2(1, 1)).norm(), kRounding);
  const Vec2 dot(12, 345);
  EXPECT_LT((DotOfFspyPoint(FspyPointOf(dot, size_px), size_px) - dot).norm(), kRounding);
}

TEST(Fspy, AProjectHasItsTwoPartsAsTheyWerePut) {
  const std::string file = FspyProjectOf("{\"a\": 1}", "picture");
  const auto project = FspyProjectIn(BytesOf(file));
  ASSERT_TRUE(project.has_value());
  EXPECT_EQ(project->settings, "{\"a\": 1}");
  EXPECT_EQ(project->picture.size(), 7u);
  EXPECT_TRUE(IsFspyProject(BytesOf(file)));
}

void ExpectUnreadable(const std::string& file, std::string_view part) {
  const auto project = FspyProjectIn(BytesOf(file));
  ASSERT_FALSE(project.has_value());
  EXPECT_EQ(project.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(project.error().detail.find(part), std::string::npos) << project.error().detail;
}

TEST(Fspy, ProjectsThatAreNoneAreRefused) {
  const std::string whole = FspyProjectOf("{}", "picture");
  ExpectUnreadable("", "no fSpy project");
  ExpectUnreadable("PNG", "no fSpy project");
  for (std::size_t size = 4; size < whole.size(); ++size) {
    ExpectUnreadable(whole.substr(0, size), "cut off");
  }
  std::string other = whole;
  other[4] = '\x99';
  ExpectUnreadable(other, "version 153");
  for (const std::size_t length : {8, 12}) {
    std::string huge = whole;
    huge.replace(length, 4, "\xff\xff\xff\xff");
    ExpectUnreadable(huge, "cut off");
  }
}

void ExpectNoCamera(std::string_view text, ErrorCode code) {
  const auto read = CameraInFspy(text);
  ASSERT_FALSE(read.has_value()) << text;
  EXPECT_EQ(read.error().code, code) << text;
  EXPECT_FALSE(read.error().detail.empty());
}

TEST(Fspy, TextsWithoutACameraAreRefused) {
  const auto with = [](std::string_view what, std::string_view other) {
    std::string text(kStored);
    text.replace(text.find(what), what.size(), other);
    return text;
  };
  for (const std::string_view text : {"", "no JSON", "{", "[]", "null", "{}", "{\"a\": 1e999}"}) {
    ExpectNoCamera(text, ErrorCode::kUnreadable);
  }
  ExpectNoCamera(R"({"calibrationSettingsBase": {}, "cameraParameters": 1})",
                 ErrorCode::kUnreadable);
  ExpectNoCamera(with("1000", "1000.5"), ErrorCode::kUnreadable);
  ExpectNoCamera(with("1000", "0"), ErrorCode::kUnreadable);
  ExpectNoCamera(with("1000", "99999999999"), ErrorCode::kUnreadable);
  ExpectNoCamera(with("[1, 0, 0, 3]", "[1, 0, 0]"), ErrorCode::kUnreadable);
  ExpectNoCamera(with("[1, 0, 0, 3]", "[\"1\", 0, 0, 3]"), ErrorCode::kUnreadable);
  ExpectNoCamera(with("1.5", "-1.5"), ErrorCode::kOutOfRange);
  ExpectNoCamera(with("[1, 0, 0, 3]", "[-1, 0, 0, 3]"), ErrorCode::kOutOfRange);  // a reflection
  ExpectNoCamera(with("[1, 0, 0, 3]", "[2, 0, 0, 3]"), ErrorCode::kOutOfRange);
  ExpectNoCamera(with("[1, 0, 0, 3]", "[1, 0, 0, 1e300]"), ErrorCode::kOutOfRange);
  ExpectNoCamera(with("[1, 0, 0, 3]", "[0, 0, 0, 3]"), ErrorCode::kOutOfRange);
  ExpectNoCamera(std::string(100'000, '['), ErrorCode::kTooLarge);
  ExpectNoCamera(std::string(17 << 20, ' '), ErrorCode::kTooLarge);
}

TEST(Fspy, AProjectWithoutASolutionHasNoCamera) {
  for (const std::string_view text :
       {R"({"calibrationSettingsBase": {}, "cameraParameters": null})",
        R"({"calibrationSettingsBase": {}})"}) {
    const auto read = CameraInFspy(text);
    ASSERT_TRUE(read.has_value());
    EXPECT_FALSE(read->has_value());
  }
}

std::string ExactText(std::string_view r = "[[1, 0, 0], [0, 0, -1], [0, 1, 0]]") {
  return R"({"tranos_camera": 1, "size_px": [1000, 600], "format_mm": [50, 30],
    "K": [[750, 20, 549.5], [0, 800, 399.5], [0, 0, 1]], "t_m": [-3, 2, 20], "R": )" +
         std::string(r) + "}";
}

TEST(CameraFile, AnExactCameraKeepsItsSkewAndFormat) {
  const std::string text = ExactText();
  const auto read = CameraInFile(BytesOf(text));
  ASSERT_TRUE(read.has_value()) << read.error().detail;
  Mat3 k;
  k << 750, 20, 549.5, 0, 800, 399.5, 0, 0, 1;
  EXPECT_LT((DotFromCamera(**read) - k).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LT(((*read)->camera.position_m() - Vec3(3, -20, 2)).norm(), kRounding);
  EXPECT_EQ((*read)->frame.size_mm, Vec2(50, 30));
  EXPECT_NEAR((*read)->camera[kFocal], 37.5, kRounding);
}

TEST(CameraFile, ProjectsAndTheirTextsHoldOneCamera) {
  const std::string text = ProjectSettings(), project = FspyProjectOf(text, "picture");
  for (const std::string& file : {text, project, std::string(kStored)}) {
    const auto read = CameraInFile(BytesOf(file));
    ASSERT_TRUE(read.has_value() && read->has_value());
    EXPECT_LT(((*read)->camera.position_m() - Vec3(3, -20, 2)).norm(), kRounding);
  }
}

TEST(CameraFile, ExactCamerasThatAreNotCompleteAreRefused) {
  for (const std::string& text :
       {std::string(R"({"tranos_camera": 2})"), std::string(R"({"tranos_camera": 1})"),
        ExactText("[[1, 0], [0, 1]]"), ExactText("1"),
        ExactText("[[1, 0, 0], [0, 1, 0], [0, 0, -1]]")}) {
    EXPECT_FALSE(CameraInFile(BytesOf(text)).has_value()) << text;
  }
}

// Any bytes end with a value or an error. Half of the files begin as a project.
RC_GTEST_PROP(Fspy, AnyBytesAreReadOrRefused, ()) {
  std::string file = *rc::gen::container<std::string>(rc::gen::arbitrary<char>());
  if (*rc::gen::arbitrary<bool>()) {
    file = FspyProjectOf(ProjectSettings(), "picture");
    if (*rc::gen::arbitrary<bool>()) file = ExactText();
    const int changes = *rc::gen::inRange(0, 4);
    for (int i = 0; i < changes; ++i) {
      file[*rc::gen::inRange<std::size_t>(0, file.size())] = *rc::gen::arbitrary<char>();
    }
    file.resize(*rc::gen::inRange<std::size_t>(0, file.size() + 1));
  }
  const auto project = FspyProjectIn(BytesOf(file));
  if (!project) RC_ASSERT(!project.error().detail.empty());
  const auto read = CameraInFile(BytesOf(file));
  if (read && *read) RC_ASSERT((*read)->camera.parameters.allFinite());
}

// Projects of fSpy's own, where they are beside the project.
std::string RealFile(const std::string& name) {
  const char* given = std::getenv("TRANOS_DATA");
  const std::filesystem::path data = given ? given : TRANOS_DATA_BESIDE;
  std::ifstream stream(data / "fspy" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(FspyOfItsOwn, AStoredCameraIsReadAsItsVanishingPointsSay) {
  const std::string file = RealFile("shifted_landscape.fspy");
  if (file.empty()) GTEST_SKIP() << "skipped: no test photographs";
  const auto project = FspyProjectIn(BytesOf(file));
  ASSERT_TRUE(project.has_value());
  const FramedCamera read = StoredIn(project->settings);
  const Mat3 k = DotFromCamera(read);
  EXPECT_NEAR(k(0, 0), 1976.23, 0.01);
  EXPECT_NEAR(k(0, 2) + 0.5, 1813.05, 0.01);
  EXPECT_NEAR(k(1, 2) + 0.5, 907.21, 0.01);
  EXPECT_EQ(PhotoSizeOf(project->picture)->width_px, 2592);
  // X, Y and Z vanish where the project says.
  const Vec2 vanishing[] = {{-2.7260195314245665, 0.7671623565523663},
                            {1.4060917742346188, 0.9935767982124877},
                            {0.5300705963528702, -2.4261905184903783}};
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 dot = k * CameraFromWorld(read.camera.parameters) * Vec3::Unit(axis);
    const Vec2 said = DotOfFspyPoint(vanishing[axis], read.frame.size_px);
    EXPECT_LT((dot.hnormalized() - said).norm(), 1e-6);
  }
}

TEST(FspyOfItsOwn, ProjectsWithoutASolutionOrOfAnotherVersionAreRefused) {
  const std::string file = RealFile("no_camera_parameters.fspy");
  if (file.empty()) GTEST_SKIP() << "skipped: no test photographs";
  const auto project = FspyProjectIn(BytesOf(file));
  ASSERT_TRUE(project.has_value());
  EXPECT_FALSE(CameraInFspy(project->settings)->has_value());
  ExpectUnreadable(RealFile("invalid_project_version.fspy"), "version 153");
}

}  // namespace
}  // namespace tranos::camera
