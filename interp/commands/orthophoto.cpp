// SPDX-License-Identifier: GPL-3.0-or-later
// construct orthophoto: a facade as a photograph shows it, at scale.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "camera/facade_view.h"
#include "interp/commands/drawing.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/photographs.h"
#include "model/faces.h"
#include "model/orthophoto.h"

namespace tranos::interp {

using camera::Mat3;
using geom::Frame;
using geom::Vec2;
using geom::Vec3;
using model::ElementPtr;
using model::Orthophoto;
using model::State;

namespace {

constexpr double kMostPixels = 64e6;
constexpr int kWidest_px = 16384;
constexpr double kTolerance_m = 0.02;
// The sine of the angle under which a facade is seen, below which there is nothing to be seen on
// it.
constexpr double kEdgeOn = 0.01;

// A rectangle on the facade, in metres along it and up it; empty until something is added.
using Extent = Eigen::AlignedBox2d;

// Where the dots that were traced on the facade lie on it.
void AddTraces(const State& state, const model::Element& photograph, const std::string& facade,
               const Mat3& dot_from_plane, Extent* extent) {
  const Mat3 plane_from_dot = dot_from_plane.inverse();
  state.model.ForEach([&](const ElementPtr& element) {
    const auto* trace = std::get_if<model::TracePtr>(&element->geometry);
    if (!trace || (*trace)->facade != facade || (*trace)->photograph != photograph.id) return;
    for (const Vec2& dot_px : (*trace)->dots_px) {
      const Vec2 place = (plane_from_dot * dot_px.homogeneous()).hnormalized();
      if ((dot_from_plane * place.homogeneous()).z() > 0) extent->extend(place);
    }
  });
}

// The faces that bear what lies in the plane.
void AddBearing(const State& state, const Frame& plane, double tolerance_m, Extent* extent) {
  const geom::Affine plane_from_world = plane.WorldFromFrame().inverse();
  state.model.ForEach([&](const ElementPtr& element) {
    model::ForEachLeaf(
        *element, [&](const model::Element& leaf, const geom::Affine& world_from_leaf,
                      const model::Attributes& attributes) {
          if (!model::HasFaces(leaf) || !state.model.LevelIsOn(attributes.level)) return;
          const geom::Box box =
              geom::Carried(model::BoundingBox(leaf), plane_from_world * world_from_leaf);
          if (box.empty() || box.min.z() > tolerance_m || box.max.z() < -tolerance_m) return;
          const auto mesh = model::FacesOf(leaf, leaf.tolerance);
          if (!mesh) return;
          const Eigen::Matrix3d world_from_normal = world_from_leaf.linear().inverse().transpose();
          for (const auto& triangle : mesh->triangles) {
            std::array<Vec3, 3> corners;
            for (std::size_t i = 0; i < 3; ++i) {
              corners[i] = world_from_leaf * mesh->positions[triangle[i]];
            }
            const Vec3 outward = model::HasOutside(leaf)
                                     ? Vec3(world_from_normal * mesh->normals[triangle[0]])
                                     : Vec3(Vec3::Zero());
            if (!model::Bears(corners, outward, plane, tolerance_m)) continue;
            for (const Vec3& corner : corners)
              extent->extend(plane.ToLocal(corner).head<2>().eval());
          }
        });
  });
}

tl::expected<Extent, CommandError> ExtentOf(const State& state, const Answers& answers,
                                            const model::Element& photograph, const Frame& plane,
                                            const Mat3& dot_from_plane, double tolerance_m) {
  Extent extent;
  for (const Vec3& corner : answers.points) extent.extend(plane.ToLocal(corner).head<2>().eval());
  if (answers.points.empty()) {
    AddTraces(state, photograph, answers.Text("facade"), dot_from_plane, &extent);
    AddBearing(state, plane, tolerance_m, &extent);
  }
  if (!extent.isEmpty() && extent.sizes().minCoeff() > geom::kCoincident_m) return extent;
  return Fail({.code = Code::kMissingValue,
               .message = answers.points.empty()
                              ? "how far is the orthophoto to reach? Nothing is traced on the "
                                "facade, and nothing is built in its plane"
                              : "two corners, aside of and above one another, say how far it is to "
                                "reach",
               .help = "construct orthophoto facade=front pixel=1cm xy=0,0,0 xy=15.5,0,12"});
}

// How many pixels reach over the extent.
tl::expected<Eigen::Vector2i, CommandError> SizeOver(const Extent& extent, double pixel_m) {
  const Eigen::Array2d count = (extent.sizes().array() / pixel_m - 1e-6).ceil().max(1);
  if (count.maxCoeff() <= kWidest_px && count.prod() <= kMostPixels) {
    return Eigen::Vector2i(count.cast<int>());
  }
  return Fail({.code = Code::kOutOfRange,
               .message = fmt::format("the orthophoto would have {:.0f} × {:.0f} pixels; it has at "
                                      "most {} along a side, and {:.0f} million",
                                      count.x(), count.y(), kWidest_px, kMostPixels / 1e6),
               .help = "a larger `pixel=`, or two corners nearer to one another",
               .where = AtKey("pixel")});
}

// From which side, and how squarely, the camera sees the plane, there where it sees it best.
std::optional<CommandError> NotSeen(const Frame& plane, const Vec3& camera_m,
                                    const std::string& facade, const Extent& extent) {
  const Vec3 camera = plane.ToLocal(camera_m);
  const Vec2 nearest = camera.head<2>().cwiseMax(extent.min()).cwiseMin(extent.max());
  const double sine = camera.z() / std::hypot((camera.head<2>() - nearest).norm(), camera.z());
  if (sine > kEdgeOn) return std::nullopt;
  if (sine < -kEdgeOn) {
    return CommandError{
        .code = Code::kNotSeen,
        .message = fmt::format("the camera stands behind the facade `{}`", Printable(facade)),
        .help =
            "a facade is seen from its front: `construct facade` with its points the other "
            "way round turns it"};
  }
  return CommandError{.code = Code::kEdgeOn,
                      .message = fmt::format("the facade `{}` is seen edge-on", Printable(facade)),
                      .label = fmt::format("under {:.2f}°", std::asin(std::abs(sine)) / kDegree),
                      .help = "take it from another photograph: `photo=NAME`"};
}

// The ground sampling distances over it, of places that are in the photograph, in order.
std::vector<double> Sampling(const Extent& extent, const Mat3& dot_from_plane,
                             const camera::Frame& frame) {
  constexpr int kSteps = 40;
  std::vector<double> lengths_m;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps; ++k) {
      const Vec2 place = extent.min() + extent.sizes().cwiseProduct(Vec2(i, k) / double{kSteps});
      const Vec3 dot = dot_from_plane * place.homogeneous();
      if (!(dot.z() > 0)) continue;
      const Vec2 from_centre = dot.hnormalized() - frame.centre_px();
      if ((from_centre.cwiseAbs().array() > frame.size_px.cast<double>().array() / 2).any())
        continue;
      lengths_m.push_back(camera::GroundSampling_m(dot_from_plane, place));
    }
  }
  std::sort(lengths_m.begin(), lengths_m.end());
  return lengths_m;
}

