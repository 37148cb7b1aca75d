// SPDX-License-Identifier: GPL-3.0-or-later
// array: many copies in a grid, about a centre or along a curve. A count includes the original.
#include <fmt/format.h>

#include <cmath>

#include "interp/commands/families.h"
#include "interp/commands/firing.h"
#include "interp/commands/placement.h"

namespace tranos::interp {

using geom::Affine;
using geom::Vec3;
using model::State;

namespace {

// One array makes at most as many copies as a run may hold elements by default.
constexpr double kMostCopies = 1e6;

std::optional<CommandError> BadCount(double count, const Answers& answers, Where where) {
  if (count < 2) {
    return CommandError{.code = Code::kOutOfRange,
                        .message = "an array of one makes nothing",
                        .label = "the count includes the original",
                        .where = where};
  }
  if ((count - 1) * static_cast<double>(answers.chosen.size()) > kMostCopies) {
    return CommandError{.code = Code::kOutOfRange,
                        .message = "an array makes at most a million elements",
                        .where = where};
  }
  return std::nullopt;
}

void AddCopies(const Answers& answers, const Affine& target_from_source, Fired* fired) {
  for (const model::ElementPtr& element : answers.chosen) {
    fired->edit.added.push_back(FreshCopy(*element, target_from_source));
  }
}

CommandResult Rectangular(const State& state, const Answers& answers) {
  if (auto error = NothingToMove(answers)) return Fail(*error);
  if (auto error = TooFar(answers)) return Fail(*error);
  const double columns = answers.Number("columns", 1), rows = answers.Number("rows", 1),
               layers = answers.Number("layers", 1);
  if (std::min({columns, rows, layers}) < 1) {
    return Fail({.code = Code::kOutOfRange, .message = "columns, rows and layers are at least 1"});
  }
  if (auto error = BadCount(columns * rows * layers, answers, {})) return Fail(*error);
  const geom::Frame& plane = state.drawing.settings->plane;
  const Vec3 along_x = answers.Number("column_spacing") * plane.x,
             along_y = answers.Number("row_spacing") * plane.y,
             along_z = answers.Number("layer_spacing") * plane.z();
  Fired fired;
  for (int k = 0; k < static_cast<int>(layers); ++k) {
    for (int j = 0; j < static_cast<int>(rows); ++j) {
      for (int i = 0; i < static_cast<int>(columns); ++i) {
        if (i + j + k == 0) continue;
        AddCopies(answers, Translation(i * along_x + j * along_y + k * along_z), &fired);
      }
    }
  }
  return fired;
}

// A full turn has its last copy one step before the original; anything less ends on its angle.
double PolarStep(double angle_rad, int count) {
  const bool full = std::abs(std::abs(angle_rad) - 2 * geom::kPi) < 1e-9;
  return angle_rad / (full ? count : count - 1);
}

CommandResult Polar(const State& state, const Answers& answers) {
  if (auto error = NothingToMove(answers)) return Fail(*error);
  if (auto error = TooFar(answers)) return Fail(*error);
  if (auto error = BadCount(answers.Number("count"), answers, {Where::kKey, 0, "count"})) {
    return Fail(*error);
  }
  const Vec3 &centre = answers.points[0], axis = state.drawing.settings->plane.z();
  const int count = static_cast<int>(answers.Number("count"));
  const double step_rad = PolarStep(answers.Number("angle", 2 * geom::kPi), count);
  const bool align = answers.Flag("align", true);
  Fired fired;
  for (int i = 1; i < count; ++i) {
    const Affine turn = Rotation(centre, axis, i * step_rad);
    for (const model::ElementPtr& element : answers.chosen) {
      const Vec3 middle = model::BoundingBox(*element).centre();
      const Affine motion = align ? turn : Translation(turn * middle - middle);
      fired.edit.added.push_back(FreshCopy(*element, motion));
    }
  }
  return fired;
}

tl::expected<geom::Curve, CommandError> PathOf(const Answers& answers) {
  const model::Value* value = answers.Find("path");
  const auto* curve = value && value->is_element() && value->element()
                          ? std::get_if<model::CurvePtr>(&value->element()->geometry)
                          : nullptr;
  if (curve) return **curve;
  return Fail({.code = value ? Code::kWrongElement : Code::kMissingValue,
               .message = value ? "a path is a curve" : "the path is missing",
               .help = "`path=` takes a line, an arc, a chain …",
               .where = value ? Where{Where::kKey, 0, "path"} : Where{}});
}

// The lengths along the path at which copies stand, the original's 0 left out.
tl::expected<std::vector<double>, CommandError> Stations(const Answers& answers,
                                                         const geom::Curve& path) {
  const double length_m = geom::Length(path);
  const bool closed = geom::IsClosed(path);
  const double spacing_m = answers.Number("spacing");
  if (!answers.Has("count") && !(spacing_m > 0)) {
    return Fail({.code = Code::kMissingValue,
                 .message = "an array along a path needs `count=`, or a `spacing=` above zero"});
  }
  const double fitting = std::floor(length_m / spacing_m + 1e-9) + (closed ? 0 : 1);
  const double count = answers.Has("count") ? answers.Number("count") : fitting;
  const Where where = {Where::kKey, 0, answers.Has("count") ? "count" : "spacing"};
  if (auto error = BadCount(count, answers, where)) return Fail(*error);
  if (answers.Has("spacing") && answers.Has("count") && !(spacing_m > 0 && count <= fitting)) {
    return Fail({.code = Code::kOutOfRange,
                 .message = "so many do not fit on the path at this spacing",
                 .where = where});
  }
  const double step_m =
      answers.Has("spacing") ? spacing_m : length_m / (closed ? count : count - 1);
  std::vector<double> stations;
  for (int i = 1; i < static_cast<int>(count); ++i) stations.push_back(i * step_m);
  return stations;
}

// The direction of the path about the axis, as an angle; nothing where the path runs along it.
std::optional<double> Heading(const geom::Curve& path, const Vec3& at, const geom::Frame& plane) {
  const Vec3 tangent = geom::TangentAt(path, geom::NearestPoint(path, at).t);
  const double x = tangent.dot(plane.x), y = tangent.dot(plane.y);
  if (std::hypot(x, y) < 1e-9) return std::nullopt;
  return std::atan2(y, x);
}

CommandResult AlongPath(const State& state, const Answers& answers) {
  if (auto error = NothingToMove(answers)) return Fail(*error);
  if (auto error = TooFar(answers)) return Fail(*error);
  const auto path = PathOf(answers);
  if (!path) return Fail(path.error());
  const auto stations = Stations(answers, *path);
  if (!stations) return Fail(stations.error());
  const geom::Frame& plane = state.drawing.settings->plane;
  const double length_m = geom::Length(*path);
  const bool align = answers.Flag("align", true);
  const Vec3 start = geom::PointAt(*path, 0);
  const auto start_heading = Heading(*path, start, plane);
  Fired fired;
  for (const double station_m : *stations) {
    const Vec3 at = geom::PointAtFraction(*path, station_m / length_m);
    const auto heading = align && start_heading ? Heading(*path, at, plane) : std::nullopt;
    const double turn_rad = heading ? *heading - *start_heading : 0;
    AddCopies(answers, Translation(at - start) * Rotation(start, plane.z(), turn_rad), &fired);
  }
  return fired;
}

constexpr Prompt kCentre[] = {{"centre"}};

constexpr Key kRectangularKeys[] = {
    kOf,
    {"columns", Type::kCount, "how many along the active plane's x", {}, "1"},
    {"rows", Type::kCount, "how many along its y", {}, "1"},
    {"layers", Type::kCount, "how many along its normal", {}, "1"},
    {"column_spacing", Type::kLength, "from one column to the next", {}, "0m"},
    {"row_spacing", Type::kLength, "from one row to the next", {}, "0m"},
    {"layer_spacing", Type::kLength, "from one layer to the next", {}, "0m"}};
constexpr Key kPolarKeys[] = {
    kOf,
    {"count", Type::kCount, "how many, the original included", {}, {}, -1, true},
    {"angle",
     Type::kAngle,
     "over which they are spread: 360deg divides by count, less has one at each end",
     {},
     "360deg"},
    {"align", Type::kBoolean, "each copy turns with the array", {}, "true"}};
constexpr Key kPathKeys[] = {
    kOf,
    {"path",
     Type::kElement,
     "the curve to follow; the original stands for its start",
     {},
     {},
     -1,
     true},
    {"count", Type::kCount, "how many, the original included, spread evenly unless spaced"},
    {"spacing", Type::kLength,
     "from one to the next along the curve; as many as fit unless counted"},
    {"align",
     Type::kBoolean,
     "each copy turns with the curve, about the active plane's normal",
     {},
     "true"}};

constexpr Example kRectangularExamples[] = {
    {"place point xy=0,0,0\narray rectangular of=last columns=3 rows=2 column_spacing=2m "
     "row_spacing=1m",
     "len(last) == 5"},
    {"place point xy=0,0,0; array rectangular of=last layers=3 layer_spacing=4m",
     "last[1].bbox.min.z == 8m"},
    {"place point xy=0,0,0; array rectangular of=last columns=1", "E0212"}};
constexpr Example kPolarExamples[] = {
    {"place point xy=1,0,0; array polar of=last count=4 xy=0,0,0", "len(last) == 3"},
    {"place point xy=1,0,0; array polar of=last count=3 angle=180 xy=0,0,0",
     "last[1].bbox.min.x within -1m +- 0.000001m"},
    {"place line xy=1,0,0 dl=1; array polar of=last count=3 angle=90 align=false xy=0,0,0",
     "last[1].bbox.max.x within 0.5m +- 0.000001m"},
    {"place point xy=1,0,0; array polar of=last count=1 xy=0,0,0", "E0212"}};
constexpr Example kPathExamples[] = {
    {"place line xy=0,0,0 dl=10 as rail; place point xy=0,0,0 as post\n"
     "array path of=post path=rail count=6",
     "len(last) == 5"},
    {"place line xy=0,0,0 dl=10 as rail; place point xy=0,0,0 as post\n"
     "array path of=post path=rail spacing=4m",
     "len(last) == 2"},
    {"place arc center xy=5,0,0 xy=0,0,0 xy=0,5,0 as rail; place line xy=5,0,0 dl=1 as spoke\n"
     "array path of=spoke path=rail count=2 align=false",
     "last.bbox.max.x within 1m +- 0.000001m"},
    {"place point xy=0,0,0 as post; array path of=post path=post count=6", "E0410"}};

constexpr Command kCommands[] = {
    {.words = "array rectangular",
     .family = "manipulate",
     .summary = "Repeats what is chosen in columns, rows and layers along the active plane's axes.",
     .manner = Manner::kTransforms,
     .keys = kRectangularKeys,
     .examples = kRectangularExamples,
     .execute = Rectangular},
    {.words = "array polar",
     .family = "manipulate",
     .summary =
         "Repeats what is chosen about a centre in the active plane, as piers round an apse.",
     .manner = Manner::kTransforms,
     .prompts = kCentre,
     .keys = kPolarKeys,
     .examples = kPolarExamples,
     .execute = Polar},
    {.words = "array path",
     .family = "manipulate",
     .summary = "Repeats what is chosen along a curve, as balusters along a stair.",
     .manner = Manner::kTransforms,
     .keys = kPathKeys,
     .examples = kPathExamples,
     .execute = AlongPath},
};

}  // namespace

std::span<const Command> ArrayCommands() { return kCommands; }

}  // namespace tranos::interp
