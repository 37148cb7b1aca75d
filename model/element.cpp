// SPDX-License-Identifier: GPL-3.0-or-later
// Elements and their content hashes. Every kind of thing starts with a tag of its own, so that no
// two kinds share canonical bytes.
#include "model/element.h"

#include <algorithm>
#include <unordered_map>

#include "model/solid_hash.h"

namespace tranos::model {

namespace {

enum Tag : std::uint8_t {
  kPoint = 1,
  kLine,
  kArc,
  kCircle,
  kPolyline,
  kBsplineCurve,
  kChain,
  kBsplineSurface,
  kCoonsPatch,
  kText,
  kGroup,
  kInstance,
  kPrototype,
  kOwn,
  kPhotograph,
  kTrace,
  kSolid,
  kRegion,
  kRegionPart,
  kFacade,
  kOrthophoto,
};

void AddCount(Hasher& hasher, std::size_t count) {
  hasher.Integer(static_cast<std::int64_t>(count));
}

void AddFrame(Hasher& hasher, const geom::Frame& frame) {
  hasher.Point(frame.origin).Direction(frame.x).Direction(frame.y);
}

void AddRatios(Hasher& hasher, const std::vector<double>& numbers) {
  AddCount(hasher, numbers.size());
  for (const double number : numbers) hasher.Ratio(number);
}

void AddPoints(Hasher& hasher, const std::vector<geom::Vec3>& points) {
  AddCount(hasher, points.size());
  for (const geom::Vec3& point : points) hasher.Point(point);
}

void Add(Hasher& hasher, const geom::Line& line) {
  hasher.Tag(kLine).Point(line.start).Point(line.end);
}
void Add(Hasher& hasher, const geom::Arc& arc) {
  hasher.Tag(kArc).Length(arc.radius).Angle(arc.sweep_rad);
  AddFrame(hasher, arc.frame);
}
void Add(Hasher& hasher, const geom::Circle& circle) {
  hasher.Tag(kCircle).Length(circle.radius);
  AddFrame(hasher, circle.frame);
}
void Add(Hasher& hasher, const geom::Polyline& polyline) {
  hasher.Tag(kPolyline).Tag(polyline.closed);
  AddPoints(hasher, polyline.vertices);
}
void Add(Hasher& hasher, const geom::BsplineCurve& curve) {
  hasher.Tag(kBsplineCurve).Integer(curve.degree);
  AddRatios(hasher, curve.knots);
  AddPoints(hasher, curve.poles);
  AddRatios(hasher, curve.weights);
}
void Add(Hasher& hasher, const geom::Chain& chain) {
  hasher.Tag(kChain).Tag(chain.closed);
  AddCount(hasher, chain.segments.size());
  for (const geom::Segment& segment : chain.segments) {
    std::visit([&](const auto& shape) { Add(hasher, shape); }, segment);
  }
}
void Add(Hasher& hasher, const geom::BsplineSurface& surface) {
  hasher.Tag(kBsplineSurface).Integer(surface.degree_u).Integer(surface.degree_v);
  hasher.Integer(surface.count_u).Integer(surface.count_v);
  AddRatios(hasher, surface.knots_u);
  AddRatios(hasher, surface.knots_v);
  AddPoints(hasher, surface.poles);
  AddRatios(hasher, surface.weights);
}
void Add(Hasher& hasher, const geom::CoonsPatch& patch) {
  hasher.Tag(kCoonsPatch);
  for (const auto* side : {&patch.south, &patch.north, &patch.west, &patch.east}) {
    Add(hasher, *side);
  }
}

void Add(Hasher& hasher, const Point& point) { hasher.Tag(kPoint).Point(point.position); }
void Add(Hasher& hasher, const CurvePtr& curve) {
  std::visit([&](const auto& shape) { Add(hasher, shape); }, *curve);
}
Hash128 HashOfOutline(const geom::Curve& curve) {
  Hasher hasher;
  std::visit([&](const auto& shape) { Add(hasher, shape); }, curve);
  return hasher.Finish();
}
void Add(Hasher& hasher, const SurfacePtr& surface) {
  std::visit([&](const auto& shape) { Add(hasher, shape); }, *surface);
}
void Add(Hasher& hasher, const SolidPtr& solid) { hasher.Tag(kSolid).Hash(HashOf(*solid)); }
// Sums, for the order of parts and holes is no part of what the region is.
void Add(Hasher& hasher, const RegionPtr& region) {
  Hash128 parts;
  for (const geom::Region::Part& part : region->parts) {
    Hash128 holes;
    for (const geom::Curve& hole : part.holes) holes = holes + HashOfOutline(hole);
    Hasher one;
    one.Tag(kRegionPart).Hash(HashOfOutline(part.outer)).Hash(holes);
    AddCount(one, part.holes.size());
    parts = parts + one.Finish();
  }
  hasher.Tag(kRegion).Direction(region->plane.z()).Hash(parts);
  AddCount(hasher, region->parts.size());
}
void Add(Hasher& hasher, const TextPtr& text) {
  hasher.Tag(kText).Text(text->content).Length(text->height_m);
  AddFrame(hasher, text->frame);
}
void Add(Hasher& hasher, const GroupPtr& group) {
  // A sum, for the order in which members were made is no part of what they are.
  Hash128 sum;
  for (const ElementPtr& member : group->members) sum = sum + member->hash;
  hasher.Tag(kGroup).Hash(sum);
  AddCount(hasher, group->members.size());
}
void Add(Hasher& hasher, const InstancePtr& instance) {
  hasher.Tag(kInstance).Hash(instance->prototype->hash);
  const geom::Affine& world_from_prototype = instance->world_from_prototype;
  for (int column = 0; column < 3; ++column) {
    hasher.Direction(world_from_prototype.linear().col(column));
  }
  hasher.Point(world_from_prototype.translation());
}

void Add(Hasher& hasher, const PhotographPtr& photograph) {
  AddToHash(hasher.Tag(kPhotograph), *photograph);
}
void Add(Hasher& hasher, const TracePtr& trace) { AddToHash(hasher.Tag(kTrace), *trace); }
void Add(Hasher& hasher, const FacadePtr& facade) { AddToHash(hasher.Tag(kFacade), *facade); }
void Add(Hasher& hasher, const OrthophotoPtr& made) { AddToHash(hasher.Tag(kOrthophoto), *made); }

Hash128 HashOf(const Element& element) {
  Hasher hasher;
  std::visit([&](const auto& geometry) { Add(hasher, geometry); }, element.geometry);
  AddToHash(hasher, *element.attributes);
  hasher.Text(element.name_or_empty());
  return hasher.Finish();
}

// Which settings a part has of its own decides what a placement gives it.
void AddOwn(Hasher& hasher, const Element& part) {
  hasher.Tag(kOwn).Tag(part.attributes->own);
  if (const auto* group = std::get_if<GroupPtr>(&part.geometry)) {
    for (const ElementPtr& member : (*group)->members) AddOwn(hasher.Hash(member->hash), *member);
  }
}

int DeepestOf(const std::vector<ElementPtr>& elements) {
  int deepest = 0;
  for (const ElementPtr& element : elements) deepest = std::max(deepest, DepthOf(*element));
  return deepest;
}

ElementPtr Hashed(Element element) {
  element.hash = HashOf(element);
  return std::make_shared<const Element>(std::move(element));
}

}  // namespace

void AddToHash(Hasher& hasher, const Attributes& attributes) {
  hasher.Integer(attributes.colour.code);
  hasher.Integer(attributes.linestyle).Integer(attributes.weight);
  hasher.Text(attributes.level).Text(attributes.material);
  hasher.Tag(static_cast<std::uint8_t>(attributes.evidence)).Text(attributes.source);
}

ElementPtr MakeElement(ElementId id, Geometry geometry, AttributesPtr attributes,
                       std::shared_ptr<const std::string> name, const geom::Tolerance& tolerance) {
  return Hashed({id, {}, std::move(attributes), std::move(name), std::move(geometry), tolerance});
}

ElementPtr WithId(const Element& element, ElementId id) {
  auto copy = std::make_shared<Element>(element);
  copy->id = id;
  return copy;
}

ElementPtr WithName(const Element& element, std::string name) {
  Element copy = element;
  copy.name = std::make_shared<const std::string>(std::move(name));
  return Hashed(std::move(copy));
}

ElementPtr WithGeometry(const Element& element, Geometry geometry) {
  Element copy = element;
  copy.geometry = std::move(geometry);
  copy.moved = nullptr;
  return Hashed(std::move(copy));
}

ElementPtr WithMoved(const Element& element, std::vector<Moved> moved) {
  Element copy = element;
  copy.moved =
      moved.empty() ? nullptr : std::make_shared<const std::vector<Moved>>(std::move(moved));
  return std::make_shared<const Element>(std::move(copy));
}

ElementPtr WithAttributes(const Element& element, AttributesPtr attributes) {
  Element copy = element;
  if (const auto* group = std::get_if<GroupPtr>(&element.geometry)) {
    copy.geometry = MapMembers(
        **group, [&](const ElementPtr& member) { return WithAttributes(*member, attributes); });
  }
  copy.attributes = std::move(attributes);
  return Hashed(std::move(copy));
}

bool IsBuilt(const Element& element) {
  return !std::holds_alternative<PhotographPtr>(element.geometry) &&
         !std::holds_alternative<TracePtr>(element.geometry) &&
         !std::holds_alternative<FacadePtr>(element.geometry) &&
         !std::holds_alternative<OrthophotoPtr>(element.geometry);
}

int DepthOf(const Element& element) {
  if (const auto* group = std::get_if<GroupPtr>(&element.geometry)) return (*group)->depth;
  const auto* instance = std::get_if<InstancePtr>(&element.geometry);
  return instance ? (*instance)->prototype->depth : 0;
}

GroupPtr MakeGroup(Group group) {
  group.depth = 1 + DeepestOf(group.members);
  return std::make_shared<const Group>(std::move(group));
}

GroupPtr MapMembers(const Group& group, const std::function<ElementPtr(const ElementPtr&)>& map) {
  Group result;
  std::unordered_map<const Element*, ElementPtr> mapped;
  for (const ElementPtr& member : group.members) {
    const ElementPtr& target = mapped[member.get()] = map(member);
    if (target) result.members.push_back(target);
  }
  for (NamedElements named : group.names) {
    for (ElementPtr& element : named.elements) {
      const auto [target, is_no_member] = mapped.try_emplace(element.get());
      if (is_no_member) target->second = map(element);  // consumed in its group, but still named
      element = target->second;
    }
    std::erase(named.elements, nullptr);
    result.names.push_back(std::move(named));
  }
  return MakeGroup(std::move(result));
}

PrototypePtr MakePrototype(Prototype prototype) {
  Hasher hasher;
  hasher.Tag(kPrototype).Text(prototype.words);
  AddCount(hasher, prototype.parts.size());
  for (const ElementPtr& part : prototype.parts) AddOwn(hasher.Hash(part->hash), *part);
  prototype.hash = hasher.Finish();
  prototype.depth = 1 + DeepestOf(prototype.parts);
  return std::make_shared<const Prototype>(std::move(prototype));
}

std::string TypeOf(const Element& element) {
  struct Type {
    std::string operator()(const Point&) const { return "point"; }
    std::string operator()(const CurvePtr& curve) const { return std::visit(*this, *curve); }
    std::string operator()(const geom::Line&) const { return "line"; }
    std::string operator()(const geom::Arc&) const { return "arc"; }
    std::string operator()(const geom::Circle&) const { return "circle"; }
    std::string operator()(const geom::Polyline& polyline) const {
      return polyline.closed ? "shape" : "line string";
    }
    std::string operator()(const geom::BsplineCurve&) const { return "curve"; }
    std::string operator()(const geom::Chain&) const { return "chain"; }
    std::string operator()(const SurfacePtr&) const { return "surface"; }
    std::string operator()(const SolidPtr&) const { return "solid"; }
    std::string operator()(const RegionPtr&) const { return "region"; }
    std::string operator()(const TextPtr&) const { return "text"; }
    std::string operator()(const GroupPtr&) const { return "group"; }
    std::string operator()(const InstancePtr& instance) const { return instance->prototype->words; }
    std::string operator()(const PhotographPtr& photograph) const {
      return IsStatedCamera(*photograph) ? "camera" : "photograph";
    }
    std::string operator()(const TracePtr& trace) const { return model::TypeOf(*trace); }
    std::string operator()(const FacadePtr&) const { return "facade"; }
    std::string operator()(const OrthophotoPtr&) const { return "orthophoto"; }
  };
  return std::visit(Type{}, element.geometry);
}

}  // namespace tranos::model
