// SPDX-License-Identifier: GPL-3.0-or-later
// A circle carried along a path: exact on lines, and on arcs that go on smoothly at both ends.
#include <cmath>

#include "geom/curve_pieces.h"
#include "geom/faceted_curve.h"
#include "geom/surface_patches.h"

namespace tranos::geom {
namespace {

// A stretch of the path between two stations: along a chord, or round an arc.
struct Leg {
  Vec3 from, to;
  Vec3 out, in;  // the path's directions where it begins and ends
  std::optional<Arc> arc = {};
};

tl::unexpected<Error> TooTight() {
  return tl::unexpected(
      Error{ErrorCode::kOutOfRange, "the path turns too tightly for the tube, or turns back"});
}

bool IsSmooth(const Vec3& in, const Vec3& out) { return in.cross(out).norm() < 1e-6; }

Leg LegOf(const Arc& arc) {
  const Curve curve = arc;
  return {PointAt(curve, 0), PointAt(curve, 1), TangentAt(curve, 0), TangentAt(curve, 1), arc};
}

// The path's legs: lines whole, arcs whole where both their neighbours meet them smoothly, what is
// left by chords.
Result<std::vector<Leg>> LegsOf(const Curve& path, const Tolerance& tolerance) {
  std::vector<Curve> pieces;
  ForEachPiece(path, [&](const auto& piece, double, double) {
    if (LengthOf(piece) > kCoincident_m) pieces.push_back(piece);
  });
  const std::size_t count = pieces.size();
  const bool closed = IsClosed(path);
  const auto meets_smoothly = [&](std::size_t before, std::size_t after) {
    return IsSmooth(TangentAt(pieces[before], 1), TangentAt(pieces[after], 0));
  };
  std::vector<Leg> legs;
  for (std::size_t i = 0; i < count; ++i) {
    const auto* arc = std::get_if<Arc>(&pieces[i]);
    const bool begins = !closed && i == 0, ends = !closed && i + 1 == count;
    if (arc && (begins || meets_smoothly((i + count - 1) % count, i)) &&
        (ends || meets_smoothly(i, (i + 1) % count))) {
      legs.push_back(LegOf(*arc));
      continue;
    }
    const Result<FacetedCurve> facets = FacetsOf(pieces[i], tolerance);
    if (!facets) return tl::unexpected(facets.error());
    for (std::size_t k = 0; k < facets->FacetCount(); ++k) {
      const FacetCorner &a = facets->corners[k],
                        &b = facets->corners[(k + 1) % facets->corners.size()];
      legs.push_back({a.point, b.point, a.out, b.in});
    }
  }
  return legs;
}

// Rows of poles along the path, each a circle or what a mitre makes of one.
class TubeMaker {
 public:
  TubeMaker(std::vector<Leg> legs, bool closed, double radius_m)
      : legs_(std::move(legs)),
        closed_(closed),
        radius_m_(radius_m),
        circle_(JoinSpans(BezierSpansOf(Arc{Frame{}, 1, 2 * kPi}))) {
    for (const Leg& leg : legs_) degree_ = leg.arc ? 2 : degree_;
  }

  Result<Surface> Make(const Vec3& up) {
    const Leg& first = legs_.front();
    Vec3 right = first.out.cross(up);
    right = right.norm() > 1e-6 ? right.normalized() : first.out.unitOrthogonal();
    axes_ = {right, right.cross(first.out)};
    auto section =
        SectionAt(first.from, closed_ ? legs_.back().in : first.out, first.out, first.out);
    if (!section) return TooTight();
    AddRow(*section, 1);
    for (std::size_t k = 0; k < legs_.size(); ++k) {
      if (!AddLeg(k)) return TooTight();
    }
    Surface result = Finished();
    if (auto checked = Check(result); !checked) return tl::unexpected(checked.error());
    return result;
  }

 private:
  using Row = std::vector<Vec3>;
  struct Axes {
    Vec3 x, y;  // of the circle, square to the path's direction
  };

  // The tube of this direction, cut halfway between the path's directions before and after.
  std::optional<Row> SectionAt(const Vec3& centre, const Vec3& in, const Vec3& out,
                               const Vec3& along) const {
    const Vec3 normal = (in + out).normalized();
    if (!normal.allFinite() || !(along.dot(normal) > 1e-6)) return std::nullopt;
    Row row;
    for (const Vec3& pole : circle_.poles) {
      const Vec3 v = radius_m_ * (pole.x() * axes_.x + pole.y() * axes_.y);
      row.push_back(centre + v - v.dot(normal) / along.dot(normal) * along);
    }
    return row;
  }

