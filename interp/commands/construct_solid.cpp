// SPDX-License-Identifier: GPL-3.0-or-later
// construct solid: from outlines that are projected, turned, swept or lofted, and from surfaces.
#include <fmt/format.h>

#include <cmath>

#include "geom/closed_surface.h"
#include "geom/join_faces.h"
#include "geom/swept_solid.h"
#include "interp/commands/construction.h"
#include "interp/commands/families.h"
#include "interp/commands/placement.h"
#include "interp/commands/solids.h"

namespace tranos::interp {

using geom::Curve;
using geom::Vec3;
using model::State;

namespace {

const geom::Tolerance& ToleranceOf(const State& state) { return state.drawing.settings->tolerance; }

using Curves = std::vector<Curve>;

// One solid from each of the chosen outlines.
template <class F>
CommandResult FromEachOutline(const State& state, const Answers& answers, std::string_view what,
                              const F& make) {
  std::vector<model::Geometry> solids;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const auto outline = OutlineOfElement(*answers.chosen[i], what, AtChosen(i));
    if (!outline) return Fail(outline.error());
    auto solid = SolidGeometry(make(*outline), what, AtChosen(i));
    if (!solid) return Fail(solid.error());
    solids.push_back(*std::move(solid));
  }
  return MakeFromChosen(state, answers, std::move(solids));
}

CommandResult Projection(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto vector = ProjectionVector(state, answers);
  if (!vector) return Fail(vector.error());
  return FromEachOutline(state, answers, "a projection", [&](const Curves& outline) {
    return geom::ProjectionMesh(outline, *vector, ToleranceOf(state));
  });
}

CommandResult Revolution(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto turn = TurnOf(answers);
  if (!turn) return Fail(turn.error());
  return FromEachOutline(state, answers, "a revolution", [&](const Curves& outline) {
    return geom::RevolutionMesh(outline, turn->point, turn->axis, turn->angle_rad,
                                ToleranceOf(state));
  });
}

// The profile's own axes: the active plane's where it lies in that, else x level and y as far
// upward as may be.
geom::Frame ProfileFrame(const geom::Frame& profile, const geom::Frame& active) {
  const Vec3 normal = profile.z();
  if (std::abs(normal.dot(active.z())) > 1 - 1e-9) return {profile.origin, active.x, active.y};
  Vec3 x = Vec3::UnitZ().cross(normal);
  if (!(x.norm() > 1e-9)) return {profile.origin, Vec3::UnitX(), Vec3::UnitY()};
  x.normalize();
  Eigen::Index largest = 0;
  x.cwiseAbs().maxCoeff(&largest);
  if (x[largest] < 0) x = -x;
  Vec3 y = normal.cross(x);
  if (y.z() < 0) y = -y;
  return {profile.origin, x, y};
}

Curves Moved(Curves curves, const geom::Affine& target_from_source) {
  for (Curve& curve : curves) curve = geom::Transformed(curve, target_from_source);
  return curves;
}

// Where the profile stands at the path's start, it is swept as it is. Another is brought there by
// `at=`, or the active system's origin; one that does not stand squarely to the path is turned,
// too.
geom::Result<geom::TriangleMesh> SweptMesh(const State& state, const Answers& answers,
                                           const Curves& profile, const Curve& path) {
  const geom::Frame& active = state.drawing.settings->plane;
  const geom::Tolerance& tolerance = ToleranceOf(state);
  const auto at = answers.Point("at");
  if (!at && geom::StandsAtStart(profile[0], path)) {
    return geom::SweepMeshInPlace(profile, path, tolerance);
  }
  const std::optional<geom::Frame> plane = geom::PlaneOf(profile[0]);
  if (!plane) {
    return tl::unexpected(geom::Error{geom::ErrorCode::kNotPlanar, "the profile is not planar"});
  }
  const Vec3 along = geom::TangentAt(path, 0);
  const Vec3 origin = at.value_or(active.origin);
  const Vec3 foot = origin + (plane->origin - origin).dot(plane->z()) * plane->z();
  if (along.cross(plane->z()).norm() <= 1e-6) {
    const Curves moved = Moved(profile, Translation(geom::PointAt(path, 0) - foot));
    return geom::SweepMeshInPlace(moved, path, tolerance);
  }
  geom::Frame frame = ProfileFrame(*plane, active);
  frame.origin = foot;
  const bool upward = along.cross(active.z()).norm() <= 1e-6;
  return geom::SweepMesh(Moved(profile, frame.WorldFromFrame().inverse()), path,
                         upward ? active.y : active.z(), tolerance);
}

CommandResult Sweep(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto profiles = ElementsOf(state, answers, "profile"),
             paths = ElementsOf(state, answers, "path");
  if (!profiles) return Fail(profiles.error());
  if (!paths) return Fail(paths.error());
  const auto profile = OutlineOfElement(*profiles->front(), "a sweep", AtKey("profile"));
  if (!profile) return Fail(profile.error());
  const auto path = CurveOfElement(*paths->front(), "a path", AtKey("path"));
  if (!path) return Fail(path.error());
  auto solid = SolidGeometry(SweptMesh(state, answers, *profile, *path), "a sweep", AtKey("path"));
  if (!solid) return Fail(solid.error());
  Fired fired;
  fired.edit.added.push_back(NewElement(state, *std::move(solid)));
  if (answers.Flag("keep")) return fired;
  fired.edit.consumed = {profiles->front()->id};
  if (paths->front()->id != profiles->front()->id) {
    fired.edit.consumed.push_back(paths->front()->id);
  }
  return fired;
}

CommandResult Loft(const State& state, const Answers& answers) {
  std::vector<geom::Face> faces;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const model::Element& element = *answers.chosen[i];
    auto face = OutlineOfElement(element, "a loft", AtChosen(i));
    if (!face) return Fail(face.error());
    const auto* region = std::get_if<model::RegionPtr>(&element.geometry);
    if (region && (*region)->parts.size() != 1) {
      return Fail({.code = Code::kWrongElement,
                   .message = fmt::format("a loft goes through faces of one part, and {} has {}",
                                          NameForMessage(element), (*region)->parts.size()),
                   .where = AtChosen(i)});
    }
    faces.push_back(*std::move(face));
    if (faces.back().size() == faces.front().size()) continue;
    return Fail({.code = Code::kWrongCount,
                 .message = fmt::format("a loft goes through faces with equally many holes, and {} "
                                        "has {}, not {}",
                                        NameForMessage(element), faces.back().size() - 1,
                                        faces.front().size() - 1),
                 .where = AtChosen(i)});
  }
  auto solid = geom::LoftSolid(faces, ToleranceOf(state));
  if (!solid) return Fail(FromGeom(solid.error(), "a loft"));
  return MakeFromChosen(state, answers, {std::make_shared<const geom::Solid>(*std::move(solid))});
}

