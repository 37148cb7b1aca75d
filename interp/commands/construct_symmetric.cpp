// SPDX-License-Identifier: GPL-3.0-or-later
// construct symmetric: the other half. construct surface section: where a plane cuts.
#include <iterator>
#include <optional>

#include "geom/mesh_section.h"
#include "interp/commands/families.h"
#include "interp/commands/placement.h"
#include "interp/commands/solids.h"

namespace tranos::interp {

using geom::Affine;
using geom::Vec3;
using model::State;

namespace {

// The plane in which it is mirrored, or the axis about which it is given half a turn.
tl::expected<Affine, CommandError> SymmetryOf(const Answers& answers) {
  const model::Value* plane = answers.Find("plane");
  const auto from = answers.Point("from"), to = answers.Point("to");
  if (plane ? from || to : !from || !to) {
    return Fail({.code = Code::kMissingValue,
                 .message = "what is it symmetric about?",
                 .help = "give a plane, `plane=`, or two points of an axis, `from=` and `to=`"});
  }
  if (plane) return Reflection(plane->plane().origin, plane->plane().z());
  const Vec3 axis = *to - *from;
  if (axis.norm() <= geom::kCoincident_m) {
    return Fail(
        {.code = Code::kDegenerate, .message = "an axis of no length", .where = AtKey("to")});
  }
  return Rotation(*from, axis.normalized(), geom::kPi);
}

CommandResult Symmetric(const State&, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto symmetry = SymmetryOf(answers);
  if (!symmetry) return Fail(symmetry.error());
  Fired fired;
  for (const model::ElementPtr& element : answers.chosen) {
    model::Attributes attributes = *element->attributes;
    attributes.evidence = model::Evidence::kSymmetry;
    fired.edit.added.push_back(
        model::WithAttributes(*FreshCopy(*element, *symmetry),
                              std::make_shared<const model::Attributes>(std::move(attributes))));
  }
  return fired;
}

// The lines in which the plane cuts one element's surfaces and solids, each in the world.
tl::expected<std::vector<geom::Polyline>, CommandError> LinesOf(const model::Element& element,
                                                                const geom::Frame& plane,
                                                                Where where) {
  std::vector<geom::Polyline> lines;
  std::optional<geom::Error> error;
  const auto add = [&](geom::Result<std::vector<geom::Polyline>> section) {
    if (!section) {
      error = section.error();
      return;
    }
    std::move(section->begin(), section->end(), std::back_inserter(lines));
  };
  model::ForEachLeaf(element, [&](const model::Element& leaf, const Affine& world_from_leaf,
                                  const model::Attributes&) {
    const model::ElementPtr placed = model::Transformed(leaf, world_from_leaf);
    if (const auto* surface = std::get_if<model::SurfacePtr>(&placed->geometry)) {
      add(geom::SectionOf(**surface, plane, leaf.tolerance));
    } else if (const auto* solid = std::get_if<model::SolidPtr>(&placed->geometry)) {
      const auto facets = (*solid)->Facets();
      if (facets) add(geom::SectionOf(**facets, plane));
      if (!facets) error = facets.error();
    }
  });
  if (error) return Fail(FromGeom(*error, "a section", where));
  return lines;
}

CommandResult Section(const State& state, const Answers& answers) {
  const model::Value* given = answers.Find("plane");
  const geom::Frame plane = given ? given->plane() : state.drawing.settings->plane;
  std::vector<model::Geometry> sections;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    auto lines = LinesOf(*answers.chosen[i], plane, AtChosen(i));
    if (!lines) return Fail(lines.error());
    for (geom::Polyline& line : *lines) sections.push_back(CurveGeometry(std::move(line)));
  }
  if (!sections.empty()) return MakeFromChosen(state, answers, std::move(sections));
  return Fail({.code = Code::kNothingMade,
               .message = "the plane cuts no surface and no solid",
               .help = "`set plane right at=…` says where to cut, or `plane=`",
               .where = given ? AtKey("plane") : AtChosen(0)});
}

constexpr Prompt kPrompts[] = {{"element, or a point off everything to accept"}};
constexpr Key kSymmetricKeys[] = {
    kOf,
    {"plane", Type::kPlane, "the plane in which it is mirrored"},
    {"from", Type::kPoint, "a point of the axis about which it is given half a turn"},
    {"to", Type::kPoint, "another point of the axis"}};
constexpr Key kSectionKeys[] = {
    kOf, kKeep, {"plane", Type::kPlane, "the plane that cuts", {}, "the active plane"}};
constexpr Example kSectionExamples[] = {
    {"place slab length=4m width=3m height=2m xy=0,0,-1 as s\n"
     "construct surface section of=s keep=true",
     "last.area == 12m2"},
    {"set plane front; place circle xy=0,1,0 radius=1m as rim\n"
     "place sphere radius=2m xy=0,1,0 as ball\n"
     "construct surface section of=ball plane=rim.plane",
     "last.area within 12.56m2 +- 0.02m2"},
    {"place slab length=4m width=3m height=2m xy=0,0,1 as s; construct surface section of=s",
     "E0406"}};
constexpr Example kSymmetricExamples[] = {
    {"place slab length=2m width=3m height=4m xy=1,0,0 as half\n"
     "set plane right; place circle xy=0,0,0 radius=1m as rim\n"
     "construct symmetric of=half plane=rim.plane",
     "last.bbox.min.x == -3m"},
    {"place slab length=2m width=3m height=4m xy=1,0,0 as half\n"
     "construct symmetric of=half from=[0,0,0] to=[0,0,1]",
     "last.bbox.min.y within -3m +- 0.000001m"},
    {"place slab length=2m width=3m height=4m xy=1,0,0 as half\n"
     "construct symmetric of=half",
     "E0220"}};

constexpr Command kCommands[] = {
    {.words = "construct symmetric",
     .family = "construct",
     .summary = "The other half of something symmetric: mirrored in a plane, or turned half round "
                "about an axis. Its evidence is symmetry.",
     .manner = Manner::kPicks,
     .prompts = kPrompts,
     .keys = kSymmetricKeys,
     .examples = kSymmetricExamples,
     .execute = Symmetric},
    {.words = "construct surface section",
     .family = "construct",
     .summary = "The lines in which a plane cuts surfaces and solids.",
     .manner = Manner::kPicks,
     .prompts = kPrompts,
     .keys = kSectionKeys,
     .examples = kSectionExamples,
     .execute = Section},
};

}  // namespace

std::span<const Command> SymmetryCommands() { return kCommands; }

}  // namespace tranos::interp
