// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/solid_rounding.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/conform.h"

namespace tranos::geom {

namespace {

using Corners = std::array<std::uint32_t, 3>;

// More rounds than were ever needed: each is of displacements of a last bit.
constexpr int kMostRounds = 6;

// Whether a corner is nearer than kCoincident_m to the opposite side.
bool IsLine(const TriangleMesh& mesh, const Corners& t) {
  const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return (b - a).cross(c - a).norm() <= kCoincident_m * longest;
}

void EraseMarked(const std::vector<bool>& is_gone, TriangleMesh* mesh) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
    if (is_gone[i]) continue;
    mesh->triangles[kept] = mesh->triangles[i];
    mesh->surfaces[kept++] = mesh->surfaces[i];
  }
  mesh->triangles.resize(kept);
  mesh->surfaces.resize(kept);
}

// Two triangles on the same corners that look against one another enclose nothing.
void RemoveFolds(TriangleMesh* mesh) {
  std::map<Corners, std::vector<std::pair<std::uint32_t, bool>>> by_corners;
  std::vector<bool> is_gone(mesh->triangles.size());
  for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
    Corners c = mesh->triangles[i];
    if (HasTwice(c)) {
      is_gone[i] = true;
      continue;
    }
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    const bool is_turned = c[1] > c[2];
    if (is_turned) std::swap(c[1], c[2]);
    auto& at = by_corners[c];
    const auto against = std::find_if(at.begin(), at.end(),
                                      [&](const auto& other) { return other.second != is_turned; });
    if (against == at.end()) {
      at.emplace_back(i, is_turned);
    } else {
      is_gone[i] = is_gone[against->first] = true;
      at.erase(against);
    }
  }
  EraseMarked(is_gone, mesh);
}

// A triangle whose corners lie in a line goes; the neighbour along its longest side is divided at
// the corner in the middle. The surface stays closed. False if there was none.
bool RemoveOneRoundOfLines(TriangleMesh* mesh) {
  std::vector<std::uint32_t> lines;
  for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
    if (IsLine(*mesh, mesh->triangles[i])) lines.push_back(i);
  }
  if (lines.empty()) return false;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> by_side;
  for (std::uint32_t i = 0; i < mesh->triangles.size(); ++i) {
    const Corners& t = mesh->triangles[i];
    for (int k = 0; k < 3; ++k) by_side[{t[k], t[(k + 1) % 3]}].push_back(i);
  }
  std::vector<bool> is_gone(mesh->triangles.size()), is_busy(mesh->triangles.size());
  for (const std::uint32_t line : lines) {
    if (is_busy[line]) continue;
    const Corners t = mesh->triangles[line];
    int longest = 0;
    double length = -1;
    for (int k = 0; k < 3; ++k) {
      const double side = (mesh->positions[t[(k + 1) % 3]] - mesh->positions[t[k]]).norm();
      if (side > length) length = side, longest = k;
    }
    const std::uint32_t a = t[longest], b = t[(longest + 1) % 3], middle = t[(longest + 2) % 3];
    for (const std::uint32_t other : by_side[{b, a}]) {
      if (is_busy[other] || other == line) continue;
      Corners first = mesh->triangles[other], second = first;
      std::replace(first.begin(), first.end(), b, middle);
      std::replace(second.begin(), second.end(), a, middle);
      mesh->triangles[other] = first;
      mesh->triangles[line] = second;
      mesh->surfaces[line] = mesh->surfaces[other];
      is_busy[other] = is_busy[line] = true;
      break;
    }
  }
  RemoveFolds(mesh);
  return true;
}

Soup SoupOf(const TriangleMesh& mesh) {
  Soup soup{mesh.positions, {}};
  for (const Corners& t : mesh.triangles) soup.facets.push_back({t, 0});
  return soup;
}

bool HasCrossingAt(const TriangleMesh& mesh, const std::vector<bool>& is_rounded) {
  std::vector<bool> is_suspect;
  for (const Corners& t : mesh.triangles) {
    is_suspect.push_back(is_rounded.empty() || is_rounded[t[0]] || is_rounded[t[1]] ||
                         is_rounded[t[2]]);
  }
  return HasCrossing(SoupOf(mesh), is_suspect);
}

void RemoveLines(TriangleMesh* mesh) {
  RemoveFolds(mesh);
  for (int round = 0; round < 100 && RemoveOneRoundOfLines(mesh); ++round) {
  }
}

TriangleMesh MeshOf(const Arrangement& arrangement, const std::vector<SurfacePiece>& pieces,
                    std::vector<bool>* is_rounded) {
  TriangleMesh mesh;
  PositionIndex index;
  std::vector<std::uint32_t> number(arrangement.corner_count(), 0xffffffff);
  for (const SurfacePiece& piece : pieces) {
    Corners t;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t corner = piece.corners[i];
      if (number[corner] == 0xffffffff) {
        const Vec3 place = arrangement.Rounded(corner);
        number[corner] = index.Of(place, &mesh.positions);
        is_rounded->resize(mesh.positions.size());
        if (arrangement.IsRounded(corner) || mesh.positions[number[corner]] != place) {
          (*is_rounded)[number[corner]] = true;
        }
      }
      t[i] = number[corner];
    }
    mesh.triangles.push_back(t);
    mesh.surfaces.push_back(piece.surface);
  }
  return mesh;
}

