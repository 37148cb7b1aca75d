// SPDX-License-Identifier: GPL-3.0-or-later
// Members of elements: parameters, parts and interfaces of a placed one, names of a group, snaps
// and measures.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geom/mesh_row.h"
#include "interp/camera_report.h"
#include "interp/differences.h"
#include "interp/value_support.h"
#include "model/covariance.h"

namespace tranos::interp {

using model::Element;
using model::ElementPtr;
using model::Value;

namespace {

Value Length(double length_m) { return Value::Number(length_m, model::kLength); }

Value Direction(const geom::Vec3& unit) {
  return Value::List({Value::Number(unit.x()), Value::Number(unit.y()), Value::Number(unit.z())});
}

Value BoxValue(const Element& element) {
  const geom::Box box = model::BoundingBox(element);
  if (box.empty())
    throw OpFailure{Code::kWrongElement, "an empty " + model::TypeOf(element) + " has no box"};
  if (!box.min.allFinite() || !box.max.allFinite()) {
    throw OpFailure{Code::kNotFinite, "the bounding box is not finite"};
  }
  return Value::OfRecord({"bounding box",
                          {{"min", Value::OfPoint(box.min)},
                           {"max", Value::OfPoint(box.max)},
                           {"size", Value::OfPoint(box.max - box.min)},
                           {"centre", Value::OfPoint(box.centre())}}});
}

Value ColourValue(const Element& element) {
  const model::Colour colour = element.attributes->colour;
  if (colour.code >= model::Colour::kRgb) return Value::String(model::Describe(colour));
  return Value::Number(colour.code);
}

// What every element has.
using Reader = Value (*)(const Element&);
struct Row {
  std::string_view name;
  Reader read;
  bool measures_solids = false;
};
constexpr Row kMeasures[] = {
    {"length", [](const Element& e) { return Length(LengthOf(e)); }},
    {"area", [](const Element& e) { return Value::Number(AreaOf(e), model::kArea); }, true},
    {"volume", [](const Element& e) { return Value::Number(VolumeOf(e), model::kVolume); }, true},
    {"filled_volume",
     [](const Element& e) { return Value::Number(FilledVolumeOf(e), model::kVolume); }, true},
    {"bbox", BoxValue, true},
    {"name", [](const Element& e) { return Value::String(std::string(e.name_or_empty())); }},
    {"type", [](const Element& e) { return Value::String(model::TypeOf(e)); }},
    {"level", [](const Element& e) { return Value::String(e.attributes->level); }},
    {"colour", ColourValue},
    {"color", ColourValue},
    {"linestyle", [](const Element& e) { return Value::Number(e.attributes->linestyle); }},
    {"weight", [](const Element& e) { return Value::Number(e.attributes->weight); }},
    {"material", [](const Element& e) { return Value::String(e.attributes->material); }},
    {"evidence",
     [](const Element& e) { return Value::String(std::string(WordOf(e.attributes->evidence))); }},
    {"source", [](const Element& e) { return Value::String(e.attributes->source); }},
};

// Snaps of a curve; nothing where this one has no such member.
std::optional<Value> CurveMember(const CallContext& context, const geom::Curve& curve,
                                 std::string_view name) {
  const auto* arc = std::get_if<geom::Arc>(&curve);
  const auto* circle = std::get_if<geom::Circle>(&curve);
  if (name == "start") return Value::OfPoint(geom::PointAt(curve, 0));
  if (name == "end") return Value::OfPoint(geom::PointAt(curve, 1));
  if (name == "mid") return Value::OfPoint(geom::PointAtFraction(curve, 0.5));
  if (name == "closed") return Value::Boolean(geom::IsClosed(curve));
  if (arc || circle) {
    if (name == "centre") return Value::OfPoint(arc ? arc->frame.origin : circle->frame.origin);
    if (name == "radius") return Length(arc ? arc->radius : circle->radius);
    if (name == "sweep") return Value::Number(arc ? arc->sweep_rad : 2 * geom::kPi, model::kAngle);
  }
  if (name == "centre" || name == "centroid") {
    const geom::Result<geom::Vec3> centroid = geom::Centroid(curve);
    if (!centroid)
      throw FromGeomError(centroid.error(), "the curve has no `" + std::string(name) + "`");
    return Value::OfPoint(*centroid);
  }
  if (name == "plane") {
    // A round curve's plane is its own system: the centre is the origin.
    if (arc || circle) return Value::Plane(arc ? arc->frame : circle->frame);
    const std::optional<geom::Frame> plane = geom::PlaneOf(curve);
    if (!plane) throw OpFailure{Code::kNotPlanar, "the curve lies in no one plane"};
    return Value::Plane(*plane);
  }
  if (const auto* line = std::get_if<geom::Line>(&curve); line && name == "direction") {
    return Direction((line->end - line->start).normalized());
  }
  if (const auto* polyline = std::get_if<geom::Polyline>(&curve); polyline && name == "vertices") {
    context.charge_items(polyline->vertices.size());
    std::vector<Value> points;
    for (const geom::Vec3& vertex : polyline->vertices) points.push_back(Value::OfPoint(vertex));
    return Value::List(std::move(points));
  }
  return std::nullopt;
}

std::vector<std::string> CurveMembers(const geom::Curve& curve) {
  std::vector<std::string> names = {"start", "end", "mid", "at(fraction)", "closed"};
  const bool round =
      std::holds_alternative<geom::Arc>(curve) || std::holds_alternative<geom::Circle>(curve);
  if (round) names.insert(names.end(), {"centre", "radius", "sweep"});
  if (!round && geom::IsClosed(curve)) names.insert(names.end(), {"centre", "centroid"});
  if (!std::holds_alternative<geom::Line>(curve)) names.emplace_back("plane");
  if (std::holds_alternative<geom::Line>(curve)) names.emplace_back("direction");
  if (std::holds_alternative<geom::Polyline>(curve)) names.emplace_back("vertices");
  return names;
}

constexpr std::string_view kSolidMembers[] = {"centroid", "closed", "genus",
                                              "faces",    "shells", "self_intersects"};

bool HasSolids(const Element& element) {
  bool has_any = false;
  model::ForEachLeaf(element,
                     [&](const Element& leaf, const geom::Affine&, const model::Attributes&) {
                       has_any |= SolidOf(leaf) != nullptr;
                     });
  return has_any;
}

// The facets of all solids of an element, those of each by themselves.
geom::TriangleMesh FacetsOf(const Element& element) {
  geom::MeshRow row;
  model::ForEachLeaf(element, [&](const Element& leaf, const geom::Affine& world_from_leaf,
                                  const model::Attributes&) {
    const geom::Solid* solid = SolidOf(leaf);
    if (solid) row.Append(geom::Transformed(**solid->Facets(), world_from_leaf));
  });
  return row.Take();
}

// Of each solid by itself: parts may touch.
bool AnyIntersectsItself(const Element& element) {
  bool any = false;
  model::ForEachLeaf(element,
                     [&](const Element& leaf, const geom::Affine&, const model::Attributes&) {
                       const geom::Solid* solid = SolidOf(leaf);
                       any = any || (solid && geom::HasSelfIntersection(**solid->Facets()));
                     });
  return any;
}

// What is measured on the facets of an element's solids; nothing where it has no such member.
std::optional<Value> SolidMember(const CallContext& context, const Element& element,
                                 std::string_view name) {
  if (std::find(std::begin(kSolidMembers), std::end(kSolidMembers), name) ==
          std::end(kSolidMembers) ||
      !HasSolids(element)) {
    return std::nullopt;
  }
  context.evaluate(element);
  if (name == "self_intersects") return Value::Boolean(AnyIntersectsItself(element));
  const geom::TriangleMesh facets = FacetsOf(element);
  if (name == "centroid") return Value::OfPoint(geom::Centroid(facets));
  if (name == "closed") return Value::Boolean(geom::IsClosed(facets));
  if (name == "genus") return Value::Number(geom::Genus(facets));
  if (name == "shells") return Value::Number(geom::ShellCount(facets));
  std::vector<std::uint32_t> surfaces = facets.surfaces;
  std::sort(surfaces.begin(), surfaces.end());
  const auto end = std::unique(surfaces.begin(), surfaces.end());
  return Value::Number(static_cast<double>(end - surfaces.begin()));
}

std::optional<Value> RegionMember(const CallContext& context, const geom::Region& region,
                                  std::string_view name) {
  if (name == "perimeter") return Length(geom::Perimeter(region));
  if (name == "centroid") return Value::OfPoint(geom::Centroid(region));
  if (name == "plane") return Value::Plane(region.plane);
  double outlines = 0, holes = 0;
  geom::ForEachOutline(region,
                       [&](const geom::Curve&, bool is_hole) { ++(is_hole ? holes : outlines); });
  context.charge_items(static_cast<std::size_t>(outlines + holes));
  if (name == "parts") return Value::Number(outlines);
  if (name == "holes") return Value::Number(holes);
  return std::nullopt;
}

// A part as it is seen through its placement. It stands in no model by itself, so it has no id.
ElementPtr PlacedPart(const ElementPtr& part, const model::Instance& instance,
                      const model::Attributes& placement) {
  ElementPtr placed = model::Transformed(*part, instance.world_from_prototype);
  if (!std::holds_alternative<model::GroupPtr>(part->geometry)) {
    placed = model::WithAttributes(*placed, std::make_shared<const model::Attributes>(
                                                model::Inherit(*part->attributes, placement)));
  }
  return model::WithId(*placed, model::kNoElement);
}

template <class Map>
Value NamedValue(const CallContext& context, const model::NamedElements& named, const Map& map) {
  context.charge_items(named.elements.size());
  std::vector<Value> elements;
  for (const ElementPtr& element : named.elements)
    elements.push_back(Value::OfElement(map(element)));
  if (!named.is_list && elements.size() == 1) return elements[0];
  if (!named.is_list && elements.empty()) {
    throw OpFailure{Code::kNoLongerThere, "`" + Printable(named.name) + "` was deleted"};
  }
  return Value::List(std::move(elements));
}

// By how much a placement scales every length; nothing if it stretches or shears.
std::optional<double> ScaleOf(const geom::Affine& world_from_prototype) {
  const Eigen::Matrix3d linear = world_from_prototype.linear();
  const Eigen::Matrix3d square = linear.transpose() * linear;
  const double scale_squared = square.trace() / 3;
  if (!((square - scale_squared * Eigen::Matrix3d::Identity()).norm() <= 1e-12 * scale_squared)) {
    return std::nullopt;
  }
  const double scale = std::sqrt(scale_squared);
  return std::abs(scale - 1) <= 1e-12 ? 1 : scale;
}

// A mirror turns the frame's handedness; axis and direction keep their meaning, y follows.
geom::Frame PlacedFrame(const geom::Frame& frame, const geom::Affine& world_from_prototype) {
  const geom::Vec3 axis = (world_from_prototype.linear() * frame.z()).normalized();
  const geom::Vec3 towards = world_from_prototype.linear() * frame.x;
  const geom::Vec3 x = (towards - axis.dot(towards) * axis).normalized();
  return {world_from_prototype * frame.origin, x, axis.cross(x)};
}

// An interface of an element in the model, or of a part of one.
Value InterfaceValue(const ElementPtr& element, const model::Interface& interface) {
  const geom::Affine& world_from_prototype =
      std::get<model::InstancePtr>(element->geometry)->world_from_prototype;
  const geom::Frame frame = PlacedFrame(interface.frame, world_from_prototype);
  model::Record record{"interface",
                       {{"name", Value::String(interface.name)},
                        {"at", Value::OfPoint(frame.origin)},
                        {"axis", Direction(frame.z())},
                        {"dir", Direction(frame.x)},
                        {"plane", Value::Plane(frame)},
                        {"of", Value::OfElement(element)}}};
  const std::optional<double> scale = ScaleOf(world_from_prototype);
  for (const auto& [name, measure] : interface.measures) {
    const bool scales =
        measure.is_number() && measure.dimension().base == model::Dimension::kLength;
    if (!scales) {
      record.members.emplace_back(name, measure);
    } else if (scale) {  // under a stretch a measure has no one value
      const double factor = std::pow(*scale, measure.dimension().exponent);
      record.members.emplace_back(
          name, Chain(measure, factor * measure.number(), factor, measure.dimension()));
    }
  }
  return Value::OfRecord(std::move(record));
}

const model::Interface* FindInterface(const model::Prototype& prototype, std::string_view name) {
  for (const model::Interface& interface : prototype.interfaces) {
    if (interface.name == name) return &interface;
  }
  return nullptr;
}

std::optional<Value> InstanceMember(const CallContext& context, const ElementPtr& element,
                                    std::string_view name) {
  const model::Instance& instance = *std::get<model::InstancePtr>(element->geometry);
  const model::Prototype& prototype = *instance.prototype;
  for (const auto& [parameter, value] : prototype.parameters) {
    if (parameter == name) return value;
  }
  for (const model::NamedElements& named : prototype.names) {
    if (named.name != name) continue;
    return NamedValue(context, named, [&](const ElementPtr& part) {
      return PlacedPart(part, instance, *element->attributes);
    });
  }
  if (const model::Interface* interface = FindInterface(prototype, name)) {
    return InterfaceValue(element, *interface);
  }
  return std::nullopt;
}

std::optional<Value> GroupMember(const CallContext& context, const Element& element,
                                 const model::Group& group, std::string_view name) {
  for (const model::NamedElements& named : group.names) {
    if (named.name != name) continue;
    // A group that is a part of a placed one is not in the model, and neither are its members.
    const bool in_model = element.id < context.state->model.entries.size();
    return NamedValue(context, named, [&](const ElementPtr& member) {
      return in_model ? CurrentElement(*context.state, member)
                      : model::WithId(*member, model::kNoElement);
    });
  }
  return std::nullopt;
}

std::optional<Value> PlaceMember(const geom::Vec3& position, std::string_view name) {
  if (name == "position") return Value::OfPoint(position);
  if (name == "x") return Length(position.x());
  if (name == "y") return Length(position.y());
  if (name == "z") return Length(position.z());
  return std::nullopt;
}

std::optional<Value> TraceMember(const model::Trace& trace, std::string_view name) {
  if (name == "noise") return Value::Number(trace.noise_px, model::kPixel);
  if (name != "dots") return std::nullopt;
  std::vector<Value> dots;
  for (const geom::Vec2& dot : trace.dots_px) {
    dots.push_back(Value::List(
        {Value::Number(dot.x(), model::kPixel), Value::Number(dot.y(), model::kPixel)}));
  }
  return Value::List(std::move(dots));
}

std::optional<Value> FacadeMember(const model::Facade& facade, std::string_view name) {
  if (name == "plane") return Value::Plane(facade.plane);
  if (name == "origin") return Value::OfPoint(facade.plane.origin);
  if (name == "right") return Direction(facade.plane.x);
  if (name == "up") return Direction(facade.plane.y);
  if (name == "normal") return Direction(facade.plane.z());
  return std::nullopt;
}

std::optional<Value> OrthophotoMember(const model::Orthophoto& made, std::string_view name) {
  if (name == "width") return Length(made.size_m().x());
  if (name == "height") return Length(made.size_m().y());
  if (name == "pixel") return Length(made.pixel_m);
  if (name == "sampling") return Length(made.sampling_m);
  return std::nullopt;
}

// What only this kind of element has.
std::optional<Value> OwnMember(const CallContext& context, const ElementPtr& named,
                               std::string_view name) {
  const Element& element = *named;
  if (const auto* point = std::get_if<model::Point>(&element.geometry)) {
    return PlaceMember(point->position, name);
  }
  if (const geom::Curve* curve = CurveOf(element)) return CurveMember(context, *curve, name);
  if (const geom::Region* region = RegionOf(element)) return RegionMember(context, *region, name);
  if (const auto* text = std::get_if<model::TextPtr>(&element.geometry)) {
    if (name == "text") return Value::String((*text)->content);
    if (name == "height") return Length((*text)->height_m);
    if (name == "plane") return Value::Plane((*text)->frame);
    return PlaceMember((*text)->frame.origin, name);
  }
  if (const auto* photograph = std::get_if<model::PhotographPtr>(&element.geometry)) {
    return PhotographMember(**photograph, name);
  }
  if (const auto* trace = std::get_if<model::TracePtr>(&element.geometry)) {
    return TraceMember(**trace, name);
  }
  if (const auto* facade = std::get_if<model::FacadePtr>(&element.geometry)) {
    return FacadeMember(**facade, name);
  }
  if (const auto* made = std::get_if<model::OrthophotoPtr>(&element.geometry)) {
    return OrthophotoMember(**made, name);
  }
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    if (auto own = GroupMember(context, element, **group, name)) return own;
  }
  if (std::holds_alternative<model::InstancePtr>(element.geometry)) {
    if (auto own = InstanceMember(context, named, name)) return own;
  }
  return SolidMember(context, element, name);
}

std::vector<std::string> OwnMembers(const Element& element) {
  if (std::holds_alternative<model::Point>(element.geometry))
    return {"position", "x", "y", "z", "covariance"};
  if (const geom::Curve* curve = CurveOf(element)) return CurveMembers(*curve);
  if (SurfaceOf(element)) return {"point(u, v)", "normal(u, v)"};
  if (RegionOf(element)) return {"perimeter", "centroid", "parts", "holes", "plane"};
  if (std::holds_alternative<model::TextPtr>(element.geometry)) {
    return {"text", "height", "plane", "position", "x", "y", "z"};
  }
  if (std::holds_alternative<model::PhotographPtr>(element.geometry)) return PhotographMembers();
  if (std::holds_alternative<model::TracePtr>(element.geometry)) return {"dots", "noise"};
  if (std::holds_alternative<model::FacadePtr>(element.geometry)) {
    return {"plane", "origin", "right", "up", "normal"};
  }
  if (std::holds_alternative<model::OrthophotoPtr>(element.geometry)) {
    return {"width", "height", "pixel", "sampling"};
  }
  std::vector<std::string> names;
  if (const auto* group = std::get_if<model::GroupPtr>(&element.geometry)) {
    for (const model::NamedElements& named : (*group)->names) names.push_back(named.name);
  }
  if (const auto* instance = std::get_if<model::InstancePtr>(&element.geometry)) {
    const model::Prototype& prototype = *(*instance)->prototype;
    for (const auto& [name, value] : prototype.parameters) names.push_back(name);
    for (const model::NamedElements& named : prototype.names) names.push_back(named.name);
    for (const model::Interface& interface : prototype.interfaces) names.push_back(interface.name);
  }
  if (HasSolids(element)) {
    names.insert(names.end(), std::begin(kSolidMembers), std::end(kSolidMembers));
  }
  return names;
}

std::vector<std::string> MembersOf(const Element& element) {
  std::vector<std::string> names = OwnMembers(element);
  for (const Row& row : kMeasures) names.emplace_back(row.name);
  return names;
}

double FractionArgument(Arguments arguments, std::size_t index) {
  const double fraction = PlainArgument(arguments, static_cast<int>(index)).number();
  if (fraction >= 0 && fraction <= 1) return fraction;
  throw OpFailure{Code::kOutOfRange, "a fraction lies from 0 to 1, but this is " + Digits(fraction),
                  "", "", static_cast<int>(index)};
}

void CheckCount(std::string_view usage, Arguments arguments, std::size_t count) {
  if (arguments.size() == count) return;
  throw OpFailure{Code::kWrongCount, "it is given " + std::to_string(arguments.size()) + " values",
                  std::string(usage)};
}

// The face of this name, or the place on it that lies so far along and above its origin.
Value Face(const CallContext& context, const ElementPtr& element, Arguments arguments) {
  if (arguments.size() != 3) CheckCount("face(name)", arguments, 1);
  if (!arguments[0].is_string()) FailArgument(arguments, 0, "the name of a face");
  const model::Prototype& prototype = *std::get<model::InstancePtr>(element->geometry)->prototype;
  if (const model::Interface* face = FindInterface(prototype, arguments[0].string())) {
    model::Interface place = *face;
    if (arguments.size() == 3) {
      const auto length_m = [&](std::size_t i, std::string_view name) {
        return Convert(arguments[i], Type::kLength, *context.arithmetic.unit, name).number();
      };
      place.frame.origin =
          place.frame.ToWorld({length_m(1, "the way along"), length_m(2, "the height"), 0});
      // A place is not as long and as high as its face, and what stands there is neither.
      std::erase_if(place.measures, [](const auto& measure) {
        return measure.first == "length" || measure.first == "height";
      });
    }
    return InterfaceValue(element, place);
  }
  std::vector<std::string> names;
  for (const model::Interface& interface : prototype.interfaces) names.push_back(interface.name);
  FailMember(WithArticle(prototype.words), arguments[0].string(), names);
}

// Rows of the covariance of a point's coordinates: zeros where it hangs on nothing uncertain.
Value CovarianceValue(const Element& point) {
  const Eigen::Matrix3d covariance =
      model::CovarianceOf(point).value_or(Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
  std::vector<Value> rows;
  for (int i = 0; i < 3; ++i) {
    std::vector<Value> row;
    for (int j = 0; j < 3; ++j) row.push_back(Value::Number(covariance(i, j), model::kArea));
    rows.push_back(Value::List(std::move(row)));
  }
  return Value::List(std::move(rows));
}

Value MethodOf(const CallContext& context, const ElementPtr& element, std::string_view name,
               Arguments arguments) {
  if (const geom::Curve* curve = CurveOf(*element); curve && name == "at") {
    CheckCount("at(fraction)", arguments, 1);
    return Value::OfPoint(geom::PointAtFraction(*curve, FractionArgument(arguments, 0)));
  }
  if (const geom::Surface* surface = SurfaceOf(*element);
      surface && (name == "point" || name == "normal")) {
    CheckCount(name == "point" ? "point(u, v)" : "normal(u, v)", arguments, 2);
    const double u = FractionArgument(arguments, 0), v = FractionArgument(arguments, 1);
    return name == "point" ? Value::OfPoint(geom::PointAt(*surface, u, v))
                           : Direction(geom::NormalAt(*surface, u, v));
  }
  if (std::holds_alternative<model::InstancePtr>(element->geometry) && name == "face") {
    return Face(context, element, arguments);
  }
  const Value member = ElementMember(context, element, name);
  throw OpFailure{Code::kWrongType,
                  "`" + Printable(name) + "` is " + Describe(member) + ", and is not called", "",
                  "write it without ( )"};
}

}  // namespace

Value ElementMember(const CallContext& context, const ElementPtr& named, std::string_view name) {
  const ElementPtr current = CurrentElement(*context.state, named);
  const bool is_point = std::holds_alternative<model::Point>(current->geometry);
  if (is_point && name == "covariance") return CovarianceValue(*current);
  return ReadOff(current, [&](const ElementPtr& element) {
    if (std::optional<Value> own = OwnMember(context, element, name)) return *std::move(own);
    for (const Row& row : kMeasures) {
      if (row.name != name) continue;
      if (row.measures_solids) context.evaluate(*element);
      return row.read(*element);
    }
    FailMember(WithArticle(model::TypeOf(*element)), name, MembersOf(*element));
  });
}

Value ElementMethod(const CallContext& context, const ElementPtr& named, std::string_view name,
                    Arguments arguments) {
  const ElementPtr current = CurrentElement(*context.state, named);
  return ReadOff(current, [&](const ElementPtr& element) {
    return MethodOf(context, element, name, arguments);
  });
}

}  // namespace tranos::interp
