// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of points and directions.
#include <algorithm>
#include <cmath>
#include <optional>

#include "interp/value_support.h"

namespace tranos::interp {

using model::Value;

namespace {

Value Product(const CallContext& context, const Value& a, const Value& b) {
  return Binary(Op::kMultiply, a, b, context.arithmetic);
}
Value Add(const CallContext& context, const Value& a, const Value& b) {
  return Binary(Op::kAdd, a, b, context.arithmetic);
}

Value DotOf(const CallContext& context, const std::vector<Value>& a, const std::vector<Value>& b) {
  Value sum = Product(context, a[0], b[0]);
  for (std::size_t i = 1; i < 3; ++i) sum = Add(context, sum, Product(context, a[i], b[i]));
  return sum;
}

std::vector<Value> CrossOf(const CallContext& context, const std::vector<Value>& a,
                           const std::vector<Value>& b) {
  std::vector<Value> cross;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    cross.push_back(Binary(Op::kSubtract, Product(context, a[j], b[k]),
                           Product(context, a[k], b[j]), context.arithmetic));
  }
  return cross;
}

Value Dot(const CallContext& context, Arguments a) {
  return DotOf(context, VectorArgument(context, a, 0), VectorArgument(context, a, 1));
}

Value Cross(const CallContext& context, Arguments a) {
  return Value::List(
      CrossOf(context, VectorArgument(context, a, 0), VectorArgument(context, a, 1)));
}

Value Length(const CallContext& context, Arguments a) {
  if (a[0].is_element()) {
    return Value::Number(LengthOf(*ElementArgument(context, a, 0)), model::kLength);
  }
  return Norm(VectorArgument(context, a, 0));
}

Value Normalize(const CallContext& context, Arguments a) {
  std::vector<Value> items = VectorArgument(context, a, 0);
  const Value norm = Norm(items);
  if (norm.number() == 0) throw OpFailure{Code::kNotFinite, "a direction of no length", "", "", 0};
  for (Value& item : items) item = Binary(Op::kDivide, item, norm, context.arithmetic);
  items.resize(a[0].list().size());
  return Value::List(std::move(items));
}

// The plane or facade among the arguments; null if it is another value.
std::optional<geom::Frame> PlaneArgument(const CallContext& context, Arguments a, int index) {
  const Value& value = a[static_cast<std::size_t>(index)];
  if (value.kind() == Value::Kind::kPlane) return value.plane();
  if (!value.is_element()) return std::nullopt;
  const model::ElementPtr element = ElementArgument(context, a, index);
  const auto* facade = std::get_if<model::FacadePtr>(&element->geometry);
  if (!facade) return std::nullopt;
  return (*facade)->plane;
}

// A direction, that of a straight element, or the normal of a plane.
std::vector<Value> DirectionArgument(const CallContext& context, Arguments a, int index) {
  if (const auto plane = PlaneArgument(context, a, index)) return Value::OfPoint(plane->z()).list();
  if (!a[static_cast<std::size_t>(index)].is_element()) return VectorArgument(context, a, index);
  const model::ElementPtr element = ElementArgument(context, a, index);
  const geom::Curve* curve = CurveOf(*element);
  const auto* line = curve ? std::get_if<geom::Line>(curve) : nullptr;
  if (!line) {
    throw OpFailure{Code::kWrongElement,
                    WithArticle(model::TypeOf(*element)) + " has no one direction",
                    "expected a line", "", index};
  }
  return Value::OfPoint(line->end - line->start).list();
}

// By sine and cosine together: neither alone tells angles near 0 and near a right angle well.
Value AngleOfDirections(const CallContext& context, Arguments a) {
  const std::vector<Value> u = DirectionArgument(context, a, 0),
                           v = DirectionArgument(context, a, 1);
  const Value nu = Norm(u), nv = Norm(v);
  if (nu.number() == 0 || nv.number() == 0) {
    throw OpFailure{Code::kNotFinite, "a direction of no length", "", "", nu.number() == 0 ? 0 : 1};
  }
  geom::Vec3 x, y;
  for (int i = 0; i < 3; ++i) {
    x[i] = u[static_cast<std::size_t>(i)].number() / nu.number();
    y[i] = v[static_cast<std::size_t>(i)].number() / nv.number();
  }
  const double sine = x.cross(y).norm(), cosine = x.dot(y);
  std::vector<Term> terms;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    terms.push_back({&u[at], (x[i] * cosine - y[i]) / sine / nu.number()});
    terms.push_back({&v[at], (y[i] * cosine - x[i]) / sine / nv.number()});
  }
  return Combine(ArcTangent(sine, cosine), model::kAngle, terms);
}

