// SPDX-License-Identifier: GPL-3.0-or-later
// Each piece is moved aside and the gaps at corners are bridged; what then crosses is cut there,
// the parts that came nearer to the curve than the distance are dropped, and the others joined.
#include "geom/offset.h"

#include <algorithm>
#include <cmath>

#include "geom/crossing.h"
#include "geom/curve_part.h"
#include "geom/curve_pieces.h"

namespace tranos::geom {
namespace {

constexpr double kMitreLimit = 4;           // of the tip's distance from the corner, by the offset
constexpr std::size_t kMostPieces = 5'000;  // each is compared with each
constexpr double kShallow = 0.05;           // sine of a corner that is nearly straight
constexpr double kNearer_m = 1e-8;          // than the distance, by more than rounding
constexpr double kSmooth_rad = 1e-9;        // directions nearer than this are one

using Piece = std::variant<Line, Arc>;

tl::unexpected<Error> Refuse(ErrorCode code, const char* detail) {
  return tl::unexpected(Error{code, detail});
}

Curve AsCurve(const Piece& piece) {
  return std::visit([](const auto& shape) { return Curve(shape); }, piece);
}

struct Side {
  Vec3 normal;
  double distance_m;  // to the left, negative to the right

  Vec3 Aside(const Vec3& direction) const { return distance_m * normal.cross(direction); }
};

// The pieces, all in a plane across the normal.
Result<std::vector<Piece>> PlanePieces(const Curve& curve, const Vec3& normal) {
  std::vector<Piece> pieces;
  std::optional<Error> error;
  const Vec3 origin = PointAt(curve, 0);
  const auto lies_in_plane = [&](const Vec3& p) {
    return std::abs((p - origin).dot(normal)) <= 1e-9 * std::max(1.0, (p - origin).norm());
  };
  ForEachPiece(
      curve,
      Overloaded{[&](const Line& line, double, double) {
                   if (!lies_in_plane(line.end)) error = Error{ErrorCode::kNotPlanar, ""};
                   if (LengthOf(line) > kCoincident_m) pieces.emplace_back(line);
                 },
                 [&](const Arc& arc, double, double) {
                   const bool flat = arc.frame.z().cross(normal).norm() <= 1e-9;
                   if (!flat || !lies_in_plane(arc.frame.origin)) {
                     error = Error{ErrorCode::kNotPlanar, ""};
                   }
                   pieces.emplace_back(arc);
                 },
                 [&](const BsplineCurve&, double, double) {
                   error = Error{ErrorCode::kOutOfRange, "a smooth curve has no exact parallel"};
                 }});
  if (error && error->code == ErrorCode::kNotPlanar) error->detail = "it does not lie in the plane";
  if (error) return tl::unexpected(*error);
  return pieces;
}

// The piece moved aside; nothing of an arc whose centre is no farther than the distance.
std::optional<Piece> Moved(const Piece& piece, const Side& side) {
  if (const auto* line = std::get_if<Line>(&piece)) {
    const Vec3 by = side.Aside((line->end - line->start).normalized());
    return Line{line->start + by, line->end + by};
  }
  Arc arc = std::get<Arc>(piece);
  arc.radius -= (arc.frame.z().dot(side.normal) > 0 ? 1 : -1) * side.distance_m;
  if (arc.radius <= kCoincident_m) return std::nullopt;
  return arc;
}

// Pieces that lead round the corner where the one direction turns into the other, on the side where
// a gap opens.
std::vector<Piece> Bridge(const Vec3& corner, const Vec3& in, const Vec3& out, const Side& side,
                          OffsetJoin join) {
  const Vec3 start = corner + side.Aside(in), end = corner + side.Aside(out);
  if (join == OffsetJoin::kRounded) {
    const Vec3 about = side.distance_m > 0 ? Vec3(-side.normal) : side.normal;
    if (const auto arc = ArcAround(corner, start, end, about)) return {*arc};
    return {};
  }
  // The tip lies on the bisector, as far as the half angle's cosine says; cut off, its two corners
  // lie where it is as broad as at the limit.
  const double cosine = std::sqrt(std::max(0.0, 0.5 * (1 + in.dot(out))));
  const double reach = std::abs(side.distance_m);
  if (cosine >= 1 / kMitreLimit) {
    const double ahead = reach * std::sqrt(1 - cosine * cosine) / cosine;
    const Vec3 tip = start + ahead * in;
    return {Line{start, tip}, Line{tip, end}};
  }
  const double sine = std::sqrt(1 - cosine * cosine);
  const double ahead = reach * (kMitreLimit - cosine) / sine;
  const Vec3 first = start + ahead * in, last = end - ahead * out;
  return {Line{start, first}, Line{first, last}, Line{last, end}};
}

// Moved sides of a corner that closes and is nearly straight are cut to where they meet: what
// overlaps there comes nearer to the curve by too little to tell.
void MeetAtShallowCorner(Piece* before, Piece* after, double distance_m) {
  auto* a = std::get_if<Line>(before);
  auto* b = std::get_if<Line>(after);
  if (!a || !b) return;
  const Vec3 in = (a->end - a->start).normalized(), out = (b->end - b->start).normalized();
  const double sine = in.cross(out).norm(), cosine = in.dot(out);
  if (sine > kShallow || cosine < 0) return;
  const double cut_m = std::abs(distance_m) * sine / (1 + cosine);  // d·tan(θ/2)
  if (cut_m >= 0.5 * std::min(LengthOf(*a), LengthOf(*b))) return;
  a->end -= cut_m * in;
  b->start = a->end;
}

// All pieces moved and gaps bridged; pieces of concave corners overlap.
std::vector<Piece> RawPieces(const std::vector<Piece>& pieces, bool closed, const Side& side,
                             OffsetJoin join) {
  std::vector<Piece> raw;
  std::vector<std::optional<Piece>> moved;
  std::vector<std::vector<Piece>> bridges(pieces.size());
  for (const Piece& piece : pieces) moved.push_back(Moved(piece, side));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i + 1 == pieces.size() && !closed) break;
    const std::size_t after = (i + 1) % pieces.size();
    const Curve here = AsCurve(pieces[i]), next = AsCurve(pieces[after]);
    const Vec3 in = TangentAt(here, 1), out = TangentAt(next, 0);
    const double sine = in.cross(out).dot(side.normal);
    const bool back = std::abs(sine) <= kSmooth_rad && in.dot(out) < 0;
    const bool opens = sine * side.distance_m < 0 && std::abs(sine) > kSmooth_rad;
    if (opens || back) {
      bridges[i] = Bridge(PointAt(here, 1), in, out, side, join);
    } else if (moved[i] && moved[after] && after != i) {
      MeetAtShallowCorner(&*moved[i], &*moved[after], side.distance_m);
    }
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (moved[i]) raw.push_back(*moved[i]);
    raw.insert(raw.end(), bridges[i].begin(), bridges[i].end());
  }
  std::erase_if(raw, [](const Piece& piece) { return Length(AsCurve(piece)) <= kCoincident_m; });
  return raw;
}

