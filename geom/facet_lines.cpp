// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/facet_lines.h"

#include <algorithm>
#include <cmath>

namespace tranos::geom {
namespace {

constexpr double kEqualWeights = 1e-12;
constexpr double kSameCentre = 1e-9;

// Half the sweep of the span's arcs, if every column of poles along u is a standard circular arc
// (or an affine image of one) of the same sweep; else zero.
double HalfSweepOf(const PatchGrid& grid, int span) {
  if (grid.at(span, 0).rows.size() != 3) return 0;
  double cosine = 0;
  for (int j = 0; j < grid.count_v(); ++j) {
    const auto& rows = grid.at(span, j).rows;
    for (int k = 0; k < rows[0].cols(); ++k) {
      const double w0 = rows[0](3, k), w1 = rows[1](3, k), w2 = rows[2](3, k);
      if (j == 0 && k == 0) cosine = w1 / w0;
      if (std::abs(w2 - w0) > kEqualWeights * w0 ||
          std::abs(w1 - cosine * w0) > kEqualWeights * w0) {
        return 0;
      }
    }
  }
  return cosine > 0 && cosine < 1 - 1e-9 ? std::acos(cosine) : 0;
}

bool IsStraight(const PatchGrid& grid, int span) {
  for (int j = 0; j < grid.count_v(); ++j) {
    const BezierPatch& patch = grid.at(span, j);
    for (int k = 0; k < patch.rows[0].cols(); ++k) {
      const BezierPoles column = ColumnOf(patch, k);
      const double scale = column.cwiseAbs().maxCoeff();
      if ((column.row(3).array() - column(3, 0)).abs().maxCoeff() > kEqualWeights * column(3, 0)) {
        return false;
      }
      for (int i = 1; i + 1 < column.cols(); ++i) {
        const Vec4 bend = column.col(i + 1) - 2 * column.col(i) + column.col(i - 1);
        if (bend.norm() > 1e-14 * scale) return false;
      }
    }
  }
  return true;
}

struct Ellipse {
  Vec3 centre;
  double reach_m;
};

// The ellipse that a standard arc of poles p0 p1 p2 lies on.
Ellipse EllipseOf(const BezierPoles& column, double half_rad) {
  const Vec3 p0 = Projected(column.col(0)), p1 = Projected(column.col(1)),
             p2 = Projected(column.col(2));
  const double cosine = std::cos(half_rad), sine = std::sin(half_rad);
  const Vec3 middle = 0.5 * (p0 + p2);
  const Vec3 centre = p1 + (middle - p1) / (sine * sine);
  // Two conjugate radii; the longest radius is the larger singular value of the pair.
  const Vec3 a = (middle + cosine * p1) / (1 + cosine) - centre, b = (p2 - p0) / (2 * sine);
  const double mean = 0.5 * (a.squaredNorm() + b.squaredNorm());
  const double half = 0.5 * (a.squaredNorm() - b.squaredNorm());
  return {centre, std::sqrt(mean + std::hypot(half, a.dot(b)))};
}

std::vector<Ellipse> EllipsesOf(const PatchGrid& grid, int span, double half_rad) {
  std::vector<Ellipse> ellipses;
  for (int j = 0; j < grid.count_v(); ++j) {
    const BezierPatch& patch = grid.at(span, j);
    for (int k = 0; k < patch.rows[0].cols(); ++k) {
      ellipses.push_back(EllipseOf(ColumnOf(patch, k), half_rad));
    }
  }
  return ellipses;
}

double Reach(const std::vector<Ellipse>& ellipses) {
  double reach_m = 0;
  for (const Ellipse& e : ellipses) reach_m = std::max(reach_m, e.reach_m);
  return reach_m;
}

bool SameEllipses(const std::vector<Ellipse>& a, const std::vector<Ellipse>& b) {
  const double tolerance_m = kSameCentre * (Reach(a) + Reach(b));
  for (std::size_t i = 0; i < a.size(); ++i) {
    if ((a[i].centre - b[i].centre).norm() > tolerance_m ||
        std::abs(a[i].reach_m - b[i].reach_m) > tolerance_m) {
      return false;
    }
  }
  return true;
}

// The largest bend (second derivative across the tangent) and turning along u of the span.
SpanGroup GeneralGroup(const PatchGrid& grid, int span) {
  SpanGroup group{SpanGroup::Kind::kGeneral, span, 1};
  for (int j = 0; j < grid.count_v(); ++j) {
    const BezierPatch& patch = grid.at(span, j);
    for (int k = 0; k < patch.rows[0].cols(); ++k) {
      group.turning_rad = std::max(group.turning_rad, TurningOf(ColumnOf(patch, k)));
    }
    for (int n = 0; n < 9 * 5; ++n) {
      const SurfaceJet jet = JetOf(patch, n / 5 / 8.0, n % 5 / 4.0);
      const double speed = jet.du.norm();
      const double bend = speed > 0 ? jet.duu.cross(jet.du).norm() / speed : jet.duu.norm();
      group.reach_m = std::max(group.reach_m, bend);
    }
  }
  return group;
}

constexpr std::array<double, 4> kAcross = {0.07, 0.37, 0.61, 0.94};

// Whether the normals of the patches on either side of a line of constant u differ somewhere.
bool BreaksBetween(const PatchGrid& grid, int before, int after) {
  for (int j = 0; j < grid.count_v(); ++j) {
    for (const double t : kAcross) {
      const Vec3 left = LimitNormal(grid.at(before, j), 1, t, {-1, 0});
      const Vec3 right = LimitNormal(grid.at(after, j), 0, t, {1, 0});
      if (left.isZero() || right.isZero()) continue;
      if (AngleBetween(left, right) > kCrease_rad) return true;
    }
  }
  return false;
}

bool ClosesAlongU(const PatchGrid& grid) {
  bool collapsed = true;
  const Vec3 first = PointOf(grid.at(0, 0), 0, 0);
  for (int j = 0; j < grid.count_v(); ++j) {
    for (const double t : {0.0, 0.29, 0.71, 1.0}) {
      const Vec3 a = PointOf(grid.at(0, j), 0, t),
                 b = PointOf(grid.at(grid.count_u() - 1, j), 1, t);
      if (!((a - b).norm() <= kCoincident_m)) return false;
      collapsed = collapsed && (a - first).norm() <= kCoincident_m;
    }
  }
  return !collapsed;
}

void AppendArcLines(const SpanGroup& group, const std::vector<double>& half_rad, double count,
                    std::vector<FacetLine>& lines) {
  int span = group.first;
  double begin_rad = 0;
  for (double i = 0; i < count; ++i) {
    const double angle = group.sweep_rad * i / count;
    while (span + 1 < group.first + group.count &&
           angle >= begin_rad + 2 * half_rad[span] - 1e-12) {
      begin_rad += 2 * half_rad[span++];
    }
    const double within = angle - begin_rad;
    if (within <= 1e-12) {
      lines.push_back({span, 0});
      continue;
    }
    // On a standard arc the chords to both ends are as s to 1 − s.
    const double from = std::sin(0.5 * within), to = std::sin(half_rad[span] - 0.5 * within);
    lines.push_back({span, from / (from + to)});
  }
}

}  // namespace

double AngleBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Vec3 LimitNormal(const BezierPatch& patch, double s, double t, const Vec2& towards) {
  constexpr double kSmall = 1e-10;
  const SurfaceJet jet = JetOf(patch, s, t);
  const double size =
      jet.du.norm() + jet.dv.norm() + jet.duu.norm() + jet.duv.norm() + jet.dvv.norm();
  const Vec3 normal = jet.du.cross(jet.dv);
  if (normal.norm() > kSmall * size * size) return normal.normalized();
  const Vec3 change = (towards.x() * jet.duu + towards.y() * jet.duv).cross(jet.dv) +
                      jet.du.cross(towards.x() * jet.duv + towards.y() * jet.dvv);
  if (change.norm() > kSmall * size * size) return change.normalized();
  const SurfaceJet near = JetOf(patch, s + 1e-3 * towards.x(), t + 1e-3 * towards.y());
  const Vec3 nearby = near.du.cross(near.dv);
  return nearby.norm() > 1e-24 * size * size ? Vec3(nearby.normalized()) : Vec3::Zero();
}

PatchGrid Exchanged(const PatchGrid& grid) {
  PatchGrid exchanged;
  exchanged.breaks_u = grid.breaks_v;
  exchanged.breaks_v = grid.breaks_u;
  exchanged.patches.reserve(grid.patches.size());
  for (int j = 0; j < grid.count_v(); ++j) {
    for (int i = 0; i < grid.count_u(); ++i) {
      const BezierPatch& patch = grid.at(i, j);
      BezierPatch turned;
      for (int k = 0; k < patch.rows[0].cols(); ++k) turned.rows.push_back(ColumnOf(patch, k));
      exchanged.patches.push_back(std::move(turned));
    }
  }
  return exchanged;
}

Direction DirectionAlongU(const PatchGrid& grid) {
  const int count = grid.count_u();
  Direction direction;
  direction.closed = ClosesAlongU(grid);
  direction.crease.assign(count + 1, false);
  for (int i = 1; i < count; ++i) direction.crease[i] = BreaksBetween(grid, i - 1, i);
  if (direction.closed) {
    direction.crease[0] = direction.crease[count] = BreaksBetween(grid, count - 1, 0);
  }
  std::vector<Ellipse> before;
  for (int i = 0; i < count; ++i) {
    const double half_rad = HalfSweepOf(grid, i);
    direction.half_rad.push_back(half_rad);
    if (half_rad == 0) {
      direction.groups.push_back(IsStraight(grid, i) ? SpanGroup{SpanGroup::Kind::kStraight, i, 1}
                                                     : GeneralGroup(grid, i));
      continue;
    }
    std::vector<Ellipse> ellipses = EllipsesOf(grid, i, half_rad);
    const bool continues = i > 0 && direction.half_rad[i - 1] > 0 && !direction.crease[i] &&
                           SameEllipses(before, ellipses);
    if (!continues) direction.groups.push_back({SpanGroup::Kind::kArc, i, 0});
    SpanGroup& group = direction.groups.back();
    ++group.count;
    group.sweep_rad += 2 * half_rad;
    group.reach_m = std::max(group.reach_m, Reach(ellipses));
    before = std::move(ellipses);
  }
  return direction;
}

std::vector<double> FacetCounts(const Direction& direction, const Tolerance& tolerance,
                                double factor) {
  std::vector<double> counts;
  for (const SpanGroup& group : direction.groups) {
    double count = 1;
    if (group.kind == SpanGroup::Kind::kArc) {
      count = ArcFacets(group.reach_m, group.sweep_rad, tolerance);
    } else if (group.kind == SpanGroup::Kind::kGeneral) {
      count = tolerance.facets_per_turn > 0
                  ? TurningFacets(group.turning_rad, tolerance)
                  : std::max(1.0, std::ceil(std::sqrt(0.125 * group.reach_m / tolerance.chord_m)));
    }
    counts.push_back(std::ceil(count * factor * (1 - 1e-12)));
  }
  return counts;
}

std::vector<FacetLine> LinesOf(const Direction& direction, const std::vector<double>& counts) {
  std::vector<FacetLine> lines;
  for (std::size_t g = 0; g < direction.groups.size(); ++g) {
    const SpanGroup& group = direction.groups[g];
    if (group.kind == SpanGroup::Kind::kArc) {
      AppendArcLines(group, direction.half_rad, counts[g], lines);
    } else {
      for (double i = 0; i < counts[g]; ++i) lines.push_back({group.first, i / counts[g]});
    }
  }
  for (FacetLine& line : lines) line.crease = line.local == 0 && direction.crease[line.span];
  lines.push_back({static_cast<int>(direction.half_rad.size()) - 1, 1, direction.crease.back()});
  return lines;
}

}  // namespace tranos::geom
