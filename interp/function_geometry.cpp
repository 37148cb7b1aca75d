// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of elements.
#include <cmath>

#include "geom/crossing.h"
#include "interp/value_support.h"
#include "model/facades.h"

namespace tranos::interp {

using model::Value;

namespace {

Value Area(const CallContext& context, Arguments a) {
  return Value::Number(AreaOf(*ElementArgument(context, a, 0)), model::kArea);
}
Value Volume(const CallContext& context, Arguments a) {
  return Value::Number(VolumeOf(*ElementArgument(context, a, 0)), model::kVolume);
}

Value VolumeUnderZ(const CallContext& context, Arguments a) {
  const model::ElementPtr element = ElementArgument(context, a, 0);
  double z_m = 0;
  if (a.size() > 1) z_m = Convert(a[1], Type::kLength, *context.arithmetic.unit, "z").number();
  return Value::Number(VolumeUnder(*element, z_m), model::kVolume);
}

const geom::Curve& CurveArgument(const model::ElementPtr& element, int index) {
  if (const geom::Curve* curve = CurveOf(*element)) return *curve;
  throw OpFailure{Code::kWrongElement,
                  WithArticle(model::TypeOf(*element)) + " has no intersections",
                  "expected a curve", "", index};
}

// Where two lines lie nearest to one another, if they are not parallel.
OpFailure NoCommonPoint(const geom::Line& a, const geom::Line& b, const Unit& unit) {
  const geom::Vec3 u = a.end - a.start, v = b.end - b.start, w = b.start - a.start;
  const geom::Vec3 normal = u.cross(v);
  if (normal.norm() <= 1e-12 * u.norm() * v.norm()) {
    return {Code::kDoNotMeet, "the lines are parallel, and do not meet"};
  }
  const geom::Vec3 on_a = a.start + w.cross(v).dot(normal) / normal.squaredNorm() * u;
  const geom::Vec3 on_b = b.start + w.cross(u).dot(normal) / normal.squaredNorm() * v;
  const double gap_m = (on_a - on_b).norm();
  if (gap_m > 1e-6) {
    return {Code::kDoNotMeet, "the lines pass one another at " +
                                  Format(Value::Number(gap_m, model::kLength), unit, -1)};
  }
  return {Code::kDoNotMeet, "the lines do not meet within their lengths", "",
          "made longer, they would meet at " + Format(Value::OfPoint(on_a), unit, -1)};
}

Value Intersection(const CallContext& context, Arguments a) {
  const model::ElementPtr first = ElementArgument(context, a, 0);
  const model::ElementPtr second = ElementArgument(context, a, 1);
  const geom::Curve& p = CurveArgument(first, 0);
  const geom::Curve& q = CurveArgument(second, 1);
  context.charge_items(geom::CountPieces(p) * geom::CountPieces(q));
  const std::vector<geom::Crossing> points = geom::Crossings(p, q);
  const auto* line = std::get_if<geom::Line>(&p);
  const auto* other = std::get_if<geom::Line>(&q);
  if (line && other) {
    if (points.empty()) throw NoCommonPoint(*line, *other, *context.arithmetic.unit);
    return Value::OfPoint(points[0].point);
  }
  context.charge_items(points.size());
  std::vector<Value> items;
  for (const geom::Crossing& point : points) items.push_back(Value::OfPoint(point.point));
  return Value::List(std::move(items));
}

Value Project(const CallContext& context, Arguments a) {
  const geom::Vec3 p = PointOf(Convert(a[0], Type::kPoint, *context.arithmetic.unit, "p"));
  if (a[1].kind() == Value::Kind::kPlane) {
    const geom::Vec3 normal = a[1].plane().z();
    return Value::OfPoint(p - normal.dot(p - a[1].plane().origin) * normal);
  }
  if (!a[1].is_element()) FailArgument(a, 1, "a plane or an element");
  const model::ElementPtr element = ElementArgument(context, a, 1);
  const geom::Curve* curve = CurveOf(*element);
  const auto* line = curve ? std::get_if<geom::Line>(curve) : nullptr;
  if (!line) return Value::OfPoint(model::NearestPoint(*element, p).point);
  const geom::Vec3 along = line->end - line->start;
  return Value::OfPoint(line->start + along.dot(p - line->start) / along.squaredNorm() * along);
}

Value Facade(const CallContext& context, Arguments a) {
  if (!a[0].is_string()) FailArgument(a, 0, "a facade's name");
  if (const auto found = model::FindFacade(context.state->model, a[0].string())) {
    return Value::OfElement(found);
  }
  const auto meant = DidYouMean(a[0].string(), model::FacadeNames(context.state->model));
  throw OpFailure{Code::kNoFacade, "no facade is called " + Shown(a[0]), "",
                  meant ? "did you mean `" + *meant + "`?" : "", 0};
}

constexpr Builtin kGeometry[] = {
    {"area(e)", "the area of a face or of a closed planar curve", 1, 1, Area},
    {"volume(e)", "the volume of a closed body", 1, 1, Volume},
    {"volume_under(s, z)", "the integral of the height above z over the plan of a surface", 1, 2,
     VolumeUnderZ},
    {"intersection(a, b)", "where two lines meet; for other curves, the list of common points", 2,
     2, Intersection},
    {"project(p, onto)",
     "the foot of a point on a line or a plane; else the nearest point of an element", 2, 2,
     Project},
    {"facade(name)", "the facade that commands know by this name", 1, 1, Facade},
};

}  // namespace

std::span<const Builtin> GeometryFunctions() { return kGeometry; }

}  // namespace tranos::interp