bool MayMeet(const Box& a, const Box& b) {
  return ((a.min - b.max).array() <= kMeeting_m).all() &&
         ((b.min - a.max).array() <= kMeeting_m).all();
}

// Where the piece is crossed by another, and where an end of that lies on it.
void AddCuts(const Curve& a, const Curve& b, std::vector<double>* at_a, std::vector<double>* at_b) {
  for (const Crossing& crossing : Crossings(a, b)) {
    at_a->push_back(crossing.t_a);
    at_b->push_back(crossing.t_b);
  }
  for (const double end : {0.0, 1.0}) {
    const Nearest on_a = NearestPoint(a, PointAt(b, end)), on_b = NearestPoint(b, PointAt(a, end));
    if (on_a.distance_m <= kCoincident_m) at_a->push_back(on_a.t);
    if (on_b.distance_m <= kCoincident_m) at_b->push_back(on_b.t);
  }
}

// Tells points that keep away from a curve from those that come nearer.
class Keeper {
 public:
  Keeper(const std::vector<Piece>& pieces, double distance_m) : nearest_m_(distance_m - kNearer_m) {
    for (const Piece& piece : pieces) {
      pieces_.push_back(AsCurve(piece));
      boxes_.push_back(BoundingBox(pieces_.back()));
    }
  }

  bool KeepsAway(const Vec3& p) {
    if (IsNear(last_, p)) return false;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (!IsNear(i, p)) continue;
      last_ = i;
      return false;
    }
    return true;
  }

 private:
  bool IsNear(std::size_t i, const Vec3& p) const {
    const Vec3 off = (boxes_[i].min - p).cwiseMax(p - boxes_[i].max).cwiseMax(0.0);
    if (off.squaredNorm() >= nearest_m_ * nearest_m_) return false;
    return NearestPoint(pieces_[i], p).distance_m < nearest_m_;
  }

  double nearest_m_;
  std::vector<Curve> pieces_;
  std::vector<Box> boxes_;
  std::size_t last_ = 0;  // what one point is near to, the next likely is, too
};

// The parts of the moved pieces, cut where they meet one another, that keep away. As each does or
// does not as a whole, its middle decides.
std::vector<Curve> PartsThatKeepAway(const std::vector<Piece>& raw, Keeper keeper) {
  std::vector<Curve> curves;
  std::vector<Box> boxes;
  for (const Piece& piece : raw) {
    curves.push_back(AsCurve(piece));
    boxes.push_back(BoundingBox(curves.back()));
  }
  std::vector<std::vector<double>> at(raw.size(), {0.0, 1.0});
  for (std::size_t i = 0; i < raw.size(); ++i) {
    for (std::size_t j = i + 1; j < raw.size(); ++j) {
      if (MayMeet(boxes[i], boxes[j])) AddCuts(curves[i], curves[j], &at[i], &at[j]);
    }
  }
  std::vector<Curve> parts;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const double length_m = Length(curves[i]);
    std::sort(at[i].begin(), at[i].end());
    for (std::size_t k = 0; k + 1 < at[i].size(); ++k) {
      const double from = at[i][k], to = at[i][k + 1];
      if ((to - from) * length_m <= kMeeting_m) continue;
      if (!keeper.KeepsAway(PointAt(curves[i], 0.5 * (from + to)))) continue;
      if (auto part = PartOf(curves[i], from, to)) parts.push_back(*std::move(part));
    }
  }
  return parts;
}

