// SPDX-License-Identifier: GPL-3.0-or-later
// set plane: the active system.
#include "interp/commands/families.h"
#include "interp/commands/firing.h"

namespace tranos::interp {

using geom::Frame;
using geom::Vec3;
using model::State;

namespace {

constexpr double kParallel = 1e-9;

CommandError BadKey(std::string_view key, std::string message) {
  return {.code = Code::kDegenerate, .message = std::move(message), .where = {Where::kKey, 0, key}};
}

// The frame with this unit normal. Its x is the part of the wish in the plane; without a wish it
// lies level, as that of `front` and `right` does.
tl::expected<Frame, CommandError> FrameWith(const Vec3& origin, const Vec3& normal,
                                            const std::optional<Vec3>& x_wish) {
  const Vec3 level = Vec3::UnitZ().cross(normal);
  Vec3 x = level.norm() > kParallel ? level : Vec3::UnitX();
  if (x_wish) {
    x = *x_wish - x_wish->dot(normal) * normal;
    if (x.norm() <= kParallel * x_wish->norm()) {
      return Fail(BadKey("x", "the plane's x has no direction in the plane"));
    }
  }
  x.normalize();
  return Frame{origin, x, normal.cross(x)};
}

std::optional<std::string> DirectionWord(const Answers& answers) {
  for (const char* word : {"top", "front", "right"}) {
    if (answers.HasWord(word)) return word;
  }
  return std::nullopt;
}

tl::expected<Frame, CommandError> PlaneFrom(const State& state, const Answers& answers) {
  const Frame& before = state.drawing.settings->plane;
  const auto at = answers.Point("at"), normal = answers.Point("normal"), x = answers.Point("x");
  if (const model::Value* of = answers.Find("of"); of && of->kind() == model::Value::Kind::kPlane) {
    return Frame{at.value_or(of->plane().origin), of->plane().x, of->plane().y};
  }
  if (const auto word = DirectionWord(answers)) {
    const Frame frame = model::FrameOf(*word);
    return Frame{at.value_or(Vec3::Zero()), frame.x, frame.y};
  }
  const Vec3 origin = at.value_or(before.origin);
  if (!normal && !x) return Frame{origin, before.x, before.y};
  if (!normal) return FrameWith(origin, before.z(), x);
  if (normal->norm() <= geom::kCoincident_m) {
    return Fail(BadKey("normal", "a normal of no length has no direction"));
  }
  return FrameWith(origin, normal->normalized(), x);
}

// One way of saying it: a word, of=, or normal= and x=; at= goes with each.
std::optional<CommandError> Contradiction(const Answers& answers) {
  const int ways = static_cast<int>(answers.words.size()) + (answers.Has("of") ? 1 : 0) +
                   (answers.Has("normal") || answers.Has("x") ? 1 : 0);
  if (ways == 0 && !answers.Has("at")) {
    return CommandError{.code = Code::kMissingValue,
                        .message = "which plane?",
                        .help = "set plane front, or set plane at=[0,0,3] normal=[0,0,1]"};
  }
  if (ways <= 1) return std::nullopt;
  return CommandError{.code = Code::kWrongWords,
                      .message = "a plane is set by one word, by `of=`, or by `normal=` and `x=`"};
}

CommandResult SetPlane(const State& state, const Answers& answers) {
  if (auto error = Contradiction(answers)) return Fail(*error);
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto plane = PlaneFrom(state, answers);
  if (!plane) return Fail(plane.error());
  auto settings = std::make_shared<model::Settings>(*state.drawing.settings);
  settings->plane = *plane;
  Fired fired;
  fired.edit.settings = std::move(settings);
  return fired;
}

constexpr Key kKeys[] = {{"at", Type::kPoint, "its origin"},
                         {"normal", Type::kPoint, "a vector along its normal"},
                         {"x", Type::kPoint, "a vector along its x axis, level unless given"},
                         {"of", Type::kPlane, "a plane to take over"}};
constexpr Example kExamples[] = {
    {"set plane front; place circle xy=0,0,0 radius=2", "last.bbox.max.z within 2m +- 0.000001m"},
    {"set plane at=[0,0,3] normal=[1,0,0]; place line ax=0,0 dl=4", "last.bbox.max.y == 4m"},
    {"set plane normal=[0,0,1] x=[0,1,0]; place line ax=0,0 dl=4", "last.bbox.max.y == 4m"},
    {"set plane front; place circle radius=1 xy=0,0,0 as c; set plane top; set plane of=c.plane\n"
     "place point ax=0,2",
     "last.z == 2m"},
    {"set plane of=5", "E0203"},
    {"set plane normal=[0,0,0]", "E0501"}};

constexpr Command kCommands[] = {
    {.words = "set plane",
     .family = "set",
     .summary =
         "Sets the active plane, in which circles, blocks, text, rotations and offsets are drawn, "
         "until the closing brace.",
     .keys = kKeys,
     .options = "top|front|right",
     .examples = kExamples,
     .execute = SetPlane},
};

}  // namespace

std::span<const Command> PlaneCommands() { return kCommands; }

}  // namespace tranos::interp
