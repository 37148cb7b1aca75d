// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve_part.h"

#include <algorithm>
#include <cmath>

#include "geom/crossing.h"
#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

// Differences of parameters below this are rounding.
constexpr double kSameParameter = 1e-12;

Line Cut(const Line& line, double from, double to) {
  return {JetOf(line, from).point, JetOf(line, to).point};
}
Arc Cut(const Arc& arc, double from, double to) {
  const CosSin at = ExactCosSin(from * arc.sweep_rad);
  const Frame& f = arc.frame;
  return {Frame{f.origin, at.cos * f.x + at.sin * f.y, at.cos * f.y - at.sin * f.x}, arc.radius,
          (to - from) * arc.sweep_rad};
}
BsplineCurve Cut(const BsplineCurve& curve, double from, double to) {
  std::vector<BezierSpan> spans;
  for (BezierSpan& span : BezierSpansOf(curve)) {
    const double width = span.end - span.begin;
    const double a = std::clamp((from - span.begin) / width, 0.0, 1.0);
    const double b = std::clamp((to - span.begin) / width, 0.0, 1.0);
    if (b - a <= kSameParameter) continue;
    if (b < 1) span.poles = Split(span.poles, b).first;
    if (a > 0) span.poles = Split(span.poles, a / b).second;
    spans.push_back(std::move(span));
  }
  return JoinSpans(spans);
}

using Piece = std::variant<Line, Arc, BsplineCurve>;

Curve Assembled(std::vector<Piece> pieces) {
  const auto is_line = [](const Piece& piece) { return std::holds_alternative<Line>(piece); };
  if (pieces.size() == 1) {
    return std::visit([](const auto& piece) { return Curve(piece); }, pieces[0]);
  }
  if (std::all_of(pieces.begin(), pieces.end(), is_line)) {
    Polyline polyline{{std::get<Line>(pieces[0]).start}, false};
    for (const Piece& piece : pieces) polyline.vertices.push_back(std::get<Line>(piece).end);
    return polyline;
  }
  Chain chain;
  for (const Piece& piece : pieces) {
    std::visit([&](const auto& shape) { chain.segments.emplace_back(shape); }, piece);
  }
  return chain;
}

// Adds the pieces of the stretch, which does not run through the start.
void AddStretch(const Curve& curve, double from, double to, std::vector<Piece>* pieces) {
  ForEachPiece(curve, [&](const auto& piece, double t0, double t1) {
    const double a = std::clamp((from - t0) / (t1 - t0), 0.0, 1.0);
    const double b = std::clamp((to - t0) / (t1 - t0), 0.0, 1.0);
    if (b - a <= kSameParameter) return;
    pieces->push_back(a == 0 && b == 1 ? piece : Cut(piece, a, b));
  });
}

// The curve with its last piece replaced.
Curve WithEnd(const Curve& curve, const Piece& last) {
  std::vector<Piece> pieces;
  AddStretch(curve, 0, 1, &pieces);
  pieces.back() = last;
  return Assembled(std::move(pieces));
}

Piece LastPiece(const Curve& curve) {
  Piece last;
  ForEachPiece(curve, [&](const auto& piece, double, double) { last = piece; });
  return last;
}

tl::unexpected<Error> Refuse(const char* detail) {
  return tl::unexpected(Error{ErrorCode::kOutOfRange, detail});
}

Result<Piece> Lengthened(const Line& line, double length_m) {
  const Vec3 along = line.end - line.start;
  return Line{line.start, line.end + length_m / along.norm() * along};
}
Result<Piece> Lengthened(const Arc& arc, double length_m) {
  const double sweep_rad = arc.sweep_rad + length_m / arc.radius;
  if (sweep_rad >= 2 * kPi) return Refuse("the arc would go round more than once");
  return Arc{arc.frame, arc.radius, sweep_rad};
}
Result<Piece> Lengthened(const BsplineCurve&, double) {
  return Refuse("lines and arcs go on beyond their ends, a smooth curve does not");
}

