// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/corner.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "geom/crossing.h"
#include "geom/curve_part.h"
#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

// Directions nearer than this are one.
constexpr double kSmooth_rad = 1e-9;

using Piece = std::variant<Line, Arc, BsplineCurve>;

// What is put in a corner's place, and how much of the pieces beside it is left.
struct Cut {
  double end_before, start_after;  // in the pieces' own parameters
  Piece between;
};
// Makes the cut of a corner between two pieces, the one ending where the other starts.
using Cutter = std::function<Result<Cut>(const Piece& before, const Piece& after)>;

tl::unexpected<Error> Refuse(ErrorCode code, const char* detail) {
  return tl::unexpected(Error{code, detail});
}

CurveJet JetAt(const Piece& piece, double t) {
  return std::visit([&](const auto& shape) { return JetOf(shape, t); }, piece);
}
double LengthOfPiece(const Piece& piece) {
  return std::visit([](const auto& shape) { return LengthOf(shape); }, piece);
}
Curve AsCurve(const Piece& piece) {
  return std::visit([](const auto& shape) { return Curve(shape); }, piece);
}

std::vector<Piece> PiecesOf(const Curve& curve) {
  std::vector<Piece> pieces;
  ForEachPiece(curve, [&](const auto& piece, double, double) { pieces.emplace_back(piece); });
  return pieces;
}

Curve CurveOf(const std::vector<Piece>& pieces, bool closed) {
  const auto is_line = [](const Piece& piece) { return std::holds_alternative<Line>(piece); };
  if (pieces.size() == 1 && !closed) return AsCurve(pieces[0]);
  if (std::all_of(pieces.begin(), pieces.end(), is_line)) {
    Polyline polyline{{}, closed};
    for (const Piece& piece : pieces) polyline.vertices.push_back(std::get<Line>(piece).start);
    if (!closed) polyline.vertices.push_back(std::get<Line>(pieces.back()).end);
    return polyline;
  }
  Chain chain{{}, closed};
  for (const Piece& piece : pieces) {
    std::visit([&](const auto& shape) { chain.segments.emplace_back(shape); }, piece);
  }
  return chain;
}

bool IsCorner(const Piece& before, const Piece& after) {
  const Vec3 in = JetAt(before, 1).d1.normalized(), out = JetAt(after, 0).d1.normalized();
  return !(in.cross(out).norm() <= kSmooth_rad && in.dot(out) > 0);
}

// The circles or lines on which the centres of arcs lie that touch a side from the left, as seen
// from `normal`.
struct Locus {
  bool straight;
  Vec3 origin;     // on the line, or the circle's centre
  Vec3 direction;  // of the line
  double radius;   // of the circle
};

Result<Locus> LocusOf(const Piece& side, const Vec3& normal, double radius_m) {
  if (const auto* line = std::get_if<Line>(&side)) {
    const Vec3 along = (line->end - line->start).normalized();
    return Locus{true, line->start + radius_m * normal.cross(along), along, 0};
  }
  const auto* arc = std::get_if<Arc>(&side);
  if (!arc) return Refuse(ErrorCode::kOutOfRange, "a smooth curve beside a corner is not cut");
  const double turn = arc->frame.z().dot(normal);
  if (std::abs(std::abs(turn) - 1) > 1e-9) {
    return Refuse(ErrorCode::kNotPlanar, "the sides of a corner do not lie in one plane");
  }
  const double radius = turn > 0 ? arc->radius - radius_m : arc->radius + radius_m;
  if (radius <= kCoincident_m) {
    return Refuse(ErrorCode::kOutOfRange, "the radius is not below that of the arc beside it");
  }
  return Locus{false, arc->frame.origin, Vec3::Zero(), radius};
}

