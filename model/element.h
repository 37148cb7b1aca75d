// SPDX-License-Identifier: GPL-3.0-or-later
// What a script builds. Elements are immutable plain values, shared by every state that holds them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "geom/curve.h"
#include "geom/region.h"
#include "geom/solid.h"
#include "geom/stroke_font.h"
#include "geom/surface.h"
#include "model/facade.h"
#include "model/hash.h"
#include "model/orthophoto.h"
#include "model/photograph.h"
#include "model/value.h"

namespace tranos::model {

// Unique within a run; never compared between runs.
using ElementId = std::uint32_t;
inline constexpr ElementId kNoElement = 0xffffffff;

// A palette index 0–255, or kRgb | 0xrrggbb.
struct Colour {
  static constexpr std::uint32_t kRgb = 0x1000000;
  std::uint32_t code = 0;
  friend bool operator==(const Colour&, const Colour&) = default;
};
struct Rgb {
  std::uint8_t r, g, b;
};
Rgb RgbOf(Colour colour);
std::string Describe(Colour colour);  // "3" or "#a0b0c0"

enum class Evidence : std::uint8_t {
  kNone,
  kMeasured,
  kPhoto,
  kExcavation,
  kDocument,
  kSymmetry,
  kAnalogy,
  kConjecture,
};
std::string_view WordOf(Evidence evidence);  // "" for kNone
std::optional<Evidence> EvidenceOf(std::string_view word);

// The settings an element keeps. `own` has a bit for each one that was set where it was made; a
// part of a definition takes the others from its placement.
struct Attributes {
  enum Own : std::uint8_t {
    kColour = 1,
    kLinestyle = 2,
    kWeight = 4,
    kLevel = 8,
    kMaterial = 16,
    kEvidence = 32,
    kAll = 63,
  };
  Colour colour;
  int linestyle = 0;
  int weight = 1;
  std::string level = "1";
  std::string material;
  Evidence evidence = Evidence::kNone;
  std::string source;
  std::uint8_t own = 0;
};
using AttributesPtr = std::shared_ptr<const Attributes>;
// `part` with what it does not own taken from `placement`.
Attributes Inherit(const Attributes& part, const Attributes& placement);

void AddToHash(Hasher& hasher, const Attributes& attributes);  // all but `own`

struct Element;
using ElementPtr = std::shared_ptr<const Element>;

// A name and what it stands for: one element, or (given in a loop) a list.
struct NamedElements {
  std::string name;
  std::vector<ElementPtr> elements;
  bool is_list = false;
};

struct Group {
  std::vector<ElementPtr> members;
  std::vector<NamedElements> names;
  int depth = 1;  // how many groups and placed elements lie in one another, this one included
};
using GroupPtr = std::shared_ptr<const Group>;
// The group with its depth counted.
GroupPtr MakeGroup(Group group);

// A named frame where others meet an element, with measures ("radius", 5 m).
struct Interface {
  std::string name;
  geom::Frame frame;  // at= the origin, axis= z, dir= x
  std::vector<std::pair<std::string, Value>> measures;
};

// One geometry that any number of instances share, in its own frame.
struct Prototype {
  std::string words;  // of its definition, without `place`: "dome cruciform"
  std::vector<ElementPtr> parts;
  std::vector<NamedElements> names;
  std::vector<Interface> interfaces;
  std::vector<std::pair<std::string, Value>> parameters;  // in the order of declaration
  Hash128 hash;                                           // of parts and words
  int depth = 1;                                          // as a group's
};
using PrototypePtr = std::shared_ptr<const Prototype>;
// The prototype with its depth counted and its hash computed: over words, parts in their order and
// which settings they own.
PrototypePtr MakePrototype(Prototype prototype);

struct Instance {
  PrototypePtr prototype;
  geom::Affine world_from_prototype = geom::Affine::Identity();
};

struct Point {
  geom::Vec3 position;
};
using CurvePtr = std::shared_ptr<const geom::Curve>;
using SurfacePtr = std::shared_ptr<const geom::Surface>;
using SolidPtr = std::shared_ptr<const geom::Solid>;
using RegionPtr = std::shared_ptr<const geom::Region>;
using TextPtr = std::shared_ptr<const geom::Text>;
using InstancePtr = std::shared_ptr<const Instance>;
using PhotographPtr = std::shared_ptr<const Photograph>;
using TracePtr = std::shared_ptr<const Trace>;
using FacadePtr = std::shared_ptr<const Facade>;
using OrthophotoPtr = std::shared_ptr<const Orthophoto>;
using Geometry = std::variant<Point, CurvePtr, SurfacePtr, RegionPtr, SolidPtr, TextPtr, GroupPtr,
                              InstancePtr, PhotographPtr, TracePtr, FacadePtr, OrthophotoPtr>;

// How an element lies where one of the sources that it hangs on is a step from where it is taken to
// be, to either side: the differences are its derivatives by it. What was drawn through a
// photograph has one for each source of the camera, of the facade and of its dots.
struct Moved {
  SourceId source;
  double step;  // in SI
  Geometry forward, back;
};
using MovedPtr = std::shared_ptr<const std::vector<Moved>>;

struct Element {
  ElementId id = kNoElement;
  Hash128 hash;  // type, geometry, attributes, name, members' hashes; never id or order
  AttributesPtr attributes;
  std::shared_ptr<const std::string> name;  // may be null
  Geometry geometry;
  geom::Tolerance tolerance = {};  // in force when it was made: for its facets, not in the hash
  MovedPtr moved = nullptr;        // by source; null if it hangs on none; not in the hash

