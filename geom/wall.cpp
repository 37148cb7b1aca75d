// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/wall.h"

#include <algorithm>
#include <cmath>

#include "geom/outline.h"
#include "geom/skin.h"
#include "geom/triangulate.h"

namespace tranos::geom {
namespace {

tl::unexpected<Error> TooThick(std::size_t part) {
  return tl::unexpected(Error{ErrorCode::kOutOfRange, "the wall is thicker than its line allows",
                              static_cast<int>(part)});
}

// The line moved to one side: where the moved parts meet.
struct Offsets {
  std::vector<Vec3> right, left;  // at each corner of the line
};

class WallPlan {
 public:
  explicit WallPlan(const WallShape& wall) : wall_(wall), up_(wall.base.z()) {}

  std::size_t Count() const { return wall_.PartCount(); }
  std::size_t After(std::size_t i) const { return (i + 1) % wall_.line.size(); }
  Vec3 Along(std::size_t part) const {
    return (wall_.line[After(part)] - wall_.line[part]).normalized();
  }
  Vec3 Rightward(std::size_t part) const { return Along(part).cross(up_); }

  Result<Offsets> Offset() const {
    double length_m = 0;
    for (std::size_t k = 0; k < Count(); ++k) {
      length_m += (wall_.line[After(k)] - wall_.line[k]).norm();
    }
    if (wall_.left_m + wall_.right_m > length_m + kCoincident_m) return TooThick(0);
    Offsets offsets;
    for (std::size_t i = 0; i < wall_.line.size(); ++i) {
      const bool starts = !wall_.closed && i == 0, ends = !wall_.closed && i == Count();
      const Vec3 before = Rightward(starts ? 0 : (i + wall_.line.size() - 1) % wall_.line.size()),
                 after = Rightward(ends ? i - 1 : i);
      // Along m both parts' sides move equally: m·before = m·after = 1.
      const Vec3 sum = before + after;
      const Vec3 mitre = 2 / sum.squaredNorm() * sum;
      if (!mitre.allFinite() || !(sum.squaredNorm() > 1e-6))
        return TooThick(std::min(i, Count() - 1));
      offsets.right.push_back(wall_.line[i] + wall_.right_m * mitre);
      offsets.left.push_back(wall_.line[i] - wall_.left_m * mitre);
    }
    for (std::size_t k = 0; k < Count(); ++k) {
      for (const std::vector<Vec3>* side : {&offsets.right, &offsets.left}) {
        const Vec3 d = (*side)[After(k)] - (*side)[k];
        if (!(d.dot(Along(k)) > kCoincident_m)) return TooThick(k);
      }
    }
    return offsets;
  }

 private:
  const WallShape& wall_;
  Vec3 up_;
};

class WallBuilder {
 public:
  WallBuilder(const WallShape& wall, const Offsets& offsets)
      : wall_(wall), plan_(wall), offsets_(offsets), up_(wall.base.z()) {}

  Result<TriangleMesh> Build(const std::vector<WallOpening>& openings) {
    for (std::size_t k = 0; k < plan_.Count(); ++k) {
      if (auto added = AddPart(k, openings); !added) return tl::unexpected(added.error());
    }
    if (!wall_.closed) {
      const std::size_t last = plan_.Count();
      AddQuad(offsets_.left[0], offsets_.right[0]);
      AddQuad(offsets_.right[last], offsets_.left[last]);
    }
    return MayCross(FacingOutward(Welded(mesh_)));
  }

 private:
  // The part's two sides with their holes, its top and bottom, and the holes' reveals.
  tl::expected<void, Error> AddPart(std::size_t k, const std::vector<WallOpening>& openings) {
    const std::size_t next = plan_.After(k);
    std::vector<std::vector<Vec2>> holes;
    int first = -1;
    for (std::size_t i = 0; i < openings.size(); ++i) {
      if (openings[i].part != k) continue;
      if (first < 0) first = static_cast<int>(i);
      holes.push_back(Anticlockwise(openings[i].outline));
    }
    for (const bool right : {true, false}) {
      const std::vector<Vec3>& side = right ? offsets_.right : offsets_.left;
      if (!AddSide(k, side[k], side[next], holes, right)) {
        return tl::unexpected(
            Error{ErrorCode::kDoNotMeet, "an opening does not lie within its wall's face", first});
      }
    }
    for (const std::vector<Vec2>& hole : holes) AddReveal(k, hole);
    AddLevel(k, 0);
    AddLevel(k, wall_.height_m);
    return {};
  }

  static double DoubledArea(const std::vector<Vec2>& outline) {
    double doubled = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2 &p = outline[i], &q = outline[(i + 1) % outline.size()];
      doubled += p.x() * q.y() - p.y() * q.x();
    }
    return doubled;
  }
  static std::vector<Vec2> Anticlockwise(std::vector<Vec2> outline) {
    if (DoubledArea(outline) < 0) std::reverse(outline.begin(), outline.end());
    return outline;
  }

  Vec3 OnSide(std::size_t k, const Vec2& p, bool right) const {
    const double out_m = right ? wall_.right_m : -wall_.left_m;
    return wall_.line[k] + p.x() * plan_.Along(k) + out_m * plan_.Rightward(k) + p.y() * up_;
  }

