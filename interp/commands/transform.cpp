// SPDX-License-Identifier: GPL-3.0-or-later
// copy, move, rotate, mirror, scale: motions of what is chosen.
#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/placement.h"

namespace tranos::interp {

using geom::Affine;
using geom::Vec3;
using model::State;

namespace {

using Motion = tl::expected<Affine, CommandError>;
using MotionOf = Motion (*)(const State&, const Answers&);

Motion Displacement(const State&, const Answers& answers) {
  return Translation(answers.points[1] - answers.points[0]);
}

Motion Turn(const State& state, const Answers& answers) {
  const model::Settings& settings = *state.drawing.settings;
  const double angle_rad = answers.Number("angle", settings.angle_rad);
  return Rotation(answers.points[0], settings.plane.z(), angle_rad);
}

Motion MirrorImage(const State& state, const Answers& answers) {
  const Vec3 normal = state.drawing.settings->plane.z();
  const Vec3 across = normal.cross(answers.points[1] - answers.points[0]);
  if (across.norm() <= geom::kCoincident_m) {
    return Fail({.code = Code::kDegenerate,
                 .message = "the mirror's line has no length in the active plane",
                 .where = {Where::kPoint, 1, {}}});
  }
  return Reflection(answers.points[0], across.normalized());
}

Motion Enlargement(const State& state, const Answers& answers) {
  const model::Settings& settings = *state.drawing.settings;
  const Vec3 factors = settings.scale;
  if (!(factors.minCoeff() > 1e-9 && factors.maxCoeff() < 1e9)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = "a scale is above zero",
                 .help = "set it with `as=`; `mirror` turns things over"});
  }
  const Affine scaling = Scaling({answers.points[0], settings.plane.x, settings.plane.y}, factors);
  for (std::size_t i = 0; i < answers.chosen.size(); ++i) {
    const geom::Box box = model::BoundingBox(*answers.chosen[i]);
    if (box.empty()) continue;
    const Vec3 far = (scaling * box.min).cwiseAbs().cwiseMax((scaling * box.max).cwiseAbs());
    if (!(far.maxCoeff() <= kFarthest_m)) {
      return Fail({.code = Code::kOutOfRange,
                   .message = "scaled, this would reach more than a million kilometres away",
                   .where = {Where::kChosen, static_cast<int>(i), {}}});
    }
  }
  return scaling;
}

template <MotionOf kMotion, Fired (*kCarryOut)(const Answers&, const Affine&)>
CommandResult Carry(const State& state, const Answers& answers) {
  if (auto error = NothingToMove(answers)) return Fail(*error);
  if (auto error = TooFar(answers)) return Fail(*error);
  const Motion motion = kMotion(state, answers);
  if (!motion) return Fail(motion.error());
  return kCarryOut(answers, *motion);
}

constexpr Prompt kFromTo[] = {{"from"}, {"to"}};
constexpr Prompt kPivot[] = {{"pivot"}};
constexpr Prompt kAxis[] = {{"first point of the mirror's line"}, {"second point"}};
constexpr Prompt kOrigin[] = {{"point that stays"}};

constexpr Key kChosenKeys[] = {kOf};
constexpr Key kTurnKeys[] = {
    kOf, {"angle", Type::kAngle, "how far to turn, anticlockwise", {}, "the active angle aa"}};

constexpr Example kCopyExamples[] = {
    {"place line xy=0,0,0 dl=10; choose element xy=5,0,0; copy xy=5,0,0 dl=20",
     "last.bbox.min.x == 20m"},
    {"place point xy=0,0,0; copy of=last xy=0,0,0 dl=2 dl=2 reset", "last.bbox.min.x == 4m"},
    {"copy xy=0,0,0 dl=5", "E0404"}};
constexpr Example kMoveExamples[] = {
    {"place point xy=1,0,0; move of=last xy=0,0,0 dl=3", "last.x == 4m"},
    {"place point xy=1,0,0; choose element xy=1,0,0; move xy=0,0,0 dl=0,5",
     "last.bbox.max.y == 5m"},
    {"move xy=0,0,0 dl=5", "E0404"}};
constexpr Example kRotateExamples[] = {
    {"place line xy=0,0,0 dl=10; choose element xy=5,0,0; aa=90; rotate xy=0,0,0",
     "last.bbox.max.y == 10m"},
    {"place line xy=0,0,0 dl=10; rotate of=last angle=-90 xy=0,0,0", "last.bbox.min.y == -10m"},
    {"rotate xy=0,0,0", "E0404"}};