// The surfaces among the chosen, and the regions and closed curves, which stand for faces.
struct Faces {
  std::vector<geom::Surface> surfaces;
  std::vector<geom::Face> plane;
};
tl::expected<Faces, CommandError> FacesOf(const Answers& answers, std::string_view what) {
  Faces faces;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const model::Element& element = *answers.chosen[i];
    if (const auto* surface = std::get_if<model::SurfacePtr>(&element.geometry)) {
      faces.surfaces.push_back(**surface);
      continue;
    }
    if (!std::holds_alternative<model::RegionPtr>(element.geometry) &&
        !std::holds_alternative<model::CurvePtr>(element.geometry)) {
      return Fail({.code = Code::kWrongElement,
                   .message = fmt::format("{} is made from surfaces, regions and closed outlines, "
                                          "and this is {}",
                                          what, NameForMessage(element)),
                   .where = AtChosen(i)});
    }
    auto outline = OutlineOfElement(element, what, AtChosen(i));
    if (!outline) return Fail(outline.error());
    faces.plane.push_back(*std::move(outline));
  }
  return faces;
}

CommandResult Thicken(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto faces = FacesOf(answers, "a thickened solid");
  if (!faces) return Fail(faces.error());
  const double thickness_m = answers.Number("thickness");
  if (!(thickness_m > geom::kCoincident_m)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = fmt::format("`thickness` is {}, and must be above zero",
                                        InWords(thickness_m, *state.drawing.settings)),
                 .label = "above 0",
                 .help = "`side=inward` thickens to the other side",
                 .where = AtKey("thickness")});
  }
  const std::string side = answers.Text("side", "outward");
  const double outward = side == "outward" ? 1 : side == "inward" ? 0 : 0.5;
  auto solid =
      SolidGeometry(geom::ThickenedMesh(faces->surfaces, faces->plane, outward * thickness_m,
                                        (1 - outward) * thickness_m, ToleranceOf(state)),
                    "a thickened solid", AtKey("thickness"));
  if (!solid) return Fail(solid.error());
  return MakeFromChosen(state, answers, {*std::move(solid)});
}

