// SPDX-License-Identifier: GPL-3.0-or-later
// Upright planes that facades lie in, and where to look for them at first.
#pragma once

#include <span>

#include "camera/residuals.h"
#include "camera/traces.h"

namespace tranos::camera {

// An upright plane, with coordinates along it to the right and upward as seen from outside, in
// metres from the foot of the perpendicular from the world's origin. The default is y = 0.
struct FacadePlane {
  double azimuth_rad = 0;  // of `right`, from X towards Y
  double distance_m = 0;   // from the world's origin, along `away`

  Vec3 right() const { return {std::cos(azimuth_rad), std::sin(azimuth_rad), 0}; }
  Vec3 away() const { return {-std::sin(azimuth_rad), std::cos(azimuth_rad), 0}; }  // to within
  Vec3 Point(const Vec2& p) const {
    return distance_m * away() + p.x() * right() + Vec3(0, 0, p.y());
  }
  // The derivative of Point(p).
  Vec3 ByAzimuth(const Vec2& p) const { return p.x() * away() - distance_m * right(); }
  // Where the dot's ray meets it; not finite where they are parallel.
  Vec2 Meet(const View&, const Vec2& dot_px) const;
};

// Whether the second edge of a ratio goes anticlockwise from the first, seen from outside: 1, or
// −1.
double TurnOf(const RatioTrace&);

// The circle with the least sum of squared (d² − r²), d the distances of the points from its
// centre.
struct PlaneCircle {
  Vec2 centre;
  double radius;
};
PlaneCircle FitCircle(const std::vector<Vec2>& points);

struct OnFacade {
  const View* view;
  const Trace* trace;  // a rectangle, a ratio or a circle
};
// The plane in which the traces come nearest to the shapes they are said to be, of azimuths 2°
// apart and, from the first rectangle's size, its distance. Without a rectangle that is 10 m from
// the camera.
FacadePlane LikelyPlane(std::span<const OnFacade>, const Numbers&);

}  // namespace tranos::camera
