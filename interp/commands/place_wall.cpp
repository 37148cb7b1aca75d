// SPDX-License-Identifier: GPL-3.0-or-later
// place wall: upright walls along a line, with openings, and faces on which elements are placed.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/swept_solid.h"
#include "geom/wall.h"
#include "interp/commands/families.h"
#include "interp/commands/range.h"
#include "interp/commands/solids.h"

namespace tranos::interp {

using geom::Frame;
using geom::Vec2;
using geom::Vec3;
using geom::WallFace;
using geom::WallOpening;
using geom::WallShape;
using model::State;
using model::Value;

namespace {

tl::expected<double, CommandError> Positive(const State& state, const Answers& answers,
                                            std::string_view key) {
  const double size_m = answers.Number(key);
  if (size_m > geom::kCoincident_m) return size_m;
  return Fail({.code = Code::kOutOfRange,
               .message = fmt::format("`{}` is {}, and must be above zero", key,
                                      InWords(size_m, *state.drawing.settings)),
               .label = "above 0",
               .where = AtKey(key)});
}

// The line's corners, level in the active plane through the first.
tl::expected<std::vector<Vec3>, CommandError> LineOf(const State& state, const Answers& answers) {
  const Frame base = PlaneAt(state, answers.points[0]);
  std::vector<Vec3> line;
  for (std::size_t i = 0; i < answers.points.size(); ++i) {
    const double off_m = base.ToLocal(answers.points[i]).z();
    if (std::abs(off_m) > kOffPlane_m) return Fail(OffPlane(state, off_m, static_cast<int>(i)));
    if (!line.empty() && (answers.points[i] - line.back()).norm() <= geom::kCoincident_m) {
      return Fail({.code = Code::kDegenerate,
                   .message = "a wall with a part of no length",
                   .label = "the point before lies here, too",
                   .where = AtPoint(static_cast<int>(i))});
    }
    line.push_back(answers.points[i]);
  }
  return line;
}

tl::expected<WallShape, CommandError> ShapeOf(const State& state, const Answers& answers) {
  const auto thickness_m = Positive(state, answers, "thickness"),
             height_m = Positive(state, answers, "height");
  if (!thickness_m) return Fail(thickness_m.error());
  if (!height_m) return Fail(height_m.error());
  auto line = LineOf(state, answers);
  if (!line) return Fail(line.error());
  WallShape wall = {PlaneAt(state, answers.points[0]), *std::move(line)};
  wall.closed = answers.Flag("closed");
  if (wall.line.size() > 3 &&
      (wall.line.back() - wall.line.front()).norm() <= geom::kCoincident_m) {
    wall.closed = true;
    wall.line.pop_back();
  }
  if (wall.closed && wall.line.size() < 3) {
    return Fail({.code = Code::kDegenerate,
                 .message = "a closed wall needs three corners",
                 .where = AtPoint(static_cast<int>(answers.points.size()) - 1)});
  }
  const std::string justify = answers.Text("justify", "centre");
  const double left = justify == "left" ? 0 : justify == "right" ? 1 : 0.5;
  wall.left_m = left * *thickness_m;
  wall.right_m = (1 - left) * *thickness_m;
  wall.height_m = *height_m;
  return wall;
}

CommandError TooThick(const State& state, const WallShape& wall, int part) {
  const auto k = static_cast<std::size_t>(std::max(part, 0));
  const double length_m = (wall.line[(k + 1) % wall.line.size()] - wall.line[k]).norm();
  const model::Settings& settings = *state.drawing.settings;
  const double thickness_m = wall.left_m + wall.right_m;
  const double largest_m = LargestThatWorks(thickness_m, [&](double tried_m) {
    WallShape thinner = wall;
    thinner.left_m *= tried_m / thickness_m;
    thinner.right_m *= tried_m / thickness_m;
    return geom::FacesOf(thinner).has_value();
  });
  return {
      .code = Code::kOutOfRange,
      .message = fmt::format("a wall {} thick has no room on part {}, which is {} long",
                             InWords(thickness_m, settings), k + 1, InWords(length_m, settings)),
      .label = RangeInWords(largest_m, settings),
      .help =
          "a thinner wall, or fewer corners; at an open end a part may be as short as the "
          "thickness",
      .where = AtKey("thickness")};
}

// An opening stands for a hole through the part whose faces it lies nearest to.
tl::expected<WallOpening, CommandError> OpeningOf(const WallShape& wall,
                                                  const model::Element& element,
                                                  const geom::Tolerance& tolerance) {
  const auto outline = OutlineOfElement(element, "an opening", AtKey("openings"));
  if (!outline) return Fail(outline.error());
  const auto points = geom::Tessellate(outline->front(), tolerance);
  if (!points) return Fail(FromGeom(points.error(), "an opening", AtKey("openings")));
  WallOpening opening;
  double least = std::numeric_limits<double>::infinity();
  const Vec3 up = wall.base.z();
  for (std::size_t k = 0; k < wall.PartCount(); ++k) {
    const Vec3 part = wall.line[(k + 1) % wall.line.size()] - wall.line[k];
    const Vec3 along = part.normalized();
    const Vec3 across = along.cross(up);
    double farthest = 0;
    std::vector<Vec2> flat;
    Eigen::AlignedBox2d box;
    for (const Vec3& p : *points) {
      const Vec3 d = p - wall.line[k];
      farthest = std::max(farthest, std::abs(d.dot(across)));
      box.extend(flat.emplace_back(d.dot(along), d.dot(up)));
    }
    // Beside the part it would cut nothing.
    const Eigen::AlignedBox2d face(Vec2(0, 0), Vec2(part.norm(), wall.height_m));
    if (farthest < least && face.intersection(box).sizes().minCoeff() > 0) {
      least = farthest, opening = {k, std::move(flat)};
    }
  }
  if (least <= std::max(wall.left_m, wall.right_m) + 0.01) return opening;
  return Fail({.code = Code::kOutOfRange,
               .message = fmt::format("{} stands on no face of the wall", NameForMessage(element)),
               .help = "openings are outlines in the wall's upright plane, between its ends: `set "
                       "plane front`",
               .where = AtKey("openings")});
}

// The solid that an opening takes away: through its part, and a little more on either side.
geom::Result<geom::Solid> CutterOf(const WallShape& wall, const WallOpening& opening) {
  const Vec3 up = wall.base.z();
  const std::size_t k = opening.part;
  const Vec3 along = (wall.line[(k + 1) % wall.line.size()] - wall.line[k]).normalized();
  const Vec3 across = along.cross(up);
  const double thickness_m = wall.left_m + wall.right_m;
  geom::Polyline outline;
  outline.closed = true;
  for (const Vec2& p : opening.outline) {
    outline.vertices.push_back(wall.line[k] - (wall.left_m + 0.5 * thickness_m) * across +
                               p.x() * along + p.y() * up);
  }
  auto mesh = geom::ProjectionMesh({geom::Curve(outline)}, 2 * thickness_m * across, {});
  if (!mesh) return tl::unexpected(mesh.error());
  return geom::Solid::FromMesh(*std::move(mesh));
}

// Openings that lie within their faces are holes in them; what reaches over an edge is cut.
tl::expected<geom::Solid, CommandError> SolidOf(const State& state, const WallShape& wall,
                                                const std::vector<WallOpening>& openings) {
  auto mesh = geom::WallMesh(wall, openings);
  const bool cut = !mesh && mesh.error().code == geom::ErrorCode::kDoNotMeet;
  if (cut) mesh = geom::WallMesh(wall, {});
  if (!mesh) return Fail(TooThick(state, wall, mesh.error().part));
  auto whole = geom::Solid::FromMesh(*std::move(mesh));
  if (!whole) return Fail(FromGeom(whole.error(), "a wall"));
  if (!cut) return *std::move(whole);
  std::vector<geom::Solid> cutters;
  for (const WallOpening& opening : openings) {
    auto cutter = CutterOf(wall, opening);
    if (!cutter) return Fail(FromGeom(cutter.error(), "an opening", AtKey("openings")));
    cutters.push_back(*std::move(cutter));
  }
  return geom::Solid::Difference(*std::move(whole), std::move(cutters));
}

std::string_view CompassOf(const Vec3& normal, const Frame& base) {
  const double x = normal.dot(base.x), y = normal.dot(base.y);
  if (std::abs(x) > std::abs(y)) return x > 0 ? "east" : "west";
  return y > 0 ? "north" : "south";
}

// Every face by its side and number; the longest one that looks to each quarter by that, too. Round
// a room these are the faces outside.
std::vector<model::Interface> InterfacesOf(const WallShape& wall,
                                           const std::vector<WallFace>& faces) {
  std::vector<model::Interface> interfaces;
  const std::size_t parts = wall.PartCount();
  const auto add = [&](std::string name, const WallFace& face) {
    const auto length = [](double m) { return Value::Number(m, model::kLength); };
    interfaces.push_back({std::move(name),
                          face.frame,
                          {{"length", length(face.length_m)},
                           {"height", length(wall.height_m)},
                           {"thickness", length(wall.left_m + wall.right_m)}}});
  };
  double doubled_area = 0;
  for (std::size_t i = 0; i + 1 < wall.line.size(); ++i) {
    const Vec3 a = wall.line[i] - wall.line[0], b = wall.line[i + 1] - wall.line[0];
    doubled_area += a.cross(b).dot(wall.base.z());
  }
  const bool left_is_inside = wall.closed && doubled_area > 0;
  const bool right_is_inside = wall.closed && doubled_area < 0;
  for (const std::string_view compass : {"south", "east", "north", "west"}) {
    const WallFace* longest = nullptr;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (i < parts ? right_is_inside : left_is_inside) continue;
      if (CompassOf(faces[i].frame.z(), wall.base) != compass) continue;
      if (!longest || faces[i].length_m > longest->length_m) longest = &faces[i];
    }
    if (longest) add(std::string(compass), *longest);
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    add(fmt::format("{} {}", i < parts ? "right" : "left", i % parts + 1), faces[i]);
  }
  return interfaces;
}

CommandResult PlaceWall(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto wall = ShapeOf(state, answers);
  if (!wall) return Fail(wall.error());
  const auto faces = geom::FacesOf(*wall);
  if (!faces) return Fail(TooThick(state, *wall, faces.error().part));
  const auto elements = ElementsOf(state, answers, "openings");
  if (!elements) return Fail(elements.error());
  std::vector<WallOpening> openings;
  Fired fired;
  for (const model::ElementPtr& element : *elements) {
    auto opening = OpeningOf(*wall, *element, state.drawing.settings->tolerance);
    if (!opening) return Fail(opening.error());
    openings.push_back(*std::move(opening));
    if (!answers.Flag("keep")) fired.edit.consumed.push_back(element->id);
  }
  auto solid = SolidOf(state, *wall, openings);
  if (!solid) return Fail(solid.error());
  model::Prototype prototype;
  prototype.words = "wall";
  prototype.parts = {model::MakeElement(
      model::kNoElement, std::make_shared<const geom::Solid>(*std::move(solid)),
      std::make_shared<const model::Attributes>(), nullptr, state.drawing.settings->tolerance)};
  prototype.interfaces = InterfacesOf(*wall, *faces);
  prototype.parameters = {
      {"thickness", Value::Number(wall->left_m + wall->right_m, model::kLength)},
      {"height", Value::Number(wall->height_m, model::kLength)}};
  fired.edit.added.push_back(NewElement(
      state, std::make_shared<const model::Instance>(model::Instance{
                 model::MakePrototype(std::move(prototype)), geom::Affine::Identity()})));
  return fired;
}

constexpr Prompt kWallPrompts[] = {{"next corner of the line"}};
constexpr Key kWallKeys[] = {
    {"thickness", Type::kLength, "how thick", {}, {}, -1, true},
    {"height", Type::kLength, "above the active plane", {}, {}, -1, true},
    {"justify", Type::kWord, "where the line runs: along its left or right face, or in the middle",
     "left|centre|right", "centre"},
    {"closed", Type::kBoolean, "goes on from the last corner to the first", {}, "false"},
    {"openings", Type::kElements, "outlines on its faces that are holes through it"},
    kKeep};
constexpr Example kWallExamples[] = {
    {"place wall thickness=0.5m height=3m xy=0,0,0 xy=8,0,0 reset",
     "last.volume within 12m3 +- 0.000001m3"},
    {"place wall thickness=0.5m height=3m justify=left closed=true xy=0,0,0 xy=8,0,0 xy=8,6,0 "
     "xy=0,6,0 reset",
     "last.volume within 45m3 +- 0.000001m3"},
    {"{ set plane front; place block xy=2,0,1 xy=3,0,2 as window }\n"
     "place wall thickness=0.5m height=3m openings=window keep=true xy=0,0,0 xy=8,0,0 reset",
     "last.volume within 11.5m3 +- 0.000001m3"},
    {"place wall thickness=3m height=3m xy=0,0,0 xy=8,0,0 xy=8,1,0 xy=0,1,0 reset", "E0212"}};

constexpr Command kCommands[] = {
    {.words = "place wall",
     .family = "place",
     .summary = "A wall of a thickness and a height along a line of straight parts, mitred at its "
                "corners.",
     .manner = Manner::kGathers,
     .prompts = kWallPrompts,
     .least = 2,
     .keys = kWallKeys,
     .examples = kWallExamples,
     .execute = PlaceWall},
};

}  // namespace

std::span<const Command> PlaceWallCommands() { return kCommands; }

}  // namespace tranos::interp