std::vector<Vec3> OnBoth(const Locus& a, const Locus& b, const Vec3& normal) {
  if (!a.straight && b.straight) return OnBoth(b, a, normal);
  const Vec3 between = b.origin - a.origin;
  if (a.straight && b.straight) {
    const double sine = a.direction.cross(b.direction).dot(normal);
    if (std::abs(sine) <= kSmooth_rad) return {};
    return {a.origin + between.cross(b.direction).dot(normal) / sine * a.direction};
  }
  Vec3 foot, along;
  double offset = 0, radius = b.radius;
  if (a.straight) {
    along = a.direction;
    foot = a.origin + between.dot(along) * along;
    offset = (foot - b.origin).norm();
  } else {
    const double distance = between.norm();
    if (distance <= kCoincident_m) return {};
    radius = a.radius;
    offset = (distance * distance + (a.radius - b.radius) * (a.radius + b.radius)) / (2 * distance);
    foot = a.origin + offset / distance * between;
    along = normal.cross(between / distance);
  }
  const double square = (radius - std::abs(offset)) * (radius + std::abs(offset));
  if (square < 0) return {};
  return {foot - std::sqrt(square) * along, foot + std::sqrt(square) * along};
}

// Where an arc about the centre touches the side, in the side's parameter; nothing beyond its ends.
std::optional<double> TouchOf(const Piece& side, const Vec3& centre, double radius_m) {
  const Nearest nearest = NearestPoint(AsCurve(side), centre);
  if (const auto* arc = std::get_if<Arc>(&side)) {
    const Vec3 out = (centre - arc->frame.origin).normalized();
    const Nearest touch = NearestOn(*arc, arc->frame.origin + arc->radius * out);
    if (touch.distance_m > kCoincident_m) return std::nullopt;
    return touch.t;
  }
  if (std::abs(nearest.distance_m - radius_m) > kCoincident_m) return std::nullopt;
  return nearest.t;
}

Result<Cut> RoundCorner(const Piece& before, const Piece& after, double radius_m) {
  const Vec3 in = JetAt(before, 1).d1.normalized(), out = JetAt(after, 0).d1.normalized();
  Vec3 normal = in.cross(out);
  if (normal.norm() <= kSmooth_rad) {
    return Refuse(ErrorCode::kOutOfRange, "where a curve turns straight back there is no corner");
  }
  normal.normalize();
  const auto a = LocusOf(before, normal, radius_m), b = LocusOf(after, normal, radius_m);
  if (!a || !b) return tl::unexpected(a ? b.error() : a.error());
  std::optional<Cut> best;
  for (const Vec3& centre : OnBoth(*a, *b, normal)) {
    const auto t_before = TouchOf(before, centre, radius_m);
    const auto t_after = TouchOf(after, centre, radius_m);
    if (!t_before || !t_after) continue;
    // Of two, the one that leaves more.
    if (best && *t_before - *t_after <= best->end_before - best->start_after) continue;
    const auto arc =
        ArcAround(centre, JetAt(before, *t_before).point, JetAt(after, *t_after).point, normal);
    if (arc) best = Cut{*t_before, *t_after, *arc};
  }
  if (!best) return Refuse(ErrorCode::kOutOfRange, "an arc of this radius does not fit");
  return *best;
}

Result<Cut> CutCorner(const Piece& before, const Piece& after, double before_m, double after_m) {
  for (const Piece* side : {&before, &after}) {
    if (std::holds_alternative<BsplineCurve>(*side)) {
      return Refuse(ErrorCode::kOutOfRange, "a smooth curve beside a corner is not cut");
    }
  }
  const double end_before = 1 - before_m / LengthOfPiece(before);
  const double start_after = after_m / LengthOfPiece(after);
  if (end_before < -kCoincident_m || start_after > 1 + kCoincident_m) {
    return Refuse(ErrorCode::kOutOfRange, "the cut is longer than a side");
  }
  return Cut{end_before, start_after,
             Line{JetAt(before, end_before).point, JetAt(after, start_after).point}};
}