// What lies beyond the end, as far as it can go: the line up to `reach_m`, the rest of a circle.
std::optional<Curve> Beyond(const Piece& last, double reach_m) {
  if (const auto* line = std::get_if<Line>(&last)) {
    return Line{line->end, line->end + reach_m * (line->end - line->start).normalized()};
  }
  const auto* arc = std::get_if<Arc>(&last);
  if (!arc) return std::nullopt;
  return Cut(Arc{arc->frame, arc->radius, 2 * kPi}, arc->sweep_rad / (2 * kPi), 1);
}

// How far an end can see.
double ReachOf(const Curve& curve, const std::vector<Curve>& others) {
  Box box = BoundingBox(curve);
  for (const Curve& other : others) box.Add(BoundingBox(other));
  return 2 * (box.max - box.min).norm() + 1;
}

}  // namespace

Result<Curve> PartOf(const Curve& curve, double from, double to) {
  if (auto checked = Check(curve); !checked) return tl::unexpected(checked.error());
  std::vector<Piece> pieces;
  if (from < to) {
    AddStretch(curve, from, to, &pieces);
  } else if (IsClosed(curve)) {
    AddStretch(curve, from, 1, &pieces);
    AddStretch(curve, 0, to, &pieces);
  }
  if (pieces.empty()) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the stretch has no length"});
  }
  return Assembled(std::move(pieces));
}

std::vector<Curve> Divided(const Curve& curve, std::vector<double> parameters) {
  const bool closed = IsClosed(curve);
  std::sort(parameters.begin(), parameters.end());
  if (closed && !parameters.empty() && parameters.back() >= 1 - kSameParameter) {
    parameters.pop_back();
    parameters.insert(parameters.begin(), 0.0);
  }
  const auto same = [](double a, double b) { return b - a <= kSameParameter; };
  parameters.erase(std::unique(parameters.begin(), parameters.end(), same), parameters.end());
  std::vector<double> ends;
  if (!closed) {
    std::erase_if(parameters,
                  [](double t) { return t <= kSameParameter || t >= 1 - kSameParameter; });
    ends.push_back(0);
  }
  ends.insert(ends.end(), parameters.begin(), parameters.end());
  ends.push_back(closed && !parameters.empty() ? parameters.front() : 1);
  std::vector<Curve> parts;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    if (auto part = PartOf(curve, ends[i], ends[i + 1])) parts.push_back(*std::move(part));
  }
  return parts;
}

std::vector<double> EqualParameters(const Curve& curve, int parts) {
  std::vector<double> parameters;
  for (int i = IsClosed(curve) ? 0 : 1; i < parts; ++i) {
    parameters.push_back(ParameterAtFraction(curve, static_cast<double>(i) / parts));
  }
  return parameters;
}

Result<Curve> LengthenedBy(const Curve& curve, CurveEnd end, double length_m) {
  if (end == CurveEnd::kStart) {
    auto turned = LengthenedBy(Reversed(curve), CurveEnd::kEnd, length_m);
    if (!turned) return turned;
    return Reversed(*turned);
  }
  if (IsClosed(curve)) return Refuse("a closed curve has no end");
  if (!(length_m > 0)) return Refuse("it is lengthened by more than nothing");
  auto last =
      std::visit([&](const auto& piece) { return Lengthened(piece, length_m); }, LastPiece(curve));
  if (!last) return tl::unexpected(last.error());
  return WithEnd(curve, *last);
}

Result<Curve> LengthenedTo(const Curve& curve, CurveEnd end, const std::vector<Curve>& others) {
  const Curve towards = end == CurveEnd::kStart ? Reversed(curve) : curve;
  if (IsClosed(curve)) return Refuse("a closed curve has no end");
  const auto beyond = Beyond(LastPiece(towards), ReachOf(curve, others));
  if (!beyond) return Refuse("lines and arcs go on beyond their ends, a smooth curve does not");
  std::optional<double> nearest;
  for (const Curve& other : others) {
    for (const Crossing& crossing : Crossings(*beyond, other)) {
      // The end itself may stand on one of them already.
      if (crossing.t_a * Length(*beyond) <= kMeeting_m) continue;
      if (!nearest || crossing.t_a < *nearest) nearest = crossing.t_a;
    }
  }
  if (!nearest) return tl::unexpected(Error{ErrorCode::kDoNotMeet, "it meets none of them ahead"});
  return LengthenedBy(curve, end, *nearest * Length(*beyond));
}

}  // namespace tranos::geom