// What counts as enclosed: rounding turns slivers inside out, which enclose nothing; a twisted loft
// is meant to be solid on both sides of the twist.
enum class Enclosed : std::uint8_t { kOutward, kEitherWay };

Result<TriangleMesh> CutAgain(const TriangleMesh& mesh, Enclosed enclosed) {
  const auto is_inside = [&](int winding) {
    return enclosed == Enclosed::kOutward ? winding > 0 : winding != 0;
  };
  const Arrangement arrangement(SoupOf(mesh), true);
  const std::vector<std::uint32_t> patches = PatchesOf(arrangement);
  std::vector<int> side(patches.size());  // 1: the inside is behind; −1: in front
  std::vector<SurfacePiece> kept;
  for (std::uint32_t i = 0; i < patches.size(); ++i) {
    const Piece& piece = arrangement.pieces()[i];
    const auto labels = arrangement.LabelsOf(piece);
    if (patches[i] == i) {
      const auto front = arrangement.Winding(piece, 0);
      if (!front) return tl::unexpected(front.error());
      int behind = *front;
      for (const PieceLabel& label : labels) behind += label.opposite ? -1 : 1;
      side[i] = int{is_inside(behind)} - int{is_inside(*front)};
    }
    if (side[patches[i]] == 0) continue;
    SurfacePiece surface{piece.corners, labels[0].facet, mesh.surfaces[labels[0].facet],
                         side[patches[i]] < 0, true};
    if (surface.turned) std::swap(surface.corners[1], surface.corners[2]);
    kept.push_back(surface);
  }
  std::vector<bool> is_rounded;
  return MeshOf(arrangement, kept, &is_rounded);
}

// The mesh without crossings: what all but lies in something else is put there, and what crosses
// still is cut.
Result<TriangleMesh> Settled(TriangleMesh mesh) {
  for (int round = 0; round < kMostRounds; ++round) {
    mesh = Conformed(std::move(mesh));
    RemoveLines(&mesh);
    if (!HasCrossingAt(mesh, {})) return mesh;
    auto again = CutAgain(mesh, Enclosed::kOutward);
    if (!again) return again;
    mesh = std::move(*again);
    RemoveLines(&mesh);
  }
  return tl::unexpected(
      Error{ErrorCode::kDegenerate, "facets so near one another that rounding makes them cross"});
}

}  // namespace

std::uint32_t PositionIndex::Of(const Vec3& p, std::vector<Vec3>* list) {
  // Cells many times wider than what is near, so that most places lie inside one.
  constexpr double kCell_m = 1e-6;
  const auto floor = [](double x) { return static_cast<std::int64_t>(std::floor(x / kCell_m)); };
  std::array<std::array<std::int64_t, 2>, 3> range;
  for (int k = 0; k < 3; ++k) range[k] = {floor(p[k] - reach_m_), floor(p[k] + reach_m_)};
  for (std::int64_t x = range[0][0]; x <= range[0][1]; ++x) {
    for (std::int64_t y = range[1][0]; y <= range[1][1]; ++y) {
      for (std::int64_t z = range[2][0]; z <= range[2][1]; ++z) {
        const auto [begin, end] = numbers_.equal_range({x, y, z});
        for (auto at = begin; at != end; ++at) {
          if (((*list)[at->second] - p).norm() <= reach_m_) return at->second;
        }
      }
    }
  }
  const auto number = static_cast<std::uint32_t>(list->size());
  list->push_back(p.array() + 0.0);  // −0 is 0
  numbers_.emplace(Cell{floor(p.x()), floor(p.y()), floor(p.z())}, number);
  return number;
}

TriangleMesh Merged(TriangleMesh mesh, double reach_m) {
  PositionIndex index(reach_m);
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> number;
  number.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) number.push_back(index.Of(p, &positions));
  mesh.positions = std::move(positions);
  std::vector<bool> is_gone(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Corners& t = mesh.triangles[i];
    t = {number[t[0]], number[t[1]], number[t[2]]};
    is_gone[i] = HasTwice(t);
  }
  EraseMarked(is_gone, &mesh);
  return mesh;
}

TriangleMesh Tidied(TriangleMesh mesh) {
  const std::size_t count = mesh.triangles.size();
  mesh = Merged(std::move(mesh), kCoincident_m);
  const auto is_line = [&](const Corners& t) { return IsLine(mesh, t); };
  if (mesh.triangles.size() < count ||
      std::any_of(mesh.triangles.begin(), mesh.triangles.end(), is_line)) {
    RemoveLines(&mesh);
  }
  return mesh;
}

Result<TriangleMesh> Rounded(const Arrangement& arrangement,
                             const std::vector<SurfacePiece>& pieces) {
  std::vector<bool> is_rounded;
  TriangleMesh mesh = MeshOf(arrangement, pieces, &is_rounded);
  RemoveLines(&mesh);
  if (!HasCrossingAt(mesh, is_rounded) && !HasNearMiss(SoupOf(mesh))) return mesh;
  return Settled(std::move(mesh));
}

Result<TriangleMesh> Uncrossed(const TriangleMesh& mesh) {
  auto cut = CutAgain(mesh, Enclosed::kEitherWay);
  if (!cut) return cut;
  RemoveLines(&*cut);
  return HasCrossingAt(*cut, {}) ? Settled(std::move(*cut)) : cut;
}

}  // namespace tranos::geom
