// SPDX-License-Identifier: GPL-3.0-or-later
// place: ellipses, polygons, smooth curves and arcs that go on from a curve.
#include <fmt/format.h>

#include <cmath>

#include "geom/construction.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

using geom::Frame;
using geom::Vec3;
using model::State;

namespace {

constexpr int kMostSides = 1000;

tl::expected<Frame, CommandError> EllipseFrame(const State& state, const Answers& answers,
                                               double* first_m) {
  Frame frame = PlaneAt(state, answers.points[0]);
  const Vec3 end = frame.ToLocal(answers.points[1]);
  if (std::abs(end.z()) > kOffPlane_m) return Fail(OffPlane(state, end.z(), 1));
  *first_m = std::hypot(end.x(), end.y());
  if (*first_m <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "an ellipse with a half axis of no length",
                 .label = "the centre lies here, too",
                 .where = AtPoint(1)});
  }
  const Vec3 x = (end.x() * frame.x + end.y() * frame.y) / *first_m;
  return Frame{frame.origin, x, frame.z().cross(x)};
}

CommandResult PlaceEllipse(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  double first_m = 0;
  const auto frame = EllipseFrame(state, answers, &first_m);
  if (!frame) return Fail(frame.error());
  const Vec3 end = frame->ToLocal(answers.points[2]);
  if (answers.answered[2] && std::abs(end.z()) > kOffPlane_m) {
    return Fail(OffPlane(state, end.z(), 2));
  }
  const double second_m = answers.answered[2] ? std::abs(end.y()) : answers.Number("axis");
  if (second_m <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "an ellipse needs a second half axis above zero",
                 .label = answers.answered[2] ? "this lies in line with the first half axis" : "",
                 .where = answers.answered[2] ? AtPoint(2) : AtKey("axis")});
  }
  return Make(state, CurveGeometry(geom::Ellipse(*frame, first_m, second_m)));
}

// The frame of the polygon, x towards the data point or along the active angle, and how far the
// point lies from the centre.
tl::expected<Frame, CommandError> PolygonFrame(const State& state, const Answers& answers,
                                               double* reach_m) {
  const Frame plane = PlaneAt(state, answers.points[0]);
  const double angle_rad = state.drawing.settings->angle_rad;
  Vec3 towards = {std::cos(angle_rad), std::sin(angle_rad), 0};
  *reach_m = answers.Number("radius");
  if (answers.answered[1]) {
    towards = plane.ToLocal(answers.points[1]);
    if (std::abs(towards.z()) > kOffPlane_m) return Fail(OffPlane(state, towards.z(), 1));
    *reach_m = std::hypot(towards.x(), towards.y());
  }
  if (*reach_m <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "a polygon needs a radius above zero",
                 .where = answers.answered[1] ? AtPoint(1) : AtKey("radius")});
  }
  const double length = std::hypot(towards.x(), towards.y());
  const Vec3 x = (towards.x() * plane.x + towards.y() * plane.y) / length;
  return Frame{plane.origin, x, plane.z().cross(x)};
}

CommandResult PlacePolygon(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const double sides = answers.Number("sides");
  if (sides < 3 || sides > kMostSides) {
    return Fail({.code = Code::kOutOfRange,
                 .message = fmt::format("a polygon has 3 to {} sides", kMostSides),
                 .where = AtKey("sides")});
  }
  if (answers.words.size() > 1) {
    return Fail({.code = Code::kWrongWords,
                 .message = "a polygon is inscribed or circumscribed, not both"});
  }
  double reach_m = 0;
  auto frame = PolygonFrame(state, answers, &reach_m);
  if (!frame) return Fail(frame.error());
  if (answers.HasWord("circumscribed")) {  // the point is the middle of a side
    const double half_rad = geom::kPi / sides;
    const double c = std::cos(half_rad), s = std::sin(half_rad);
    reach_m /= c;
    frame = Frame{frame->origin, c * frame->x - s * frame->y, s * frame->x + c * frame->y};
  }
  return Make(state, CurveGeometry(geom::RegularPolygon(*frame, reach_m, static_cast<int>(sides))));
}