constexpr Example kRotateCopyExamples[] = {
    {"place line xy=0,0,0 dl=5; rotate copy of=last angle=90 xy=0,0,0", "last.bbox.max.y == 5m"},
    {"place line xy=0,0,0 dl=30; choose last; aa=90; rotate copy xy=30,0,0 xy=30,-30,0 reset",
     "last.bbox.min.y == -30m"},
    {"place line xy=0,0,0 dl=10; choose last; rotate copy angle=180 xy=0,0,0",
     "last.bbox.min.x == -10m"},
    {"rotate copy xy=0,0,0", "E0404"}};
constexpr Example kMirrorExamples[] = {
    {"place point xy=3,1,0; mirror of=last xy=0,0,0 xy=1,0,0", "last.y == -1m"},
    {"place point xy=3,1,0; choose last; mirror xy=0,0,0 xy=0,9,0",
     "last.bbox.min.x within -3m +- 0.000001m"},
    {"place point xy=3,1,0; choose last; mirror xy=0,0,0 xy=0,0,0", "E0501"}};
constexpr Example kMirrorCopyExamples[] = {
    {"place point xy=3,1,0 as p; mirror copy of=p xy=0,0,0 xy=0,1,0", "last.x == -3m"},
    {"place point xy=3,1,0; choose last; mirror copy xy=0,0,0 xy=1,0,0; choose all\n"
     "move xy=0,0,0 dl=0,0,2",
     "len(last) == 2"},
    {"place point xy=3,1,0; choose last; mirror copy xy=0,0,0 xy=0,0,5", "E0501"}};
constexpr Example kScaleExamples[] = {
    {"place line xy=0,0,0 dl=2; as=2; scale of=last xy=0,0,0", "last.length == 4m"},
    {"place line xy=1,0,0 dl=1; choose last; as=3; scale xy=0,0,0", "last.bbox.max.x == 6m"},
    {"place line xy=1,0,0 dl=1; choose last; as=1,2,1; scale xy=0,0,0", "last.length == 1m"},
    {"scale xy=0,0,0", "E0404"}};

constexpr Command kCommands[] = {
    {.words = "copy",
     .family = "manipulate",
     .summary = "Copies what is chosen from one point to another, then from there to the next.",
     .manner = Manner::kTransforms,
     .prompts = kFromTo,
     .again = 1,
     .carries = true,
     .keys = kChosenKeys,
     .examples = kCopyExamples,
     .execute = Carry<Displacement, CopyChosen>},
    {.words = "move",
     .family = "manipulate",
     .summary = "Moves what is chosen from one point to another, then from there to the next.",
     .manner = Manner::kTransforms,
     .prompts = kFromTo,
     .again = 1,
     .carries = true,
     .keys = kChosenKeys,
     .examples = kMoveExamples,
     .execute = Carry<Displacement, MoveChosen>},
    {.words = "rotate",
     .family = "manipulate",
     .summary = "Turns what is chosen about a pivot in the active plane, by the active angle.",
     .manner = Manner::kTransforms,
     .prompts = kPivot,
     .keys = kTurnKeys,
     .examples = kRotateExamples,
     .execute = Carry<Turn, MoveChosen>},
    {.words = "rotate copy",
     .family = "manipulate",
     .summary =
         "Makes a copy turned about a pivot by the active angle; each further pivot turns the "
         "newest copy.",
     .manner = Manner::kTransforms,
     .prompts = kPivot,
     .keys = kTurnKeys,
     .examples = kRotateCopyExamples,
     .execute = Carry<Turn, CopyChosen>},
    {.words = "mirror",
     .family = "manipulate",
     .summary = "Turns what is chosen over to the other side of a line in the active plane.",
     .manner = Manner::kTransforms,
     .prompts = kAxis,
     .keys = kChosenKeys,
     .examples = kMirrorExamples,
     .execute = Carry<MirrorImage, MoveChosen>},
    {.words = "mirror copy",
     .family = "manipulate",
     .summary = "Makes the mirror image of what is chosen beyond a line in the active plane.",
     .manner = Manner::kTransforms,
     .prompts = kAxis,
     .keys = kChosenKeys,
     .examples = kMirrorCopyExamples,
     .execute = Carry<MirrorImage, CopyChosen>},
    {.words = "scale",
     .family = "manipulate",
     .summary =
         "Enlarges or reduces what is chosen about a point by the active scale; three numbers "
         "scale along the active plane's axes.",
     .manner = Manner::kTransforms,
     .prompts = kOrigin,
     .keys = kChosenKeys,
     .examples = kScaleExamples,
     .execute = Carry<Enlargement, MoveChosen>},
};

}  // namespace

std::span<const Command> TransformCommands() { return kCommands; }

}  // namespace tranos::interp
