// SPDX-License-Identifier: GPL-3.0-or-later
// place: points, curves and text.
#include <fmt/format.h>

#include <cmath>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

using geom::Frame;
using geom::Vec3;
using model::State;

namespace {

CommandResult PlacePoint(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  return Make(state, model::Point{answers.points[0]});
}

CommandResult PlaceLine(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const Vec3 &start = answers.points[0], &end = answers.points[1];
  if ((end - start).norm() <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "a line of no length",
                 .label = "the line starts here, too",
                 .where = AtPoint(1)});
  }
  return Make(state, CurveGeometry(geom::Line{start, end}));
}

CommandResult PlaceArcEdge(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto arc = geom::ArcThrough(answers.points[0], answers.points[1], answers.points[2]);
  if (!arc) return Fail(FromGeom(arc.error(), "an arc", AtPoint(1)));
  return Make(state, CurveGeometry(*arc));
}

// The sweep is an angle or the direction in which the third point is seen from the centre.
tl::expected<geom::Arc, CommandError> ArcAboutCentre(const Answers& answers, const Frame& plane) {
  const Vec3 start = plane.ToLocal(answers.points[0]);
  if (answers.answered[2]) {
    const auto arc = geom::ArcAround(plane.origin, answers.points[0], answers.points[2], plane.z());
    if (!arc) return Fail(FromGeom(arc.error(), "an arc", AtPoint(2)));
    return *arc;
  }
  const double sweep_rad = answers.Number("angle");
  if (std::abs(sweep_rad) <= 1e-12 || std::abs(sweep_rad) > 2 * geom::kPi + 1e-12) {
    return Fail({.code = Code::kOutOfRange,
                 .message = "an arc sweeps more than 0 and at most 360 degrees",
                 .where = AtKey("angle")});
  }
  const double radius = std::hypot(start.x(), start.y());
  Frame frame = plane;
  frame.x = (start.x() * plane.x + start.y() * plane.y) / radius;
  frame.y = plane.z().cross(frame.x);
  if (sweep_rad < 0) frame.y = -frame.y;  // clockwise: about the plane's normal turned over
  return geom::Arc{frame, radius, std::min(std::abs(sweep_rad), 2 * geom::kPi)};
}

CommandResult PlaceArcCentre(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const Frame plane = PlaneAt(state, answers.points[1]);
  const Vec3 start = plane.ToLocal(answers.points[0]);
  if (std::abs(start.z()) > kOffPlane_m) return Fail(OffPlane(state, start.z(), 1));
  if (std::hypot(start.x(), start.y()) <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "an arc of radius zero",
                 .label = "the arc starts here, too",
                 .where = AtPoint(1)});
  }
  const auto arc = ArcAboutCentre(answers, plane);
  if (!arc) return Fail(arc.error());
  return Make(state, CurveGeometry(*arc));
}

CommandResult MakeCircle(const State& state, const Vec3& centre, double radius, Where where) {
  if (radius <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "a circle needs a radius above zero",
                 .where = where});
  }
  return Make(state, CurveGeometry(geom::Circle{PlaneAt(state, centre), radius}));
}

CommandResult PlaceCircleCentre(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const Vec3& centre = answers.points[0];
  if (!answers.answered[1]) {
    return MakeCircle(state, centre, answers.Number("radius"), AtKey("radius"));
  }
  const Vec3 edge = PlaneAt(state, centre).ToLocal(answers.points[1]);
  if (std::abs(edge.z()) > kOffPlane_m) return Fail(OffPlane(state, edge.z(), 1));
  return MakeCircle(state, centre, std::hypot(edge.x(), edge.y()), AtPoint(1));
}

CommandResult PlaceCircleRadius(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  return MakeCircle(state, answers.points[0], answers.Number("radius"), AtKey("radius"));
}

CommandResult PlaceCircleEdge(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto arc = geom::ArcThrough(answers.points[0], answers.points[1], answers.points[2]);
  if (!arc) return Fail(FromGeom(arc.error(), "a circle", AtPoint(1)));
  return Make(state, CurveGeometry(geom::Circle{arc->frame, arc->radius}));
}

