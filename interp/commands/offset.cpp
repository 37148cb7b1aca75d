// SPDX-License-Identifier: GPL-3.0-or-later
// offset: parallel curves.
#include "geom/offset.h"

#include <fmt/format.h>

#include <cmath>

#include "geom/crossing.h"
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/range.h"

namespace tranos::interp {

using geom::Vec3;
using model::State;

namespace {

// Of curves of more pieces, trying how far they could be offset would take long.
constexpr std::size_t kMostTried = 100;

// The normal of the plane in which the parallel lies: the curve's own; a straight one's is the
// active plane if it lies along that, or else the plane through the data point.
std::optional<Vec3> NormalFor(const State& state, const geom::Curve& curve, const Vec3& p) {
  if (const auto plane = geom::PlaneOf(curve)) return plane->z();
  const Vec3 start = geom::PointAt(curve, 0);
  const Vec3 along = (geom::PointAt(curve, 1) - start).normalized();
  const Vec3 active = state.drawing.settings->plane.z();
  if (std::abs(along.dot(active)) <= 1e-9) return active;
  const Vec3 normal = along.cross(p - start);
  if (normal.norm() <= kOffPlane_m) return std::nullopt;
  return normal.normalized();
}

// The signed distance of a point, to the left of the curve positive; nothing if it lies on the
// curve or straight ahead of an end.
std::optional<double> SignedDistance(const geom::Curve& curve, const Vec3& normal, const Vec3& p) {
  constexpr double kStep = 1e-6;
  const Vec3 in_plane = p - normal.dot(p - geom::PointAt(curve, 0)) * normal;
  const geom::Nearest nearest = geom::NearestPoint(curve, in_plane);
  const Vec3 aside = in_plane - nearest.point;
  // At a corner the direction is that of its bisector.
  const bool closed = geom::IsClosed(curve);
  const auto at = [&](double t) { return closed ? t - std::floor(t) : std::clamp(t, 0.0, 1.0); };
  const Vec3 along =
      geom::TangentAt(curve, at(nearest.t - kStep)) + geom::TangentAt(curve, at(nearest.t + kStep));
  const double side = normal.cross(along).dot(aside);
  if (std::abs(side) <= 1e-9 * std::max(1.0, aside.norm())) return std::nullopt;
  return std::copysign(nearest.distance_m, side);
}

CommandError OnTheCurve() {
  return {.code = Code::kDegenerate,
          .message = "this point is on neither side of the curve",
          .label = "a point beside the curve says where the parallel lies",
          .where = AtPoint(0)};
}

tl::expected<std::vector<geom::Curve>, CommandError> ParallelsOf(const State& state,
                                                                 const Answers& answers,
                                                                 const geom::Curve& curve,
                                                                 std::size_t index) {
  const auto normal = NormalFor(state, curve, answers.points[0]);
  const auto signed_m = normal ? SignedDistance(curve, *normal, answers.points[0]) : std::nullopt;
  if (!signed_m) return Fail(OnTheCurve());
  const double distance_m = answers.Number("distance", std::abs(*signed_m));
  const auto join =
      answers.HasWord("rounded") ? geom::OffsetJoin::kRounded : geom::OffsetJoin::kMitred;
  const auto at = [&](double d) {
    return geom::Offset(curve, *normal, std::copysign(d, *signed_m), join);
  };
  auto parallels = at(distance_m);
  if (!parallels) return Fail(FromGeom(parallels.error(), "a parallel", AtChosen(index)));
  if (!parallels->empty()) return *std::move(parallels);
  const auto works = [&](double d) {
    const auto tried = at(d);
    return tried && !tried->empty();
  };
  const bool quick = geom::CountPieces(curve) <= kMostTried;
  const double largest_m = quick ? LargestThatWorks(distance_m, works) : 0;
  return Fail({.code = Code::kOutOfRange,
               .message = fmt::format("nothing is left of the {} at a distance of {}",
                                      model::TypeOf(*answers.chosen[index]),
                                      InWords(distance_m, *state.drawing.settings)),
               .label = RangeInWords(largest_m, *state.drawing.settings),
               .where = answers.Has("distance") ? AtKey("distance") : AtPoint(0)});
}

CommandResult OffsetCurves(const State& state, const Answers& answers) {
  if (auto error = TooFar(answers)) return Fail(*error);
  if (answers.words.size() > 1) {
    return Fail({.code = Code::kWrongWords, .message = "corners are mitred or rounded, not both"});
  }
  if (answers.Has("distance") && answers.Number("distance") <= geom::kCoincident_m) {
    return Fail({.code = Code::kOutOfRange,
                 .message = "a parallel lies at a distance above zero",
                 .help = "the data point says on which side",
                 .where = AtKey("distance")});
  }
  const auto curves = CurvesOf(answers, "a parallel");
  if (!curves) return Fail(curves.error());
  Fired fired;
  for (std::size_t i = 0; i < curves->size(); ++i) {
    auto parallels = ParallelsOf(state, answers, (*curves)[i], i);
    if (!parallels) return Fail(parallels.error());
    for (geom::Curve& parallel : *parallels) {
      fired.edit.added.push_back(NewElement(state, CurveGeometry(std::move(parallel))));
    }
  }
  return fired;
}

constexpr Prompt kPrompts[] = {{"point on the side of the parallel"}};
constexpr Key kKeys[] = {
    kOf, {"distance", Type::kLength, "from the curve; through the point unless given"}};
constexpr Example kExamples[] = {
    {"place block xy=0,0,0 xy=6,4,0 as room; offset of=room distance=0.5 xy=-1,0,0",
     "last.area within 35m2 +- 0.000001m2"},
    {"place block xy=0,0,0 xy=6,4,0; choose all; offset rounded distance=1 xy=-1,0,0",
     "last.area within 47.1415927m2 +- 0.0000001m2"},
    {"place circle radius=3 xy=0,0,0 as rim; offset of=rim xy=1,0,0", "last.radius == 1m"},
    {"place circle radius=3 xy=0,0,0 as rim; offset of=rim distance=3 xy=1,0,0", "E0212"},
    {"place line xy=0,0,0 dl=4 as sill; offset of=sill xy=2,0,0", "E0501"}};

constexpr Command kCommands[] = {
    {.words = "offset",
     .family = "manipulate",
     .summary = "A parallel of curves made of lines and arcs, on the side of the data point: at a "
                "distance, or through the point; corners mitred or rounded, and cut back where it "
                "would cross itself.",
     .manner = Manner::kTransforms,
     .prompts = kPrompts,
     .keys = kKeys,
     .options = "mitred|rounded",
     .examples = kExamples,
     .execute = OffsetCurves},
};

}  // namespace

std::span<const Command> OffsetCommands() { return kCommands; }

}  // namespace tranos::interp