CommandResult Joined(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  std::vector<geom::Polyline> outlines;
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const auto* curve = std::get_if<model::CurvePtr>(&answers.chosen[i]->geometry);
    const auto* outline = curve ? std::get_if<geom::Polyline>(curve->get()) : nullptr;
    if (!outline) {
      return Fail({.code = Code::kWrongElement,
                   .message = fmt::format("shapes with straight edges are joined, and this is {}",
                                          NameForMessage(*answers.chosen[i])),
                   .where = AtChosen(i)});
    }
    outlines.push_back(*outline);
  }
  const double within_m = answers.Number("within", state.drawing.settings->locate_tolerance_m);
  if (!(within_m > geom::kCoincident_m)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = "corners that are to be joined lie apart by more than nothing",
                 .label = "above 0",
                 .where = AtKey("within")});
  }
  auto joined = geom::JoinFaces(outlines, within_m);
  if (!joined) {
    CommandError error = FromGeom(joined.error(), "a joint");
    error.help = fmt::format("corners within {} of each other become one; `within=` takes others",
                             InWords(within_m, *state.drawing.settings));
    return Fail(std::move(error));
  }
  Fired fired;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    fired.edit.replaced.push_back(
        model::WithGeometry(*answers.chosen[i], CurveGeometry(std::move((*joined)[i]))));
  }
  return fired;
}

CommandResult FromSurfaces(const State& state, const Answers& answers) {
  const auto faces = FacesOf(answers, "a solid");
  if (!faces) return Fail(faces.error());
  auto solid = SolidGeometry(geom::EnclosedMesh(faces->surfaces, faces->plane, ToleranceOf(state)),
                             "a solid");
  if (!solid) return Fail(solid.error());
  return MakeFromChosen(state, answers, {*std::move(solid)});
}

constexpr Prompt kOutlinePrompts[] = {{"outline or region, or a point off everything to accept"}};
constexpr Prompt kSurfacePrompts[] = {{"surface or region, or a point off everything to accept"}};

constexpr Key kSweepKeys[] = {
    {"profile", Type::kElement, "the closed outline or region that is carried", {}, {}, -1, true},
    {"path", Type::kElement, "the curve along which it is carried", {}, {}, -1, true},
    {"at",
     Type::kPoint,
     "the profile's point that runs along the path: its x then goes to the right of the path and "
     "its y upward",
     {},
     "where it stands, or the active system's origin"},
    kKeep};
constexpr Key kLoftKeys[] = {kOf, kKeep};
constexpr Key kThickenKeys[] = {
    kOf,
    kKeep,
    {"thickness", Type::kLength, "how thick", {}, {}, -1, true},
    {"side", Type::kWord, "to which side of the surface", "outward|inward|centre", "outward"}};