CommandResult PlaceBlock(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const Frame plane = PlaneAt(state, answers.points[0]);
  const Vec3 size = plane.ToLocal(answers.points[1]);
  if (std::min(std::abs(size.x()), std::abs(size.y())) <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "a block of no width or height",
                 .label = "in the active plane this lies in line with the first corner",
                 .help = "`set plane front` draws upright",
                 .where = AtPoint(1)});
  }
  if (std::abs(size.z()) > kOffPlane_m) return Fail(OffPlane(state, size.z(), 1));
  const Vec3 along_x = plane.ToWorld({size.x(), 0, 0}), along_y = plane.ToWorld({0, size.y(), 0});
  // Anticlockwise about the plane's normal, whichever corners were given.
  const bool turned = size.x() * size.y() < 0;
  return Make(state, CurveGeometry(geom::Polyline{
                         {plane.origin, turned ? along_y : along_x,
                          plane.ToWorld({size.x(), size.y(), 0}), turned ? along_x : along_y},
                         true}));
}

CommandResult PlaceShape(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  std::vector<Vec3> vertices = answers.points;
  // A last point on the first one closes the shape by hand, as it is closed anyway.
  if ((vertices.back() - vertices.front()).norm() <= geom::kCoincident_m) vertices.pop_back();
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    if ((vertices[i] - vertices[i - 1]).norm() <= geom::kCoincident_m) {
      return Fail({.code = Code::kDegenerate,
                   .message = "a shape with a side of no length",
                   .label = "the point before lies here, too",
                   .where = AtPoint(static_cast<int>(i))});
    }
  }
  if (vertices.size() < 3) {
    return Fail({.code = Code::kDegenerate,
                 .message = "a shape needs three corners",
                 .where = AtPoint(static_cast<int>(answers.points.size()) - 1)});
  }
  const geom::Curve shape = geom::Polyline{std::move(vertices), true};
  const auto area = geom::EnclosedArea(shape);
  if (!area) return Fail(FromGeom(area.error(), "a shape"));
  if (*area <= 1e-12 * geom::Length(shape)) {
    return Fail({.code = Code::kDegenerate, .message = "a shape that encloses nothing"});
  }
  return Make(state, CurveGeometry(shape));
}

CommandResult PlaceText(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const model::Settings& settings = *state.drawing.settings;
  const std::string content = answers.Text("text");
  if (content.empty()) {
    return Fail({.code = Code::kMissingValue,
                 .message = "the text is missing",
                 .help = "place text \"nave\" xy=0,0,0",
                 .where = AtKey("text")});
  }
  const double height_m = answers.Number("height", 1) * settings.scale.y();
  if (!(height_m > geom::kCoincident_m && height_m <= kFarthest_m)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = "text needs a height above zero",
                 .help = "the height is `height=` times the active scale `as`",
                 .where = answers.Has("height") ? AtKey("height") : Where{}});
  }
  const Frame& plane = settings.plane;
  const double c = std::cos(settings.angle_rad), s = std::sin(settings.angle_rad);
  const Frame frame = {answers.points[0], c * plane.x + s * plane.y, c * plane.y - s * plane.x};
  return Make(state, std::make_shared<const geom::Text>(geom::Text{content, frame, height_m}));
}

constexpr Prompt kPointPrompts[] = {{"point"}};
constexpr Prompt kLinePrompts[] = {{"start"}, {"next point"}};
constexpr Prompt kArcEdgePrompts[] = {{"start"}, {"point on the arc"}, {"end"}};
constexpr Prompt kArcCentrePrompts[] = {{"start"}, {"centre"}, {"end"}};
constexpr Prompt kCirclePrompts[] = {{"centre"}, {"edge"}};
constexpr Prompt kCircleRadiusPrompts[] = {{"centre"}};
constexpr Prompt kCircleEdgePrompts[] = {
    {"point on the edge"}, {"second point on the edge"}, {"third point on the edge"}};
constexpr Prompt kBlockPrompts[] = {{"corner"}, {"opposite corner"}};
constexpr Prompt kShapePrompts[] = {{"corner"}};
constexpr Prompt kTextPrompts[] = {{"start of the base line"}};