// Of parts that lie on one another one is left, and none where two run against one another, for
// nothing is between them.
void DropDoubles(std::vector<Curve>* parts) {
  struct Place {
    Vec3 middle, along;
    bool dropped = false;
  };
  std::vector<Place> places;
  for (const Curve& part : *parts) {
    const double t = ParameterAtFraction(part, 0.5);
    places.push_back({PointAt(part, t), TangentAt(part, t)});
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = i + 1; j < places.size() && !places[i].dropped; ++j) {
      Place &a = places[i], &b = places[j];
      if (b.dropped || (a.middle - b.middle).norm() > kMeeting_m) continue;
      if (a.along.cross(b.along).norm() > 1e-6) continue;
      b.dropped = true;
      a.dropped = a.along.dot(b.along) < 0;
    }
  }
  std::vector<Curve> left;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i].dropped) left.push_back(std::move((*parts)[i]));
  }
  *parts = std::move(left);
}

Curve Assembled(const std::vector<Curve>& parts, bool closed) {
  if (parts.size() == 1) return parts[0];
  const auto is_line = [](const Curve& part) { return std::holds_alternative<Line>(part); };
  if (std::all_of(parts.begin(), parts.end(), is_line)) {
    Polyline polyline{{std::get<Line>(parts[0]).start}, closed};
    for (const Curve& part : parts) {
      const Line& line = std::get<Line>(part);
      const std::size_t count = polyline.vertices.size();
      // Two halves of one side are one again.
      if (count > 1) {
        const Vec3 before = polyline.vertices[count - 1] - polyline.vertices[count - 2];
        const Vec3 along = line.end - line.start;
        if (before.cross(along).norm() <= 1e-12 * before.norm() * along.norm()) {
          polyline.vertices.pop_back();
        }
      }
      polyline.vertices.push_back(line.end);
    }
    if (closed) polyline.vertices.pop_back();
    return polyline;
  }
  Chain chain{{}, closed};
  for (const Curve& part : parts) {
    if (const auto* line = std::get_if<Line>(&part)) chain.segments.emplace_back(*line);
    if (const auto* arc = std::get_if<Arc>(&part)) chain.segments.emplace_back(*arc);
  }
  return chain;
}

// Parts joined end to start into as few curves as there can be.
std::vector<Curve> Joined(std::vector<Curve> parts) {
  const auto meet = [](const Curve& a, const Curve& b) {
    return (PointAt(a, 1) - PointAt(b, 0)).norm() <= 4 * kMeeting_m;
  };
  // Open curves begin with what no other leads to.
  const auto is_led_to = [&](const Curve& part) {
    return std::any_of(parts.begin(), parts.end(),
                       [&](const Curve& other) { return meet(other, part); });
  };
  std::stable_partition(parts.begin(), parts.end(),
                        [&](const Curve& part) { return !is_led_to(part); });
  std::vector<Curve> curves;
  std::vector<bool> used(parts.size());
  for (std::size_t first = 0; first < parts.size(); ++first) {
    if (used[first]) continue;
    std::vector<Curve> row;
    for (std::size_t at = first; at < parts.size();) {
      used[at] = true;
      row.push_back(parts[at]);
      std::size_t next = 0;
      while (next < parts.size() && (used[next] || !meet(row.back(), parts[next]))) ++next;
      at = next;
    }
    curves.push_back(Assembled(row, row.size() > 1 && meet(row.back(), row.front())));
  }
  return curves;
}

}  // namespace

Result<std::vector<Curve>> Offset(const Curve& curve, const Vec3& normal, double distance_m,
                                  OffsetJoin join) {
  if (auto checked = Check(curve); !checked) return tl::unexpected(checked.error());
  if (!(std::abs(distance_m) > kCoincident_m) || !std::isfinite(distance_m)) {
    return Refuse(ErrorCode::kOutOfRange, "a parallel lies at a distance above zero");
  }
  const auto pieces = PlanePieces(curve, normal);
  if (!pieces) return tl::unexpected(pieces.error());
  if (pieces->size() > kMostPieces) {
    return Refuse(ErrorCode::kOutOfRange, "it has more than five thousand pieces");
  }
  const Side side{normal, distance_m};
  if (const auto* circle = std::get_if<Circle>(&curve)) {
    const auto moved = Moved(pieces->front(), side);
    if (!moved) return std::vector<Curve>();
    return std::vector<Curve>{Circle{circle->frame, std::get<Arc>(*moved).radius}};
  }
  std::vector<Curve> parts = PartsThatKeepAway(RawPieces(*pieces, IsClosed(curve), side, join),
                                               Keeper(*pieces, std::abs(distance_m)));
  DropDoubles(&parts);
  return Joined(std::move(parts));
}

}  // namespace tranos::geom