constexpr Example kProjectionExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0 as base; construct solid projection of=base height=2m",
     "last.volume within 24m3 +- 0.000001m3"},
    {"place block xy=0,0,0 xy=4,3,0 as base\n"
     "construct solid projection of=base from=[0,0,0] to=[1,0,2] keep=true",
     "last.volume within 24m3 +- 0.000001m3"},
    {"place block xy=0,0,0 xy=4,3,0 as base\n"
     "construct solid projection of=base direction=[0,0,-1] height=2m",
     "last.bbox.min.z == -2m"},
    {"place line xy=0,0,0 dl=4 as base; construct solid projection of=base height=2m", "E0503"}};
constexpr Example kRevolutionExamples[] = {
    {"set plane front; place block xy=1,0,0 xy=2,0,3 as side; fn=4\n"
     "construct solid revolution of=side from=[0,0,0] to=[0,0,1] keep=true",
     "last.volume within 18m3 +- 0.000001m3"},
    {"set plane front; place block xy=0,0,0 xy=2,0,3 as side; fn=4\n"
     "construct solid revolution of=side from=[0,0,0] to=[0,0,1] angle=90deg",
     "last.volume within 6m3 +- 0.000001m3"},
    {"set plane front; place block xy=-1,0,0 xy=2,0,3 as side\n"
     "construct solid revolution of=side from=[0,0,0] to=[0,0,1]",
     "E0212"}};
constexpr Example kSweepExamples[] = {
    {"place block xy=0,0,0 xy=0.2,0.3,0 as moulding\n"
     "place block xy=5,5,3 xy=15,11,3 as eaves\n"
     "construct solid sweep profile=moulding path=eaves",
     "last.volume within 1.968m3 +- 0.000001m3"},
    {"place block xy=7,7,0 xy=7.2,7.3,0 as moulding; place line xy=0,0,3 dl=10 as eaves\n"
     "construct solid sweep profile=moulding path=eaves at=[7,7,0] keep=true",
     "last.bbox.max.z == 3.3m"},
    {"place block xy=0,0,0 xy=2,2,0 as p; place circle xy=9,0,0 radius=1m as ring\n"
     "construct solid sweep profile=p path=ring at=[3,0,0]",
     "E0212"}};
constexpr Example kLoftExamples[] = {
    {"place block xy=0,0,0 xy=4,4,0 as below; place block xy=1,1,3 xy=3,3,3 as above\n"
     "construct solid loft of=[below, above]",
     "last.volume within 28m3 +- 0.000001m3"},
    {"place block xy=0,0,0 xy=4,4,0 as below; place circle xy=2,2,3 radius=1m as above\n"
     "construct solid loft of=[below, above] keep=true",
     "last.closed"},
    {"place block xy=0,0,0 xy=4,4,0 as below; place line xy=0,0,3 dl=4 as above\n"
     "construct solid loft of=[below, above]",
     "E0503"}};
constexpr Example kThickenExamples[] = {
    {"place line xy=0,0,0 dl=4 as base; construct surface projection of=base height=3m as face\n"
     "construct solid thicken of=face thickness=0.5m keep=true",
     "last.volume within 6m3 +- 0.000001m3"},
    {"place line xy=0,0,0 dl=4 as base; construct surface projection of=base height=3m as face\n"
     "construct solid thicken of=face thickness=0.5m side=centre",
     "last.bbox.max.y == 0.25m"},
    {"place line xy=0,0,0 dl=4 as base; construct surface projection of=base height=3m as face\n"
     "construct solid thicken of=face thickness=0m",
     "E0212"}};