// The stretch of a piece that is left; nothing if it has no length, an error if it has less.
Result<std::optional<Piece>> Left(const Piece& piece, double from, double to) {
  const double left_m = (to - from) * LengthOfPiece(piece);
  if (left_m < -kCoincident_m) {
    return Refuse(ErrorCode::kOutOfRange, "the cuts at both ends of a side overlap");
  }
  if (left_m <= kCoincident_m) return std::optional<Piece>();
  if (from == 0 && to == 1) return std::optional(piece);
  const auto part = PartOf(AsCurve(piece), from, to);
  if (!part) return tl::unexpected(part.error());
  return std::optional(PiecesOf(*part)[0]);
}

Result<Curve> WithCuts(const Curve& curve, const Cutter& cutter,
                       const std::optional<Corner>& only) {
  if (auto checked = Check(curve); !checked) return tl::unexpected(checked.error());
  const std::vector<Piece> pieces = PiecesOf(curve);
  const std::size_t count = pieces.size();
  std::vector<double> from(count, 0), to(count, 1);
  std::vector<std::optional<Piece>> between(count);
  bool any = false;
  for (const Corner& corner : CornersOf(curve)) {
    if (only && only->piece != corner.piece) continue;
    const std::size_t next = (corner.piece + 1) % count;
    const auto cut = cutter(pieces[corner.piece], pieces[next]);
    if (!cut) return tl::unexpected(cut.error());
    to[corner.piece] = cut->end_before;
    from[next] = cut->start_after;
    between[corner.piece] = cut->between;
    any = true;
  }
  if (!any) return Refuse(ErrorCode::kDegenerate, "the curve has no corner");
  std::vector<Piece> result;
  for (std::size_t i = 0; i < count; ++i) {
    const auto left = Left(pieces[i], from[i], to[i]);
    if (!left) return tl::unexpected(left.error());
    if (*left) result.push_back(**left);
    if (between[i]) result.push_back(*between[i]);
  }
  return CurveOf(result, IsClosed(curve));
}

bool IsPositive(double length_m) { return length_m > kCoincident_m && std::isfinite(length_m); }

// The curve made longer at its end: lines as far as `reach_m`, arcs nearly all round.
Curve LongAtEnd(const Curve& curve, double reach_m) {
  const std::vector<Piece> pieces = PiecesOf(curve);
  double by_m = reach_m;
  if (const auto* arc = std::get_if<Arc>(&pieces.back())) {
    by_m = arc->radius * ((1 - 1e-9) * 2 * kPi - arc->sweep_rad);
  }
  return LengthenedBy(curve, CurveEnd::kEnd, by_m).value_or(curve);
}

// Two curves led to a point in which the first ends and the second starts.
struct Meeting {
  Curve a, b;
  bool a_turned, b_turned;
  double change_m;
};

std::optional<Meeting> Meet(const Curve& a, bool a_turned, const Curve& b, bool b_turned) {
  const Curve towards = a_turned ? Reversed(a) : a, away = b_turned ? Reversed(b) : b;
  Box box = BoundingBox(a);
  box.Add(BoundingBox(b));
  const double reach_m = 100 * (box.max - box.min).norm();
  const Curve long_a = LongAtEnd(towards, reach_m);
  const Curve long_b = Reversed(LongAtEnd(Reversed(away), reach_m));
  std::optional<Meeting> best;
  for (const Crossing& crossing : Crossings(long_a, long_b)) {
    const auto part_a = PartOf(long_a, 0, crossing.t_a), part_b = PartOf(long_b, crossing.t_b, 1);
    if (!part_a || !part_b) continue;
    const double change_m =
        std::abs(Length(*part_a) - Length(a)) + std::abs(Length(*part_b) - Length(b));
    if (best && change_m >= best->change_m) continue;
    best = Meeting{*part_a, *part_b, a_turned, b_turned, change_m};
  }
  return best;
}

