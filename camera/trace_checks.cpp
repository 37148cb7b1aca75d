// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/trace_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/space_traces.h"
#include "camera/vanishing_point.h"

namespace tranos::camera {

namespace {

using geom::Error;
using geom::ErrorCode;
using MaybeError = std::optional<Error>;

Error Degenerate(std::string detail) { return {ErrorCode::kDegenerate, std::move(detail)}; }
Error OutOfRange(std::string detail) { return {ErrorCode::kOutOfRange, std::move(detail)}; }

MaybeError WrongWithNumbers(const Numbers& numbers, NumberIndex first, int count) {
  if (first < 0 || first + count > numbers.values.size())
    return OutOfRange("the trace stands on numbers that are not given");
  if (!numbers.values.segment(first, count).allFinite())
    return OutOfRange("a number that the trace stands on is not finite");
  return {};
}

MaybeError WrongWithLength(const Numbers& numbers, NumberIndex at, const char* what) {
  if (const MaybeError wrong = WrongWithNumbers(numbers, at, 1)) return wrong;
  const double value = numbers.values[at];
  if (!(value > 0)) return OutOfRange(fmt::format("{} is {:g}, but must be above 0", what, value));
  return {};
}

MaybeError WrongWithDots(std::span<const Vec2> dots_px, double sigma_px) {
  if (!(sigma_px > 0) || !std::isfinite(sigma_px))
    return OutOfRange(fmt::format("a dot's deviation is {:g} px, but must be above 0", sigma_px));
  for (const Vec2& dot : dots_px) {
    if (!dot.allFinite()) return OutOfRange("a dot is not finite");
  }
  return {};
}

MaybeError WrongWithLine(const ImageLine& line) {
  if (const MaybeError wrong =
          WrongWithDots(std::array{line.a_px, line.b_px}, line.centre_sigma_px))
    return wrong;
  if (!(line.tilt_sigma_px > 0)) return OutOfRange("a line's tilt must have a deviation above 0");
  if (line.length_px() < 1e-6) return Degenerate("the dots of the line are one and the same");
  return {};
}

MaybeError WrongWith(const DirectionTrace& trace, const Numbers&) {
  if (trace.axis < 0 || trace.axis > 2) return OutOfRange("there are three axes");
  return WrongWithLine(trace.line);
}

MaybeError WrongWith(const EdgeTrace& trace, const Numbers& numbers) {
  if (const MaybeError wrong = WrongWithLine(trace.line)) return wrong;
  if (const MaybeError wrong = WrongWithNumbers(numbers, trace.from, 3)) return wrong;
  if (const MaybeError wrong = WrongWithNumbers(numbers, trace.to, 3)) return wrong;
  const Vec3 way = numbers.values.segment<3>(trace.to) - numbers.values.segment<3>(trace.from);
  if (way.norm() < geom::kCoincident_m) return Degenerate("the edge has no length in space");
  return {};
}

MaybeError WrongWith(const CurveTrace& trace, const Numbers& numbers) {
  if (trace.points < 2) return Degenerate("the curve has no length in space");
  if (trace.dots_px.empty()) return Degenerate("the curve has no dots");
  if (const MaybeError wrong = WrongWithDots(trace.dots_px, trace.sigma_px)) return wrong;
  return WrongWithNumbers(numbers, trace.first, 3 * trace.points);
}

MaybeError WrongWith(const PointTrace& trace, const Numbers& numbers) {
  if (const MaybeError wrong = WrongWithDots({&trace.dot_px, 1}, trace.sigma_px)) return wrong;
  return WrongWithNumbers(numbers, trace.at, 3);
}

double Cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

MaybeError WrongWith(const RectangleTrace& trace, const Numbers& numbers) {
  if (const MaybeError wrong = WrongWithDots(trace.dots_px, trace.sigma_px)) return wrong;
  if (const MaybeError wrong = WrongWithLength(numbers, trace.a, "a")) return wrong;
  if (const MaybeError wrong = WrongWithLength(numbers, trace.b, "b")) return wrong;
  int right = 0, left = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec2 in = trace.dots_px[(i + 1) % 4] - trace.dots_px[i];
    const Vec2 out = trace.dots_px[(i + 2) % 4] - trace.dots_px[(i + 1) % 4];
    if (std::abs(Cross(in, out)) < 1e-6 * in.norm() * out.norm() || in.norm() < 1e-6)
      return Degenerate("three dots of the rectangle lie in a line");
    ++(Cross(in, out) > 0 ? right : left);
  }
  // With y down, anticlockwise turns are negative.
  if (right == 4)
    return Degenerate("the rectangle is traced clockwise: anticlockwise from bottom left is meant");
  if (right > 0)
    return Degenerate(
        "the rectangle is traced crosswise: its dots go anticlockwise from bottom left");
  return {};
}

MaybeError WrongWith(const RatioTrace& trace, const Numbers& numbers) {
  if (const MaybeError wrong = WrongWithDots(trace.dots_px, trace.sigma_px)) return wrong;
  const Vec2 first = trace.dots_px[1] - trace.dots_px[0];
  const Vec2 second = trace.dots_px[3] - trace.dots_px[2];
  if (first.norm() < 1e-6 || second.norm() < 1e-6)
    return Degenerate("the dots of an edge are one and the same");
  if (std::abs(Cross(first, second)) < 1e-6 * first.norm() * second.norm())
    return Degenerate("the two edges are parallel in the picture, so not orthogonal in a facade");
  return WrongWithLength(numbers, trace.ratio, "the ratio");
}

MaybeError WrongWith(const CircleTrace& trace, const Numbers&) {
  if (trace.dots_px.size() < 5)
    return Degenerate(fmt::format("a circle takes five dots, not {}", trace.dots_px.size()));
  return WrongWithDots(trace.dots_px, trace.sigma_px);
}

const ImageLine* LineOf(const Trace& trace) {
  if (const auto* edge = std::get_if<EdgeTrace>(&trace)) return &edge->line;
  if (const auto* direction = std::get_if<DirectionTrace>(&trace)) return &direction->line;
  return nullptr;
}

// Deviation of a line's offset so far along it from its centre.
double OffsetSigma(const ImageLine& line, double along_px) {
  return std::hypot(line.centre_sigma_px, along_px / line.length_px() * line.tilt_sigma_px);
}

// Whether each end of the shorter line is on the longer one within so many deviations of both, and
// they lie beside each other by more than half.
bool LieOnEachOther(const ImageLine& a, const ImageLine& b, double deviations) {
  if (b.length_px() > a.length_px()) return LieOnEachOther(b, a, deviations);
  const Vec2 along = (a.b_px - a.a_px) / a.length_px();
  const double half = 0.5 * a.length_px();
  double least = half, most = -half;
  for (const Vec2& end : {b.a_px, b.b_px}) {
    const Vec2 to = end - a.centre_px();
    const double at = along.dot(to);
    const double noise = std::hypot(OffsetSigma(a, at), OffsetSigma(b, 0.5 * b.length_px()));
    if (std::abs(Cross(along, to)) > deviations * noise) return false;
    least = std::min(least, std::clamp(at, -half, half));
    most = std::max(most, std::clamp(at, -half, half));
  }
  return most - least > 0.5 * b.length_px();
}

bool AreOneInSpace(const EdgeTrace& a, const EdgeTrace& b, const Numbers& numbers) {
  const auto point = [&](NumberIndex at) { return Vec3(numbers.values.segment<3>(at)); };
  const Vec3 along = (point(a.to) - point(a.from)).normalized();
  const auto is_on = [&](NumberIndex at) {
    return along.cross(point(at) - point(a.from)).norm() < geom::kCoincident_m;
  };
  return is_on(b.from) && is_on(b.to);
}

// Whether two traces are of one line. Edges at different places are two, however near they are in
// the picture. Of lines along one axis nothing says that they are not two, as a frame's, so that
// these must be no farther apart than they are uncertain.
bool AreOne(const Trace& a, const Trace& b, const Numbers& numbers) {
  constexpr double kSurely = 3;
  const ImageLine *first = LineOf(a), *second = LineOf(b);
  if (!first || !second) return false;
  const auto *edge = std::get_if<EdgeTrace>(&a), *other = std::get_if<EdgeTrace>(&b);
  if (edge && other)
    return AreOneInSpace(*edge, *other, numbers) && LieOnEachOther(*first, *second, kSurely);
  const auto *one = std::get_if<DirectionTrace>(&a), *two = std::get_if<DirectionTrace>(&b);
  const bool disagree = one && two && one->axis != two->axis;
  return LieOnEachOther(*first, *second, disagree ? kSurely : 1);
}

MaybeError LineTwice(const Photograph& photograph, const Numbers& numbers) {
  const auto n = static_cast<int>(photograph.traces.size());
  for (int j = 1; j < n; ++j) {
    for (int i = 0; i < j; ++i) {
      if (!AreOne(photograph.traces[i], photograph.traces[j], numbers)) continue;
      return Error{ErrorCode::kDegenerate,
                   fmt::format("the line is the same as that of trace {}", i + 1), j, i};
    }
  }
  return {};
}

MaybeError AllParallel(const Photograph& photograph) {
  const ImageLine* first = nullptr;
  int lines = 0;
  for (const Trace& trace : photograph.traces) {
    const ImageLine* line = LineOf(trace);
    if (!line) return {};
    if (!first) first = line;
    const Vec2 a = (first->b_px - first->a_px).normalized(),
               b = (line->b_px - line->a_px).normalized();
    const double noise = std::hypot(first->tilt_sigma_px / first->length_px(),
                                    line->tilt_sigma_px / line->length_px());
    if (std::abs(Cross(a, b)) > 3 * noise) return {};
    ++lines;
  }
  if (lines < 2) return {};
  return Degenerate("all lines are parallel in the picture, which tells nothing of the camera");
}

int FirstOfAxis(const Photograph& photograph, int axis) {
  const auto& traces = photograph.traces;
  const auto found = std::ranges::find_if(traces, [&](const Trace& trace) {
    const auto* direction = std::get_if<DirectionTrace>(&trace);
    return direction && direction->axis == axis;
  });
  return found == traces.end() ? -1 : static_cast<int>(found - traces.begin());
}

MaybeError SharedVanishingPoint(const Photograph& photograph, const Numbers& numbers) {
  const AxisLines lines = AxisLinesOf(photograph, numbers);
  const Conditioning conditioning = ConditioningOf(photograph.frame);
  std::optional<VanishingPoint> points[3];
  for (int i = 0; i < 3; ++i) {
    if (lines[i].size() < 2) continue;
    if (const auto point = FitVanishingPoint(lines[i], conditioning)) points[i] = *point;
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j) {
      if (!points[i] || !points[j]) continue;
      const Vec3 a = points[i]->point, b = points[j]->point;
      const double angle = std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
      const double noise = std::hypot(points[i]->sigma_max, points[j]->sigma_max);
      // Lines too uncertain to say so are no error.
      if (angle > 3 * noise + 1e-9 || noise > 0.1) continue;
      return Error{
          ErrorCode::kDegenerate,
          fmt::format("the edges along {} and {} have one vanishing point within noise, so "
                      "their directions are not orthogonal",
                      "XYZ"[i], "XYZ"[j]),
          FirstOfAxis(photograph, j)};
    }
  }
  return {};
}