// Planes have two sides: what is told of them is at most a right angle.
Value Angle(const CallContext& context, Arguments a) {
  const Value angle = AngleOfDirections(context, a);
  const int planes = static_cast<int>(PlaneArgument(context, a, 0).has_value()) +
                     static_cast<int>(PlaneArgument(context, a, 1).has_value());
  if (planes == 0) return angle;
  const double acute_rad = std::min(angle.number(), geom::kPi - angle.number());
  const double slope = angle.number() > geom::kPi / 2 ? -1 : 1;
  if (planes == 2) return Combine(acute_rad, model::kAngle, {{&angle, slope}});
  return Combine(geom::kPi / 2 - acute_rad, model::kAngle, {{&angle, -slope}});
}

std::vector<Value> PointArgument(const CallContext& context, Arguments a, int index) {
  const Value& value = a[static_cast<std::size_t>(index)];
  if (!IsVector(value)) FailArgument(a, index, "a point or an element");
  std::vector<Value> items = value.list();
  for (Value& item : items) {
    item = ReadBare(item, model::kLength, *context.arithmetic.unit);
    if (item.dimension() != model::kLength) FailArgument(a, index, "a point or an element");
  }
  if (items.size() == 2) items.push_back(Value::Number(0, model::kLength));
  return items;
}

Value Distance(const CallContext& context, Arguments a) {
  const bool first = a[0].is_element(), second = a[1].is_element();
  if (first && second) {
    return Value::Number(
        DistanceBetween(context, *ElementArgument(context, a, 0), *ElementArgument(context, a, 1)),
        model::kLength);
  }
  if (first || second) {
    const int of_element = first ? 0 : 1;
    const std::vector<Value> point = PointArgument(context, a, 1 - of_element);
    const model::ElementPtr element = ElementArgument(context, a, of_element);
    const geom::Vec3 p(point[0].number(), point[1].number(), point[2].number());
    const geom::Nearest nearest = model::NearestPoint(*element, p);
    std::vector<Term> terms;
    for (int i = 0; i < 3; ++i) {
      terms.push_back(
          {&point[static_cast<std::size_t>(i)], (p - nearest.point)[i] / nearest.distance_m});
    }
    return Combine(nearest.distance_m, model::kLength, terms);
  }
  const std::vector<Value> p = PointArgument(context, a, 0), q = PointArgument(context, a, 1);
  std::vector<Value> difference;
  for (std::size_t i = 0; i < 3; ++i) {
    difference.push_back(Binary(Op::kSubtract, p[i], q[i], context.arithmetic));
  }
  return Norm(difference);
}

constexpr Builtin kVector[] = {
    {"dot(a, b)", "the scalar product of two vectors", 2, 2, Dot},
    {"cross(a, b)", "the vector product of two vectors", 2, 2, Cross},
    {"length(v)", "the length of a vector or of an element", 1, 1, Length},
    {"normalize(v)", "the direction of a vector, as plain numbers", 1, 1, Normalize},
    {"angle(a, b)",
     "the angle between two directions or lines, from 0 to 180deg; with a plane or facade, to "
     "90deg",
     2, 2, Angle},
    {"distance(a, b)", "between the nearest points of two points or elements; a facade is a plane",
     2, 2, Distance},
};

}  // namespace

std::span<const Builtin> VectorFunctions() { return kVector; }

}  // namespace tranos::interp