Result<Meeting> MeetingOf(const Curve& a, const Curve& b) {
  for (const Curve* curve : {&a, &b}) {
    if (auto checked = Check(*curve); !checked) return tl::unexpected(checked.error());
    if (IsClosed(*curve)) return Refuse(ErrorCode::kOutOfRange, "a closed curve has no end");
  }
  std::optional<Meeting> best;
  for (const bool a_turned : {false, true}) {
    for (const bool b_turned : {false, true}) {
      auto meeting = Meet(a, a_turned, b, b_turned);
      if (meeting && (!best || meeting->change_m < best->change_m - kMeeting_m)) best = meeting;
    }
  }
  if (!best) return Refuse(ErrorCode::kDoNotMeet, "they do not meet, even made longer");
  return *best;
}

Result<Joint> Join(const Curve& a, const Curve& b, const Cutter& cutter) {
  const auto meeting = MeetingOf(a, b);
  if (!meeting) return tl::unexpected(meeting.error());
  std::vector<Piece> before = PiecesOf(meeting->a), after = PiecesOf(meeting->b);
  if (!IsCorner(before.back(), after.front())) {
    return Refuse(ErrorCode::kDegenerate, "they run on smoothly, without a corner");
  }
  const auto cut = cutter(before.back(), after.front());
  if (!cut) return tl::unexpected(cut.error());
  const auto left_a = Left(before.back(), 0, cut->end_before);
  const auto left_b = Left(after.front(), cut->start_after, 1);
  if (!left_a || !left_b) return tl::unexpected(left_a ? left_b.error() : left_a.error());
  if (!*left_a || !*left_b)
    return Refuse(ErrorCode::kOutOfRange, "nothing would be left of a side");
  before.back() = **left_a;
  after.front() = **left_b;
  const Curve joined_a = CurveOf(before, false), joined_b = CurveOf(after, false);
  return Joint{meeting->a_turned ? Reversed(joined_a) : joined_a,
               meeting->b_turned ? Reversed(joined_b) : joined_b, AsCurve(cut->between)};
}

Cutter Rounder(double radius_m) {
  return [radius_m](const Piece& before, const Piece& after) {
    return RoundCorner(before, after, radius_m);
  };
}
Cutter CornerCutter(double before_m, double after_m) {
  return [before_m, after_m](const Piece& before, const Piece& after) {
    return CutCorner(before, after, before_m, after_m);
  };
}

constexpr const char* kNotPositive = "a corner is cut by more than nothing";

}  // namespace

std::vector<Corner> CornersOf(const Curve& curve) {
  std::vector<Corner> corners;
  if (!Check(curve)) return corners;
  const std::vector<Piece> pieces = PiecesOf(curve);
  const std::size_t pairs = IsClosed(curve) ? pieces.size() : pieces.size() - 1;
  for (std::size_t i = 0; i < pairs; ++i) {
    if (IsCorner(pieces[i], pieces[(i + 1) % pieces.size()])) {
      corners.push_back({i, JetAt(pieces[i], 1).point});
    }
  }
  return corners;
}

Result<Curve> Rounded(const Curve& curve, double radius_m, std::optional<Corner> only) {
  if (!IsPositive(radius_m)) return Refuse(ErrorCode::kDegenerate, kNotPositive);
  return WithCuts(curve, Rounder(radius_m), only);
}

Result<Curve> CutOff(const Curve& curve, double before_m, double after_m,
                     std::optional<Corner> only) {
  if (!IsPositive(before_m) || !IsPositive(after_m)) {
    return Refuse(ErrorCode::kDegenerate, kNotPositive);
  }
  return WithCuts(curve, CornerCutter(before_m, after_m), only);
}

Result<Joint> RoundedBetween(const Curve& a, const Curve& b, double radius_m) {
  if (!IsPositive(radius_m)) return Refuse(ErrorCode::kDegenerate, kNotPositive);
  return Join(a, b, Rounder(radius_m));
}

Result<Joint> CutOffBetween(const Curve& a, const Curve& b, double along_a_m, double along_b_m) {
  if (!IsPositive(along_a_m) || !IsPositive(along_b_m)) {
    return Refuse(ErrorCode::kDegenerate, kNotPositive);
  }
  return Join(a, b, CornerCutter(along_a_m, along_b_m));
}

}  // namespace tranos::geom