// An error if the key's length is not within these.
std::optional<CommandError> NoLength(std::string_view key, double length_m, double least_m,
                                     double most_m, std::string_view help) {
  if (length_m >= least_m && length_m <= most_m) return std::nullopt;
  return CommandError{
      .code = Code::kOutOfRange,
      .message = fmt::format("`{}` is a length from {:g} m to {:g} m", key, least_m, most_m),
      .help = std::string(help),
      .where = AtKey(key)};
}

CommandResult ConstructOrthophoto(const State& state, const Answers& answers) {
  if (auto error = NotPng(answers, "an orthophoto")) return Fail(*std::move(error));
  Orthophoto made;
  made.facade = answers.Text("facade");
  const auto facade = FacadeNamed(state, made.facade, AtKey("facade"));
  if (!facade) return Fail(facade.error());
  const auto photograph = CameraAt(state, answers, "photo");
  if (!photograph) return Fail(photograph.error());
  const model::Photograph& taken = PhotographOf(**photograph);
  made.photograph = *photograph;
  auto pixels = PixelsOf(**photograph);
  // A replay has no pixels.
  if (!pixels && pixels.error().code != Code::kCannotRead) {
    if (answers.Has("photo")) pixels.error().where = AtKey("photo");
    return Fail(pixels.error());
  }
  if (pixels) made.pixels = *std::move(pixels);
  made.pixel_m = answers.Number("pixel");
  made.tolerance_m = answers.Number("tolerance", kTolerance_m);
  if (auto error = NoLength("pixel", made.pixel_m, 1e-5, 1e4, "pixel=1cm")) return Fail(*error);
  if (auto error = NoLength("tolerance", made.tolerance_m, 1e-6, 1e4, "tolerance=2cm")) {
    return Fail(*error);
  }
  const Frame& plane = model::FacadeOf(**facade).plane;
  const Mat3 dot_from_plane = camera::DotFromPlane(taken.estimate->camera, taken.frame, plane);
  const auto extent =
      ExtentOf(state, answers, **photograph, plane, dot_from_plane, made.tolerance_m);
  if (!extent) return Fail(extent.error());
  const auto size_px = SizeOver(*extent, made.pixel_m);
  if (!size_px) return Fail(size_px.error());
  if (auto error = NotSeen(plane, taken.estimate->camera.position_m(), made.facade, *extent)) {
    return Fail(*error);
  }
  const std::vector<double> sampling_m = Sampling(*extent, dot_from_plane, taken.frame);
  if (sampling_m.empty()) {
    return Fail({.code = Code::kNotSeen,
                 .message = fmt::format("nothing of the facade `{}` is seen on {}",
                                        Printable(made.facade), NameForMessage(**photograph)),
                 .help = "two corners say which part of it is meant"});
  }
  made.size_px = *size_px;
  made.sampling_m = sampling_m[sampling_m.size() / 2];
  made.plane = plane;
  made.plane.origin = plane.ToWorld({extent->min().x(), extent->min().y(), 0});
  made.standing = std::make_shared<const model::Model>(model::Apart(state.model));
  const bool is_written = answers.Has("file") && made.pixels;
  const std::string told = fmt::format(
      "orthophoto of {}: {} × {} px of {}; a pixel of the photograph covers {} to {} of it, {} in "
      "the middle",
      made.facade, made.size_px.x(), made.size_px.y(),
      InWords(made.pixel_m, *state.drawing.settings),
      InWords(sampling_m.front(), *state.drawing.settings),
      InWords(sampling_m.back(), *state.drawing.settings),
      InWords(made.sampling_m, *state.drawing.settings));
  const auto shared = std::make_shared<const Orthophoto>(std::move(made));
  Fired fired = *Make(state, shared);
  fired.messages.push_back(told);
  if (is_written)
    fired.edit.outputs.emplace_back(model::OrthophotoRequest{shared, answers.Text("file")});
  return fired;
}

