// SPDX-License-Identifier: GPL-3.0-or-later
// place: slabs, wedges, cylinders, cones, spheres, tori. They stand on the active plane; each size
// is asked for by a data point, or given by its key.
#include <fmt/format.h>

#include <cmath>

#include "geom/solid_primitives.h"
#include "interp/commands/families.h"
#include "interp/commands/solids.h"

namespace tranos::interp {

using geom::Frame;
using geom::Vec3;
using model::State;

namespace {

const geom::Tolerance& ToleranceOf(const State& state) { return state.drawing.settings->tolerance; }

// What the point of this prompt is in the frame; nothing of interest where a key answered.
Vec3 LocalPoint(const Answers& answers, const Frame& frame, std::size_t prompt) {
  return answers.answered[prompt] ? frame.ToLocal(answers.points[prompt]) : Vec3(Vec3::Zero());
}

struct BoxSizes {
  Frame frame;
  Vec3 size;
};

// From a corner along its length, which a data point may turn; then to one side and up.
tl::expected<BoxSizes, CommandError> BoxSizesOf(const State& state, const Answers& answers) {
  Frame frame = PlaneAt(state, answers.points[0]);
  const Vec3 along = LocalPoint(answers, frame, 1);
  const double length = std::hypot(along.x(), along.y());
  if (length > geom::kCoincident_m) {
    const Vec3 normal = frame.z();
    frame.x = (along.x() * frame.x + along.y() * frame.y) / length;
    frame.y = normal.cross(frame.x);
  }
  const auto length_m = SizeOf(state, answers, "length", 1, length);
  if (!length_m) return Fail(length_m.error());
  const auto width_m = SizeOf(state, answers, "width", 2, LocalPoint(answers, frame, 2).y());
  if (!width_m) return Fail(width_m.error());
  const auto height_m = SizeOf(state, answers, "height", 3, LocalPoint(answers, frame, 3).z());
  if (!height_m) return Fail(height_m.error());
  return BoxSizes{frame, {*length_m, *width_m, *height_m}};
}

CommandResult PlaceSlab(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto sizes = BoxSizesOf(state, answers);
  if (!sizes) return Fail(sizes.error());
  return MakeSolid(state, geom::SlabMesh(sizes->frame, sizes->size), "a slab");
}

CommandResult PlaceWedge(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto sizes = BoxSizesOf(state, answers);
  if (!sizes) return Fail(sizes.error());
  return MakeSolid(state, geom::WedgeMesh(sizes->frame, sizes->size), "a wedge");
}

struct RoundSizes {
  Frame frame;
  double radius_m, height_m;
};

tl::expected<RoundSizes, CommandError> RoundSizesOf(const State& state, const Answers& answers) {
  const Frame frame = PlaneAt(state, answers.points[0]);
  const Vec3 edge = LocalPoint(answers, frame, 1);
  const auto radius_m = SizeOf(state, answers, "radius", 1, std::hypot(edge.x(), edge.y()));
  if (!radius_m) return Fail(radius_m.error());
  const auto height_m = SizeOf(state, answers, "height", 2, LocalPoint(answers, frame, 2).z());
  if (!height_m) return Fail(height_m.error());
  return RoundSizes{frame, *radius_m, *height_m};
}

CommandResult PlaceCylinder(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto sizes = RoundSizesOf(state, answers);
  if (!sizes) return Fail(sizes.error());
  return MakeSolid(
      state, geom::CylinderMesh(sizes->frame, sizes->radius_m, sizes->height_m, ToleranceOf(state)),
      "a cylinder");
}

CommandResult PlaceCone(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto sizes = RoundSizesOf(state, answers);
  if (!sizes) return Fail(sizes.error());
  const double top_m = answers.Number("top", 0);
  if (!(top_m >= 0)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = fmt::format("the radius at the top is {}, and must not be below zero",
                                        InWords(top_m, *state.drawing.settings)),
                 .label = "0 or above",
                 .where = AtKey("top")});
  }
  return MakeSolid(
      state,
      geom::ConeMesh(sizes->frame, sizes->radius_m, top_m, sizes->height_m, ToleranceOf(state)),
      "a cone");
}