  void Turn(const Vec3& from, const Vec3& to) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(from, to);
    axes_ = {turn * axes_.x, turn * axes_.y};
  }

  bool AddLeg(std::size_t k) {
    const Leg& leg = legs_[k];
    if (leg.arc && !AddArc(*leg.arc)) return false;
    const bool ends = k + 1 == legs_.size();
    const Vec3 next = ends ? (closed_ ? legs_.front().out : leg.in) : legs_[k + 1].out;
    if (!leg.arc) {
      Turn(leg.out, leg.in);
      const auto section = SectionAt(leg.to, leg.in, next, leg.in);
      if (!section || !GoesForward(rows_.back(), *section, leg.to - leg.from)) return false;
      if (degree_ == 2) {
        Row middle;
        for (std::size_t i = 0; i < section->size(); ++i) {
          middle.push_back(0.5 * (rows_.back()[i] + (*section)[i]));
        }
        AddRow(middle, 1);
      }
      AddRow(*section, 1);
    }
    Turn(leg.in, next);
    return true;
  }

  static bool GoesForward(const Row& from, const Row& to, const Vec3& chord) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (!((to[i] - from[i]).dot(chord) > kCoincident_m * chord.norm())) return false;
    }
    return true;
  }

  // A part of a torus, by spans of a right angle at most.
  bool AddArc(const Arc& arc) {
    if (!(radius_m_ < arc.radius - kCoincident_m)) return false;
    const int spans = static_cast<int>(std::ceil(arc.sweep_rad / (kPi / 2) - 1e-9));
    const double half_rad = 0.5 * arc.sweep_rad / spans;
    const Vec3 axis = arc.frame.z();
    for (int s = 0; s < spans; ++s) {
      const Row start = rows_.back();
      const auto turned = [&](double angle_rad, double stretch) {
        Row row;
        for (const Vec3& p : start) {
          const Vec3 d = p - arc.frame.origin, foot = arc.frame.origin + d.dot(axis) * axis;
          row.push_back(foot + stretch * (Eigen::AngleAxisd(angle_rad, axis) * (p - foot)));
        }
        return row;
      };
      AddRow(turned(half_rad, 1 / std::cos(half_rad)), std::cos(half_rad));
      AddRow(turned(2 * half_rad, 1), 1);
    }
    const Eigen::AngleAxisd turn(arc.sweep_rad, axis);
    axes_ = {turn * axes_.x, turn * axes_.y};
    return true;
  }

  void AddRow(const Row& row, double weight) {
    rows_.push_back(row);
    weights_.push_back(weight);
  }

  BsplineSurface Finished() {
    // The circle comes home turned in itself only where the path is no plane one.
    const bool comes_home = closed_ && (rows_.front()[0] - rows_.back()[0]).norm() < kCoincident_m;
    if (comes_home) rows_.back() = rows_.front();
    BsplineSurface surface;
    surface.degree_u = circle_.degree;
    surface.degree_v = degree_;
    surface.knots_u = circle_.knots;
    surface.count_u = static_cast<int>(circle_.poles.size());
    surface.count_v = static_cast<int>(rows_.size());
    const int spans = (surface.count_v - 1) / degree_;
    surface.knots_v = {0};
    for (int i = 0; i <= spans; ++i) surface.knots_v.insert(surface.knots_v.end(), degree_, i);
    surface.knots_v.push_back(spans);
    for (std::size_t i = 0; i < circle_.poles.size(); ++i) {
      for (std::size_t k = 0; k < rows_.size(); ++k) {
        surface.poles.push_back(rows_[k][i]);
        surface.weights.push_back(circle_.weights[i] * weights_[k]);
      }
    }
    return surface;
  }

  std::vector<Leg> legs_;
  bool closed_;
  double radius_m_;
  BsplineCurve circle_;  // of radius 1 about the origin
  int degree_ = 1;       // along the path
  Axes axes_;
  std::vector<Row> rows_;
  std::vector<double> weights_;
};

}  // namespace

Result<Surface> Tube(const Curve& path, double radius_m, const Vec3& up,
                     const Tolerance& tolerance) {
  if (auto checked = Check(path); !checked) return tl::unexpected(checked.error());
  if (!(radius_m > kCoincident_m)) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the radius is nothing"});
  }
  Result<std::vector<Leg>> legs = LegsOf(path, tolerance);
  if (!legs) return tl::unexpected(legs.error());
  if (legs->empty()) {
    return tl::unexpected(Error{ErrorCode::kDegenerate, "the path has no length"});
  }
  return TubeMaker(*std::move(legs), IsClosed(path), radius_m).Make(up);
}

}  // namespace tranos::geom