constexpr Prompt kCorners[] = {{"corner"}};
constexpr Key kKeys[] = {
    {"facade", Type::kName, "the facade", {}, {}, -1, true},
    {"pixel", Type::kLength, "the length of a pixel on the facade", {}, {}, -1, true},
    {"photo", Type::kElement, "the photograph; the one last attached or set without"},
    {"tolerance",
     Type::kLength,
     "how far before the plane what is built still lies in it, and does not hide it",
     {},
     "2cm"},
    {"file", Type::kString, "a png to write it to; beside it, as json, what is to be known of it"}};

#define TRANOS_FRONT                                                     \
  "attach photo \"facade.png\" format=36mm,24.0075mm as hall\n"          \
  "trace edge from=[0,0,0] to=[10,0,0]"                                  \
  " dot=294.548511011,965.368611432 dot=759.305603241,986.421140680\n"   \
  "trace edge from=[0,0,6] to=[10,0,6]"                                  \
  " dot=312.182940081,655.505353230 dot=758.214339571,628.265818867\n"   \
  "trace edge from=[0,0,0] to=[0,0,6]"                                   \
  " dot=294.548511011,965.368611432 dot=312.182940081,655.505353230\n"   \
  "trace edge from=[10,0,0] to=[10,0,6]"                                 \
  " dot=759.305603241,986.421140680 dot=758.214339571,628.265818867\n"   \
  "trace edge from=[10,0,0] to=[10,14,0]"                                \
  " dot=759.305603241,986.421140680 dot=1014.051340933,948.661093774\n"  \
  "trace edge from=[10,0,6] to=[10,14,6]"                                \
  " dot=758.214339571,628.265818867 dot=1005.253668903,704.291442280\n"  \
  "trace edge from=[10,14,0] to=[10,14,6]"                               \
  " dot=1014.051340933,948.661093774 dot=1005.253668903,704.291442280\n" \
  "calibrate; construct facade front xy=0,0 xy=10,0\n"
constexpr Example kExamples[] = {
    {TRANOS_FRONT "construct orthophoto facade=front pixel=1cm xy=0,0,0 xy=10,0,6 as o",
     "o.width == 10m and o.height == 6m and o.sampling > 1cm"},
    {TRANOS_FRONT "place slab length=10m width=14m height=6m xy=0,0,0\n"
                  "construct orthophoto facade=front pixel=2cm tolerance=1cm photo=hall "
                  "file=\"front.png\" as o",
     "o.pixel == 2cm and o.height == 6m"},
    {TRANOS_FRONT "construct orthophoto facade=front pixel=1cm", "E0220"},
    {TRANOS_FRONT "construct facade behind xy=10,14 xy=0,14\n"
                  "construct orthophoto facade=behind pixel=1cm xy=0,14,0 xy=10,14,6",
     "E0915"},
    {"construct orthophoto facade=front pixel=1cm", "E0908"}};
#undef TRANOS_FRONT

constexpr Command kCommands[] = {
    {.words = "construct orthophoto",
     .family = "construct",
     .summary = "A facade as a photograph shows it, seen squarely and to scale; what is hidden, or "
                "outside the photograph, is left out. It reaches as far as two corners say, or as "
                "what was traced or built on the facade. What is built bears it where it lies in "
                "its plane.",
     .manner = Manner::kGathers,
     .prompts = kCorners,
     .least = 0,
     .most = 2,
     .keys = kKeys,
     .string_key = "file",
     .examples = kExamples,
     .execute = ConstructOrthophoto},
};

}  // namespace

std::span<const Command> OrthophotoCommands() { return kCommands; }

}  // namespace tranos::interp
