// SPDX-License-Identifier: GPL-3.0-or-later
// The method `dlt`: the direct linear transformation of points and edges whose place is known.
#pragma once

#include "camera/pose.h"

namespace tranos::camera {

// K, R and the position of P (conditioned dots from points in the world, either sign) by RQ
// decomposition. Error kDegenerate: the left part of P is not of full rank.
geom::Result<ConditionedCamera> DecomposeProjection(const ProjectionMatrix& projection);

// The projection matrix, to conditioned dots, with the least sum of squares of the algebraic
// distances, weighted anew by the depths found; Frobenius norm 1, the traces in front. Error
// kDegenerate: fewer than eleven independent equations (two for each point and edge), as of points
// in one plane.
geom::Result<ProjectionMatrix> FitProjection(const SpaceTraces& traces);

// All eleven parameters from six or more control points not in a plane, or edges in space, or both:
// normalised direct linear transformation (Abdel-Aziz and Karara 1971; Hartley 1997), K and pose by
// RQ. Error kDegenerate: see above, or the picture is mirrored or behind the camera.
geom::Result<Camera> CalibrateDlt(const Photograph& photograph, const Numbers& numbers);

}  // namespace tranos::camera