CommandResult PlaceSphere(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const Frame frame = PlaneAt(state, answers.points[0]);
  const auto radius_m = SizeOf(state, answers, "radius", 1, LocalPoint(answers, frame, 1).norm());
  if (!radius_m) return Fail(radius_m.error());
  return MakeSolid(state, geom::SphereMesh(frame, *radius_m, ToleranceOf(state)), "a sphere");
}

CommandResult PlaceTorus(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const Frame frame = PlaneAt(state, answers.points[0]);
  const Vec3 ring = LocalPoint(answers, frame, 1), skin = LocalPoint(answers, frame, 2);
  const auto radius_m = SizeOf(state, answers, "radius", 1, std::hypot(ring.x(), ring.y()));
  if (!radius_m) return Fail(radius_m.error());
  const double by_point = std::hypot(std::hypot(skin.x(), skin.y()) - *radius_m, skin.z());
  const auto tube_m = SizeOf(state, answers, "tube", 2, by_point);
  if (!tube_m) return Fail(tube_m.error());
  if (!(*tube_m < *radius_m)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = fmt::format("a tube of radius {} in a ring of radius {} meets itself",
                                        InWords(*tube_m, *state.drawing.settings),
                                        InWords(*radius_m, *state.drawing.settings)),
                 .label = "below the ring's radius",
                 .where = answers.answered[2] ? AtPoint(2) : AtKey("tube")});
  }
  const double angle_rad = answers.Number("angle", 2 * geom::kPi);
  if (!(angle_rad > 1e-12 && angle_rad <= 2 * geom::kPi + 1e-12)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = "a torus turns more than 0 and at most 360 degrees",
                 .where = AtKey("angle")});
  }
  return MakeSolid(state,
                   geom::TorusMesh(frame, *radius_m, *tube_m, std::min(angle_rad, 2 * geom::kPi),
                                   ToleranceOf(state)),
                   "a torus");
}

constexpr Prompt kBoxPrompts[] = {{"corner"}, {"end of the length"}, {"width"}, {"height"}};
constexpr Prompt kRoundPrompts[] = {{"centre of the base"}, {"edge"}, {"height"}};
constexpr Prompt kSpherePrompts[] = {{"centre"}, {"point on the surface"}};
constexpr Prompt kTorusPrompts[] = {
    {"centre"}, {"middle of the tube"}, {"point on the tube's surface"}};

constexpr Key kBoxKeys[] = {{"length", Type::kLength, "along the active plane's x axis", {}, {}, 1},
                            {"width", Type::kLength, "along its y axis", {}, {}, 2},
                            {"height", Type::kLength, "above the plane", {}, {}, 3}};
constexpr Key kCylinderKeys[] = {{"radius", Type::kLength, "of the base", {}, {}, 1},
                                 {"height", Type::kLength, "above the active plane", {}, {}, 2}};
constexpr Key kConeKeys[] = {
    {"radius", Type::kLength, "of the base", {}, {}, 1},
    {"height", Type::kLength, "above the active plane", {}, {}, 2},
    {"top", Type::kLength, "radius at the top: above zero for a frustum", {}, "0m"}};
constexpr Key kSphereKeys[] = {{"radius", Type::kLength, "the radius", {}, {}, 1}};
constexpr Key kTorusKeys[] = {
    {"radius", Type::kLength, "from the axis to the middle of the tube", {}, {}, 1},
    {"tube", Type::kLength, "radius of the tube", {}, {}, 2},
    {"angle", Type::kAngle, "how far it turns, anticlockwise from the x axis", {}, "360deg"}};

