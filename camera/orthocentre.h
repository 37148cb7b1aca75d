// SPDX-License-Identifier: GPL-3.0-or-later
// The method `orthocentre`, the paper's 3.2.3: the camera from the self-polar triangle.
#pragma once

#include "camera/conic_rows.h"

namespace tranos::camera {

// K from the vanishing points of three orthogonal directions in coordinates with the same scale in
// x and y, supposing no skew and aspect 1: the principal point is the orthocentre of their
// triangle, f the height of the corner over it. Points at infinity may be among them. Error
// kDegenerate: two are at infinity, or the triangle is flat or has an obtuse angle: no real camera.
geom::Result<Mat3> CalibrationFromTriangle(const std::array<Vec3, 3>& vanishing_points);

// The camera of a photograph with lines of all three axes, supposing aspect 1 and a right angle
// between the dots' axes; pose from the same vanishing points, position from edges and points in
// space. Where nothing is known in space the position means nothing. Error kDegenerate: an axis has
// no vanishing point, or see above.
geom::Result<Camera> CalibrateOrthocentre(const Photograph& photograph, const Numbers& numbers);

}  // namespace tranos::camera
