// SPDX-License-Identifier: GPL-3.0-or-later
// The plain values that all of geom speaks: points, frames, boxes, errors.
// Lengths are metres and angles radians throughout this room.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <string>
#include <tl/expected.hpp>

namespace tranos::geom {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
// Maps points of one frame to another; named `target_from_source`.
using Affine = Eigen::Transform<double, 3, Eigen::AffineCompact>;

inline constexpr double kPi = 3.141592653589793238462643383279502884;

// A right-handed orthonormal frame; z is x × y.
struct Frame {
  Vec3 origin = Vec3::Zero();
  Vec3 x = Vec3::UnitX();
  Vec3 y = Vec3::UnitY();
  Vec3 z() const { return x.cross(y); }
  Vec3 ToWorld(const Vec3& p) const { return origin + p.x() * x + p.y() * y + p.z() * z(); }
  Vec3 ToLocal(const Vec3& p) const {
    const Vec3 d = p - origin;
    return {d.dot(x), d.dot(y), d.dot(z())};
  }
  Affine WorldFromFrame() const;
};

// An axis-aligned box; empty until something is added.
struct Box {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());
  bool empty() const { return !(min.array() <= max.array()).all(); }
  void Add(const Vec3& p) { min = min.cwiseMin(p), max = max.cwiseMax(p); }
  void Add(const Box& b) { min = min.cwiseMin(b.min), max = max.cwiseMax(b.max); }
  Vec3 centre() const { return 0.5 * (min + max); }
};

// Around the box's image.
Box Carried(const Box& box, const Affine& target_from_source);

// How finely curved things are turned into facets: by the largest distance between
// chord and curve, or, if facets_per_turn > 0, by the facets of a full turn, the first
// vertex at angle 0.
struct Tolerance {
  double chord_m = 1e-3;
  int facets_per_turn = 0;
};

// Points nearer than this are one point, where curves are to meet.
inline constexpr double kCoincident_m = 1e-9;

enum class ErrorCode {
  kDegenerate,  // zero length, collinear points of an arc, zero normal …
  kNotClosed,   // something that must be closed is open
  kNotPlanar,   // something that must lie in a plane does not
  kDoNotMeet,   // ends of parts that are to be joined lie apart
  kNotAGraph,   // a surface with more than one height over a point of its plan
  kOutOfRange,  // a number outside the range the function states
  kTooLarge,    // a result above the stated cap (facets, poles)
  kUnreadable,  // bytes that are not, or not wholly, what they should be
};

// `detail` states the situation in words that fit after a colon; `part` is the index of the
// input at fault, or -1; `other` that of one that it does not go together with, or -1.
struct Error {
  ErrorCode code;
  std::string detail;
  int part = -1;
  int other = -1;
};
template <class T>
using Result = tl::expected<T, Error>;

}  // namespace tranos::geom