constexpr Example kSlabExamples[] = {
    {"place slab length=4m width=3m height=0.5m xy=0,0,0", "last.volume within 6m3 +- 0.000001m3"},
    {"place slab xy=0,0,0 xy=4,0,0 xy=4,3,0 xy=4,3,2", "last.bbox.max.z == 2m"},
    {"place slab length=4m width=0m height=1m xy=0,0,0", "E0212"}};
constexpr Example kWedgeExamples[] = {
    {"place wedge length=4m width=3m height=2m xy=0,0,0", "last.volume within 12m3 +- 0.000001m3"},
    {"place wedge xy=0,0,0 xy=4,0,0 xy=4,0,0 xy=4,0,2", "E0501"}};
constexpr Example kCylinderExamples[] = {
    {"fn=4; place cylinder radius=1m height=3m xy=0,0,0", "last.volume within 6m3 +- 0.000001m3"},
    {"place cylinder xy=0,0,0 xy=2,0,0 xy=0,0,5", "last.bbox.size.z == 5m"},
    {"place cylinder radius=-1m height=3m xy=0,0,0", "E0212"}};
constexpr Example kConeExamples[] = {
    {"fn=4; place cone radius=1m height=3m xy=0,0,0", "last.volume within 2m3 +- 0.000001m3"},
    {"place cone radius=1m height=3m top=0.5m xy=0,0,0", "last.faces == 3"},
    {"place cone radius=1m height=3m top=-1m xy=0,0,0", "E0212"}};
constexpr Example kSphereExamples[] = {
    {"place sphere radius=2m xy=0,0,0", "last.volume within 33.5m3 +- 0.1m3"},
    {"place sphere xy=0,0,0 xy=0,0,0", "E0501"}};
constexpr Example kTorusExamples[] = {
    {"place torus radius=2m tube=0.5m xy=0,0,0", "last.genus == 1"},
    {"place torus radius=2m tube=0.5m angle=90deg xy=0,0,0", "last.faces == 3"},
    {"place torus radius=1m tube=2m xy=0,0,0", "E0212"}};

constexpr Command kCommands[] = {
    {.words = "place slab",
     .family = "place",
     .summary = "A rectangular block on the active plane, by a corner, its length, width and "
                "height.",
     .manner = Manner::kPlaces,
     .prompts = kBoxPrompts,
     .keys = kBoxKeys,
     .examples = kSlabExamples,
     .execute = PlaceSlab},
    {.words = "place wedge",
     .family = "place",
     .summary = "A slab cut along a diagonal: a ramp that rises along its length.",
     .manner = Manner::kPlaces,
     .prompts = kBoxPrompts,
     .keys = kBoxKeys,
     .examples = kWedgeExamples,
     .execute = PlaceWedge},
    {.words = "place cylinder",
     .family = "place",
     .summary = "A cylinder on the active plane.",
     .manner = Manner::kPlaces,
     .prompts = kRoundPrompts,
     .keys = kCylinderKeys,
     .examples = kCylinderExamples,
     .execute = PlaceCylinder},
    {.words = "place cone",
     .family = "place",
     .summary = "A cone on the active plane, or a frustum.",
     .manner = Manner::kPlaces,
     .prompts = kRoundPrompts,
     .keys = kConeKeys,
     .examples = kConeExamples,
     .execute = PlaceCone},
    {.words = "place sphere",
     .family = "place",
     .summary = "A ball about a centre, its poles on the active plane's normal.",
     .manner = Manner::kPlaces,
     .prompts = kSpherePrompts,
     .keys = kSphereKeys,
     .examples = kSphereExamples,
     .execute = PlaceSphere},
    {.words = "place torus",
     .family = "place",
     .summary = "A ring about the active plane's normal, or a part of one.",
     .manner = Manner::kPlaces,
     .prompts = kTorusPrompts,
     .keys = kTorusKeys,
     .examples = kTorusExamples,
     .execute = PlaceTorus},
};

}  // namespace

std::span<const Command> PlaceSolidCommands() { return kCommands; }

}  // namespace tranos::interp