  bool AddSide(std::size_t k, const Vec3& start, const Vec3& end,
               const std::vector<std::vector<Vec2>>& holes, bool right) {
    const Vec3 along = plan_.Along(k);
    const double from = (start - wall_.line[k]).dot(along), to = (end - wall_.line[k]).dot(along);
    std::vector<std::vector<Vec2>> loops = {
        {{from, 0}, {to, 0}, {to, wall_.height_m}, {from, wall_.height_m}}};
    std::vector<Vec3> corners = {start, end, end + wall_.height_m * up_,
                                 start + wall_.height_m * up_};
    for (const std::vector<Vec2>& hole : holes) {
      for (const Vec2& p : hole) {
        if (!(p.x() > from && p.x() < to && p.y() > 0 && p.y() < wall_.height_m)) return false;
        corners.push_back(OnSide(k, p, right));
      }
      loops.push_back(hole);
    }
    const auto triangles = TriangulatePolygon(loops);
    if (!triangles || !FillsAllBut(*triangles, loops)) return false;
    const std::uint32_t surface = surface_count_++;
    for (const auto& [a, b, c] : *triangles) {
      if (right) {
        AddTriangle(corners[a], corners[b], corners[c], surface);
      } else {
        AddTriangle(corners[c], corners[b], corners[a], surface);
      }
    }
    return true;
  }

  // Whether the triangles have the area of the first loop less the others': not if one of those
  // lies in another.
  static bool FillsAllBut(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                          const std::vector<std::vector<Vec2>>& loops) {
    std::vector<Vec2> points;
    double expected = 2 * DoubledArea(loops[0]);
    for (const std::vector<Vec2>& loop : loops) {
      expected -= DoubledArea(loop);
      points.insert(points.end(), loop.begin(), loop.end());
    }
    double doubled = 0;
    for (const auto& [a, b, c] : triangles)
      doubled += DoubledArea({points[a], points[b], points[c]});
    return std::abs(doubled - expected) <= 1e-9 * DoubledArea(loops[0]);
  }

  void AddReveal(std::size_t k, const std::vector<Vec2>& hole) {
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const Vec2 &a = hole[i], &b = hole[(i + 1) % hole.size()];
      const std::uint32_t surface = surface_count_++;
      const Vec3 p = OnSide(k, a, true), q = OnSide(k, b, true);
      const Vec3 r = OnSide(k, b, false), s = OnSide(k, a, false);
      AddTriangle(p, q, r, surface);
      AddTriangle(p, r, s, surface);
    }
  }

  void AddLevel(std::size_t k, double height_m) {
    const std::size_t next = plan_.After(k);
    const Vec3 up = height_m * up_;
    const Vec3 a = offsets_.right[k] + up, b = offsets_.right[next] + up,
               c = offsets_.left[next] + up, d = offsets_.left[k] + up;
    const bool top = height_m > 0;
    const std::uint32_t surface = top ? kTop : kBottom;
    if (top) {
      AddTriangle(a, b, c, surface);
      AddTriangle(a, c, d, surface);
    } else {
      AddTriangle(c, b, a, surface);
      AddTriangle(d, c, a, surface);
    }
  }

  // An end of the wall, from one foot to the other.
  void AddQuad(const Vec3& from, const Vec3& to) {
    const Vec3 up = wall_.height_m * up_;
    const std::uint32_t surface = surface_count_++;
    AddTriangle(from, to, to + up, surface);
    AddTriangle(from, to + up, from + up, surface);
  }

  void AddTriangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t surface) {
    for (const Vec3* p : {&a, &b, &c}) mesh_.positions.push_back(*p);
    const auto last = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.triangles.push_back({last - 3, last - 2, last - 1});
    mesh_.surfaces.push_back(surface);
  }

  static constexpr std::uint32_t kTop = 0, kBottom = 1;
  const WallShape& wall_;
  WallPlan plan_;
  const Offsets& offsets_;
  Vec3 up_;
  TriangleMesh mesh_;
  std::uint32_t surface_count_ = 2;
};

}  // namespace

Result<std::vector<WallFace>> FacesOf(const WallShape& wall) {
  const WallPlan plan(wall);
  const Result<Offsets> offsets = plan.Offset();
  if (!offsets) return tl::unexpected(offsets.error());
  std::vector<WallFace> faces;
  for (const bool right : {true, false}) {
    const std::vector<Vec3>& side = right ? offsets->right : offsets->left;
    for (std::size_t k = 0; k < plan.Count(); ++k) {
      const std::size_t next = plan.After(k);
      const Vec3 along = plan.Along(k);
      const Frame frame =
          right ? Frame{side[k], along, wall.base.z()} : Frame{side[next], -along, wall.base.z()};
      faces.push_back({frame, (side[next] - side[k]).norm()});
    }
  }
  return faces;
}

Result<TriangleMesh> WallMesh(const WallShape& wall, const std::vector<WallOpening>& openings) {
  const Result<Offsets> offsets = WallPlan(wall).Offset();
  if (!offsets) return tl::unexpected(offsets.error());
  return WallBuilder(wall, *offsets).Build(openings);
}

}  // namespace tranos::geom
