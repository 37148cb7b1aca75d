// SPDX-License-Identifier: GPL-3.0-or-later
// Linear constraints on ω = (K Kᵀ)⁻¹, the image of the absolute conic, and the camera it gives.
// (The paper's Section 2.2.5 and Lemmas 3, 5, 7.)
#pragma once

#include <array>
#include <optional>
#include <span>

#include "camera/camera.h"

namespace tranos::camera {

// ω₁₁, ω₁₂, ω₂₂, ω₁₃, ω₂₃, ω₃₃. A constraint is a row with row·ω = 0, divided by the deviation of
// row·ω where that is known. Coordinates must be of the order of 1 (camera/conditioning.h).
using Conic = Eigen::Matrix<double, 6, 1>;

// uᵀ ω v as a row: zero where the directions with vanishing points u and v are orthogonal.
Conic OrthogonalRow(const Vec3& u, const Vec3& v);
// uᵀωu − vᵀωv: zero where the edges with vanishing points u and v, scaled by their lengths in
// space, are equally long. It is the orthogonality of the diagonals, u + v and u − v. The columns
// of a metric homography are such vectors, so that a known ratio is linear too.
Conic EqualLengthRow(const Vec3& u, const Vec3& v);
Conic ZeroSkewRow();
// f_y/f_x = aspect, if the skew angle is 90°.
Conic AspectRow(double aspect);
std::array<Conic, 2> PrincipalPointRows(const Vec2& principal);
// The skew angle (s = f_x cot α), if the aspect is known: ω₁₂ = −(cot α / r) ω₁₁. With the aspect
// unknown the constraint is quadratic: see `SkewFamily`.
Conic SkewRow(double alpha_rad, double aspect);

Conic ConicOf(const Mat3& k);
// K⁻¹ with last entry 1 by Cholesky's decomposition, ω being either sign; none if ω is not
// definite: then it is not the image of the absolute conic in any real camera.
std::optional<Mat3> InverseCalibration(const Conic& conic);

// K from constraints, least squares. Error kDegenerate: they leave a family (the detail tells their
// rank), or the conic that fulfils them is not that of a real camera.
geom::Result<Mat3> CalibrationFromRows(std::span<const Conic> rows);
// How many of the five numbers of K the constraints fix.
int RankOfRows(std::span<const Conic> rows);

// The one-parameter family of conics that fulfil four constraints, spanned by a member without skew
// and another.
struct SkewFamily {
  Conic without_skew;  // ω₁₂ = 0, definite where possible
  Conic other;
};
// Error kDegenerate: the rank is not 4, or no member has skew.
geom::Result<SkewFamily> SkewFamilyOf(std::span<const Conic> rows);
// K⁻¹ of the members with skew angle α: ω₁₂² = cos²α ω₁₁ ω₂₂ and the sign of ω₁₂ has up to two
// solutions with a real camera; the one nearer to the member without skew first.
struct SkewRoots {
  std::array<Mat3, 2> inverse;
  int count = 0;
};
SkewRoots CalibrationsAtSkew(const SkewFamily& family, double alpha_rad);

}  // namespace tranos::camera