CommandResult PlaceCurve(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const bool poles = answers.HasWord("poles"), closed = answers.HasWord("closed");
  if (poles && answers.HasWord("through")) {
    return Fail({.code = Code::kWrongWords,
                 .message = "a curve runs through its points, or has them as its poles"});
  }
  if (!poles && answers.Has("degree")) {
    return Fail({.code = Code::kWrongWords,
                 .message = "a curve through points is cubic",
                 .help = "`place curve poles degree=2` takes a degree",
                 .where = AtKey("degree")});
  }
  std::vector<Vec3> points = answers.points;
  // A last point on the first one closes the curve by hand, as it is closed anyway.
  if (closed && (points.back() - points.front()).norm() <= geom::kCoincident_m) points.pop_back();
  const int degree = static_cast<int>(std::min(answers.Number("degree", 3), 1e6));
  auto curve =
      poles ? geom::CurveByPoles(points, degree, closed) : geom::CurveThrough(points, closed);
  if (!curve) {
    const bool bad_degree = curve.error().code == geom::ErrorCode::kOutOfRange;
    const Where where = bad_degree ? AtKey("degree") : AtPoint(std::max(curve.error().part, 0));
    return Fail(FromGeom(curve.error(), "a curve", where));
  }
  return Make(state, CurveGeometry(*std::move(curve)));
}

// Where a curve ends and the direction in which it would go on from there.
struct CurveEnd {
  Vec3 point, onward;
};

CurveEnd EndOf(const geom::Curve& curve, bool at_start) {
  const double t = at_start ? 0 : 1;
  return {geom::PointAt(curve, t), (at_start ? -1 : 1) * geom::TangentAt(curve, t)};
}

// The end of a visible curve nearest to the point, within the locate tolerance; of equally near
// ones that of the curve made last.
std::optional<CurveEnd> EndNear(const State& state, const Vec3& p) {
  double nearest_m = state.drawing.settings->locate_tolerance_m;
  std::optional<CurveEnd> found;
  state.model.ForEach([&](const model::ElementPtr& element) {
    model::ForEachLeaf(*element, [&](const model::Element& leaf, const geom::Affine& world,
                                     const model::Attributes& attributes) {
      const auto* curve = std::get_if<model::CurvePtr>(&leaf.geometry);
      if (!curve || geom::IsClosed(**curve) || !state.model.LevelIsOn(attributes.level)) return;
      const geom::Curve placed = geom::Transformed(**curve, world);
      for (const bool at_start : {true, false}) {
        const CurveEnd end = EndOf(placed, at_start);
        const double distance_m = (end.point - p).norm();
        if (distance_m > nearest_m) continue;
        nearest_m = distance_m;
        found = end;
      }
    });
  });
  return found;
}

CommandResult PlaceArcTangent(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto start = EndNear(state, answers.points[0]);
  if (!start) {
    return Fail({.code = Code::kNothingThere,
                 .message = "no curve ends here",
                 .help = "give the end exactly, as `xy=NAME.end`",
                 .where = AtPoint(0)});
  }
  auto arc = geom::TangentArc(start->point, start->onward, answers.points[1]);
  if (!arc) return Fail(FromGeom(arc.error(), "an arc", AtPoint(1)));
  return Make(state, CurveGeometry(*std::move(arc)));
}

constexpr Prompt kEllipsePrompts[] = {
    {"centre"}, {"end of the first half axis"}, {"end of the second half axis"}};
constexpr Prompt kPolygonPrompts[] = {{"centre"}, {"corner"}};
constexpr Prompt kCurvePrompts[] = {{"point"}};
constexpr Prompt kTangentPrompts[] = {{"end of a curve"}, {"end of the arc"}};

constexpr Key kEllipseKeys[] = {
    {"axis", Type::kLength, "length of the second half axis", {}, {}, 2}};
constexpr Key kPolygonKeys[] = {
    {"sides", Type::kCount, "how many sides, 3 to 1000", {}, {}, -1, true},
    {"radius",
     Type::kLength,
     "from the centre to the corners, or to the sides if circumscribed; along the active angle",
     {},
     {},
     1}};
constexpr Key kCurveKeys[] = {{"degree", Type::kCount, "of a curve by poles, 1 to 24", {}, "3"}};