  std::string_view name_or_empty() const { return name ? std::string_view(*name) : ""; }
};

// An element with its hash computed.
ElementPtr MakeElement(ElementId id, Geometry geometry, AttributesPtr attributes,
                       std::shared_ptr<const std::string> name, const geom::Tolerance& tolerance);
ElementPtr WithId(const Element& element, ElementId id);  // members of a group keep theirs
ElementPtr WithName(const Element& element, std::string name);
ElementPtr WithAttributes(const Element& element, AttributesPtr attributes);  // members too
ElementPtr WithGeometry(const Element& element, Geometry geometry);  // hangs on no source then
ElementPtr WithMoved(const Element& element, std::vector<Moved> moved);
// The group with `map` of each member, its names following. A member whose map is null leaves it.
GroupPtr MapMembers(const Group& group, const std::function<ElementPtr(const ElementPtr&)>& map);
// Groups member by member; an instance by its transform alone.
ElementPtr Transformed(const Element& element, const geom::Affine& target_from_source);

// Whether it is a part of what is built: no photograph, camera, trace, facade or orthophoto.
bool IsBuilt(const Element& element);

// How many groups and placed elements lie in one another, the element included: 0 for one that has
// no parts.
int DepthOf(const Element& element);

// "point", "line", "arc", "circle", "line string", "shape", "curve", "chain", "surface", "region",
// "solid", "text", "group", "photograph", "camera", "trace edge" …, "facade", "orthophoto", or an
// instance's words.
std::string TypeOf(const Element& element);

// Measures. Nothing where the element has none of the kind: a point has no length, an open curve
// no area, a surface no length. Groups and instances sum their parts'; the area is that of faces
// and of closed planar curves. Measuring evaluates a solid, but for its box, which is around all
// that it could fill until somebody has evaluated it.
geom::Box BoundingBox(const Element& element);
std::optional<double> Length(const Element& element);
std::optional<double> Area(const Element& element);
std::optional<double> Volume(const Element& element);
// That of its solids, where what they share counts once; dearer, for they are united.
std::optional<double> FilledVolume(const Element& element);
geom::Nearest NearestPoint(const Element& element, const geom::Vec3& p);

// Calls f(leaf, world_from_leaf, resolved attributes) for every part that is no group or instance.
template <class F>
void ForEachLeaf(const Element& element, F&& f);

}  // namespace tranos::model

#include "model/element_leaves.h"