constexpr Key kArcCentreKeys[] = {
    {"angle", Type::kAngle, "how far the arc sweeps, anticlockwise if positive", {}, {}, 2}};
constexpr Key kCircleKeys[] = {{"radius", Type::kLength, "the radius", {}, {}, 1}};
constexpr Key kCircleRadiusKeys[] = {
    {"radius", Type::kLength, "the radius of every circle", {}, {}, -1, true}};
constexpr Key kTextKeys[] = {
    {"text", Type::kString, "what to write", {}, {}, -1, true},
    {"height", Type::kLength, "height of capital letters, before the active scale", {}, "1m"}};

constexpr Example kPointExamples[] = {{"place point xy=1,2,3", "last.bbox.max.z == 3m"},
                                      {"place point xy=1e300,0,0", "E0212"}};
constexpr Example kLineExamples[] = {{"place line xy=0,0,0 dl=10", "last.length == 10m"},
                                     {"place line xy=0,0,0 dl=3 dl=0,4 as path", "len(path) == 2"},
                                     {"place line xy=1,1,0 dl=0,0", "E0501"}};
constexpr Example kArcExamples[] = {
    {"place arc xy=10,0,0 xy=15,0,5 xy=20,0,0", "last.bbox.max.z within 5m +- 0.000001m"},
    {"place arc xy=0,0,0 xy=1,0,0 xy=2,0,0", "E0501"}};
constexpr Example kArcEdgeExamples[] = {
    {"place arc edge xy=-1,0,0 xy=0,1,0 xy=1,0,0", "last.length within 3.14159265m +- 0.00000001m"},
    {"place arc edge xy=0,0,0 xy=0,0,0 xy=2,0,0", "E0501"}};
constexpr Example kArcCentreExamples[] = {
    {"place arc center xy=5,0,0 xy=0,0,0 xy=0,7,0", "last.bbox.max.y within 5m +- 0.000001m"},
    {"place arc center xy=1,0,0 xy=0,0,0 angle=180",
     "last.length within 3.14159265m +- 0.00000001m"},
    {"place arc center xy=5,0,0 xy=5,0,0 xy=0,7,0", "E0501"}};
constexpr Example kCircleExamples[] = {
    {"place circle xy=0,0,0 xy=3,4,0", "last.bbox.max.x within 5m +- 0.000001m"},
    {"place circle xy=0,0,0 radius=2", "last.area within 12.56637m2 +- 0.00001m2"},
    {"place circle xy=0,0,0 radius=0", "E0501"}};
constexpr Example kCircleCentreExamples[] = {
    {"place circle center xy=0,0 radius=3", "last.bbox.max.y within 3m +- 0.000001m"},
    {"place circle center xy=0,0,0 xy=1,0,1", "E0504"}};
constexpr Example kCircleRadiusExamples[] = {
    {"place circle radius radius=1m xy=0,0,0 xy=5,0,0 as columns", "len(columns) == 2"},
    {"place circle radius radius=-1m xy=0,0,0", "E0501"}};
constexpr Example kCircleEdgeExamples[] = {
    {"place circle edge xy=1,0,0 xy=0,1,0 xy=-1,0,0", "last.bbox.min.y within -1m +- 0.000001m"},
    {"place circle edge xy=0,0,0 xy=1,0,0 xy=5,0,0", "E0501"}};
constexpr Example kBlockExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0", "last.area within 12m2 +- 0.000001m2"},
    {"set plane front; place block xy=0,0,0 xy=4,0,3", "last.bbox.max.z == 3m"},
    {"place block xy=0,0,0 xy=4,0,3", "E0501"}};
constexpr Example kShapeExamples[] = {
    {"place shape xy=0,0,0 dl=4 dl=0,3 reset", "last.area within 6m2 +- 0.000001m2"},
    {"place shape xy=0,0,0 xy=4,0,0 xy=4,3,0 xy=0,3,1 reset", "E0504"}};