constexpr Example kFromSurfacesExamples[] = {
    {"place block xy=0,0,0 xy=4,3,0 as base; place block xy=0,0,2 xy=4,3,2 as lid\n"
     "construct surface projection of=base height=2m keep=true as sides\n"
     "construct solid from surfaces of=[base, sides, lid] keep=true",
     "last.volume within 24m3 +- 0.000001m3"},
    {"place block xy=0,0,0 xy=4,3,0 as base; construct surface projection of=base height=2m as s\n"
     "construct solid from surfaces of=[s]",
     "E0503"}};

constexpr Key kJoinedKeys[] = {
    kOf, {"within", Type::kLength, "how far apart corners are that become one", {}, "`lt`"}};
constexpr Example kJoinedExamples[] = {
    {"place shape xy=0,0,0 xy=4,0,0 xy=4,0,3 xy=0,0,3 as front\n"
     "place shape xy=4,0,0.02 xy=4,5,0 xy=4,5,3 xy=4,0.03,3 as side\n"
     "construct joined of=[front, side] within=5cm",
     "abs(side.area - 14.975m2) < 0.001m2"},
    {"place shape xy=0,0,0 xy=4,0,0 xy=4,0,3 as front\n"
     "place shape xy=4,1,0 xy=4,5,0 xy=4,5,3 as side\n"
     "construct joined of=[front, side]",
     "E0502"}};

constexpr Command kCommands[] = {
    {.words = "construct solid projection",
     .family = "construct",
     .summary =
         "Projects a closed outline or region along a straight line into a solid: a plan into a "
         "pier, a moulding's section into a length of it.",
     .manner = Manner::kPicks,
     .prompts = kOutlinePrompts,
     .keys = kProjectionKeys,
     .examples = kProjectionExamples,
     .execute = Projection},
    {.words = "construct solid revolution",
     .family = "construct",
     .summary =
         "Turns a closed outline or region about an axis in its plane into a solid: a column, a "
         "baluster, a dome's shell.",
     .manner = Manner::kPicks,
     .prompts = kOutlinePrompts,
     .keys = kRevolutionKeys,
     .examples = kRevolutionExamples,
     .execute = Revolution},
    {.words = "construct solid sweep",
     .family = "construct",
     .summary =
         "Carries a closed outline or region along a path without twist, mitred at its corners: a "
         "cornice, an archivolt, a rail.",
     .keys = kSweepKeys,
     .examples = kSweepExamples,
     .execute = Sweep},
    {.words = "construct solid loft",
     .family = "construct",
     .summary = "Joins a row of closed outlines or regions, in the order in which they are chosen, "
                "into a solid.",
     .manner = Manner::kPicks,
     .prompts = kOutlinePrompts,
     .least = 2,
     .keys = kLoftKeys,
     .examples = kLoftExamples,
     .execute = Loft},
    {.words = "construct solid thicken",
     .family = "construct",
     .summary = "Gives surfaces and plane faces a thickness: a vault, a shell of a dome. Those "
                "that meet are "
                "thickened as one.",
     .manner = Manner::kPicks,
     .prompts = kSurfacePrompts,
     .keys = kThickenKeys,
     .examples = kThickenExamples,
     .execute = Thicken},
    {.words = "construct joined",
     .family = "construct",
     .summary = "Brings plane shapes that were measured one by one, such as the facades of a "
                "house, to common corners and edges; each stays in its plane.",
     .manner = Manner::kEdits,
     .prompts = kSurfacePrompts,
     .least = 2,
     .keys = kJoinedKeys,
     .examples = kJoinedExamples,
     .execute = Joined},
    {.words = "construct solid from surfaces",
     .family = "construct",
     .summary =
         "Fills what surfaces, regions, and closed plane outlines as faces, enclose together.",
     .manner = Manner::kPicks,
     .prompts = kSurfacePrompts,
     .keys = kLoftKeys,
     .examples = kFromSurfacesExamples,
     .execute = FromSurfaces},
};

}  // namespace

std::span<const Command> ConstructSolidCommands() { return kCommands; }

}  // namespace tranos::interp