constexpr Example kEllipseExamples[] = {
    {"place ellipse xy=0,0,0 xy=5,0,0 xy=0,3,0", "last.area within 47.1238898m2 +- 0.0000001m2"},
    {"set plane front; place ellipse axis=2 xy=0,0,0 xy=0,0,4",
     "last.bbox.max.x within 2m +- 0.000001m"},
    {"place ellipse xy=0,0,0 xy=5,0,0 xy=3,0,0", "E0501"},
    {"place ellipse axis=-1 xy=0,0,0 xy=5,0,0", "E0501"}};
constexpr Example kPolygonExamples[] = {
    {"place polygon sides=6 xy=0,0,0 xy=2,0,0", "last.length within 12m +- 0.000001m"},
    {"place polygon circumscribed sides=4 radius=1 xy=0,0,0", "last.area within 4m2 +- 0.000001m2"},
    {"place polygon sides=2 xy=0,0,0 xy=2,0,0", "E0212"},
    {"place polygon sides=8 radius=0 xy=0,0,0", "E0501"}};
constexpr Example kCurveExamples[] = {
    {"place curve xy=0,0,0 xy=2,1,0 xy=4,0,0 reset", "last.mid.y within 1m +- 0.000001m"},
    {"place curve poles degree=2 xy=0,0,0 xy=2,2,0 xy=4,0,0 reset",
     "last.bbox.max.y within 1m +- 0.000001m"},
    {"place curve closed xy=1,0,0 xy=0,1,0 xy=-1,0,0 xy=0,-1,0 reset", "last.closed"},
    {"place curve xy=0,0,0 xy=0,0,0 xy=1,0,0 reset", "E0501"},
    {"place curve poles degree=25 xy=0,0,0 xy=1,0,0 reset", "E0212"}};
constexpr Example kTangentExamples[] = {
    {"place line xy=0,0,0 xy=4,0,0; place arc tangent xy=4,0,0 xy=4,2,0",
     "last.length within 3.14159265m +- 0.00000001m"},
    {"place line xy=0,0,0 xy=4,0,0 as sill; place arc tangent xy=sill.end xy=6,2,0 xy=6,6,0",
     "last.start.x within 6m +- 0.000001m"},
    {"place arc tangent xy=4,0,0 xy=4,2,0", "E0405"},
    {"place line xy=0,0,0 xy=4,0,0; place arc tangent xy=4,0,0 xy=2,0,0", "E0501"}};

constexpr Command kCommands[] = {
    {.words = "place arc tangent",
     .family = "place",
     .summary =
         "A circular arc that goes on smoothly from the end of a curve to a point, then the next "
         "from its end; a line where the point lies straight ahead.",
     .manner = Manner::kPlaces,
     .prompts = kTangentPrompts,
     .again = 1,
     .carries = true,
     .examples = kTangentExamples,
     .execute = PlaceArcTangent},
    {.words = "place ellipse",
     .family = "place",
     .summary =
         "An ellipse in the active plane by its centre, the end of one half axis, and how far it "
         "reaches to the side, by a point or a length.",
     .manner = Manner::kPlaces,
     .prompts = kEllipsePrompts,
     .keys = kEllipseKeys,
     .examples = kEllipseExamples,
     .execute = PlaceEllipse},
    {.words = "place polygon",
     .family = "place",
     .summary =
         "A regular polygon in the active plane by its centre and a corner; circumscribed, by "
         "the middle of a side.",
     .manner = Manner::kPlaces,
     .prompts = kPolygonPrompts,
     .keys = kPolygonKeys,
     .options = "inscribed|circumscribed",
     .examples = kPolygonExamples,
     .execute = PlacePolygon},
    {.words = "place curve",
     .family = "place",
     .summary =
         "A smooth curve through its points, or with them as poles, which draw it without being "
         "on it; open or closed.",
     .manner = Manner::kGathers,
     .prompts = kCurvePrompts,
     .least = 2,
     .keys = kCurveKeys,
     .options = "through|poles|closed",
     .examples = kCurveExamples,
     .execute = PlaceCurve},
};

}  // namespace

std::span<const Command> PlaceCurveCommands() { return kCommands; }

}  // namespace tranos::interp