constexpr Example kTextExamples[] = {
    {"place text \"nave\" height=0.5m xy=2,1,0", "last.height == 0.5m"},
    {"place text text=\"nave\" xy=2,1,0", "last.text == \"nave\""},
    {"place text xy=0,0,0", "E0220"}};

constexpr Command kCommands[] = {
    {.words = "place point",
     .family = "place",
     .summary = "A point at each data point: a survey mark, a spot height, an anchor for snapping.",
     .manner = Manner::kPlaces,
     .prompts = kPointPrompts,
     .examples = kPointExamples,
     .execute = PlacePoint},
    {.words = "place line",
     .family = "place",
     .summary =
         "Straight lines from point to point, one element for each, going on from the last end.",
     .manner = Manner::kPlaces,
     .prompts = kLinePrompts,
     .again = 1,
     .carries = true,
     .examples = kLineExamples,
     .execute = PlaceLine},
    {.words = "place arc",
     .family = "place",
     .summary = "A circular arc from its start through a point on it to its end.",
     .manner = Manner::kPlaces,
     .prompts = kArcEdgePrompts,
     .examples = kArcExamples,
     .execute = PlaceArcEdge},
    {.words = "place arc edge",
     .family = "place",
     .summary = "A circular arc from its start through a point on it to its end.",
     .manner = Manner::kPlaces,
     .prompts = kArcEdgePrompts,
     .examples = kArcEdgeExamples,
     .execute = PlaceArcEdge},
    {.words = "place arc center",
     .family = "place",
     .summary =
         "A circular arc from its start about its centre, anticlockwise in the active plane, to "
         "the direction of a third point or through an angle.",
     .manner = Manner::kPlaces,
     .prompts = kArcCentrePrompts,
     .keys = kArcCentreKeys,
     .examples = kArcCentreExamples,
     .execute = PlaceArcCentre},
    {.words = "place circle",
     .family = "place",
     .summary =
         "A circle in the active plane by its centre and a point on its edge, or its radius.",
     .manner = Manner::kPlaces,
     .prompts = kCirclePrompts,
     .keys = kCircleKeys,
     .examples = kCircleExamples,
     .execute = PlaceCircleCentre},
    {.words = "place circle center",
     .family = "place",
     .summary =
         "A circle in the active plane by its centre and a point on its edge, or its radius.",
     .manner = Manner::kPlaces,
     .prompts = kCirclePrompts,
     .keys = kCircleKeys,
     .examples = kCircleCentreExamples,
     .execute = PlaceCircleCentre},
    {.words = "place circle edge",
     .family = "place",
     .summary = "A circle through three points, in the plane that they span.",
     .manner = Manner::kPlaces,
     .prompts = kCircleEdgePrompts,
     .examples = kCircleEdgeExamples,
     .execute = PlaceCircleEdge},
    {.words = "place circle radius",
     .family = "place",
     .summary = "Circles of one radius in the active plane, one about each data point.",
     .manner = Manner::kPlaces,
     .prompts = kCircleRadiusPrompts,
     .keys = kCircleRadiusKeys,
     .examples = kCircleRadiusExamples,
     .execute = PlaceCircleRadius},
    {.words = "place block",
     .family = "place",
     .summary =
         "A rectangle between two opposite corners, its sides along the active plane's axes.",
     .manner = Manner::kPlaces,
     .prompts = kBlockPrompts,
     .examples = kBlockExamples,
     .execute = PlaceBlock},
    {.words = "place shape",
     .family = "place",
     .summary =
         "A closed outline with a corner at each data point; the last side closes by itself.",
     .manner = Manner::kGathers,
     .prompts = kShapePrompts,
     .least = 3,
     .examples = kShapeExamples,
     .execute = PlaceShape},
    {.words = "place text",
     .family = "place",
     .summary =
         "Lettering in the active plane, turned by the active angle and sized by the active scale.",
     .manner = Manner::kPlaces,
     .prompts = kTextPrompts,
     .keys = kTextKeys,
     .string_key = "text",
     .examples = kTextExamples,
     .execute = PlaceText},
};

}  // namespace

std::span<const Command> PlaceCommands() { return kCommands; }

}  // namespace tranos::interp