MaybeError WrongWithOne(const Photograph& photograph, const Numbers& numbers) {
  if ((photograph.frame.size_px.array() < 1).any() ||
      !(photograph.frame.size_mm.array() > 0).all() || !photograph.frame.size_mm.allFinite())
    return OutOfRange("the photograph has no size");
  for (int i = 0; i < static_cast<int>(photograph.traces.size()); ++i) {
    MaybeError wrong = std::visit([&](const auto& trace) { return WrongWith(trace, numbers); },
                                  photograph.traces[i]);
    if (!wrong) continue;
    wrong->part = i;
    return wrong;
  }
  if (MaybeError wrong = LineTwice(photograph, numbers)) return wrong;
  if (MaybeError wrong = AllParallel(photograph)) return wrong;
  return SharedVanishingPoint(photograph, numbers);
}

}  // namespace

std::vector<bool> RepeatsALine(const Photograph& photograph, const Numbers& numbers) {
  std::vector<bool> repeats(photograph.traces.size(), false);
  for (std::size_t j = 1; j < repeats.size(); ++j) {
    for (std::size_t i = 0; i < j && !repeats[j]; ++i) {
      repeats[j] = !repeats[i] && AreOne(photograph.traces[i], photograph.traces[j], numbers);
    }
  }
  return repeats;
}

std::string NameOfPhotograph(std::span<const Photograph> photographs, std::ptrdiff_t photograph) {
  const std::string& name = photographs[photograph].name;
  return name.empty() ? fmt::format("photograph {}", photograph + 1) : "`" + name + "`";
}

Error ErrorAmong(std::span<const Photograph> photographs, std::ptrdiff_t photograph, Error error) {
  if (photographs.size() < 2) return error;
  error.detail = fmt::format("{}: {}", NameOfPhotograph(photographs, photograph), error.detail);
  for (const Photograph& before : photographs.first(photograph)) {
    const auto traces = static_cast<int>(before.traces.size());
    if (error.part >= 0) error.part += traces;
    if (error.other >= 0) error.other += traces;
  }
  return error;
}

std::optional<Error> WrongWith(std::span<const Photograph> photographs, const Numbers& numbers) {
  for (std::ptrdiff_t p = 0; p < std::ssize(photographs); ++p) {
    if (MaybeError wrong = WrongWithOne(photographs[p], numbers))
      return ErrorAmong(photographs, p, *std::move(wrong));
  }
  return {};
}

}  // namespace tranos::camera
